"""Numbers of things in words: 1 run, 2 runs."""

from __future__ import annotations


def counted(number: int, what: str, of: int | None = None) -> str:
    """The number and its noun, such as "1 run", "0 runs", "1 of 1 run", "1 of 3 runs".

    Args:
        number: how many.
        what: the noun in the singular; its plural has an s.
        of: how many there are in all; the noun goes with it.
    """
    several = (number if of is None else of) != 1
    share = f"{number}" if of is None else f"{number} of {of}"
    return f"{share} {what}{'s' if several else ''}"
