"""Which of several names a place in code goes by."""

from __future__ import annotations

import re
from collections.abc import Iterable

_OF_A_SECTION = re.compile(r"\w*(?:run|load)_?(?:start|end)_*", re.IGNORECASE)
"""What linker command files call the ends of a section that is copied: RamfuncsRunStart, as its first function."""


def chosen(places: Iterable[tuple[int, str, bool]]) -> dict[int, str]:
    """One name for each address.

    Args:
        places: addresses and names in the file's order, and whether the name is known to be a function's.
    """
    found: dict[int, tuple[int, str]] = {}
    for address, name, is_function in places:
        rank = 0 if is_function else 2 if _OF_A_SECTION.fullmatch(name) else 1
        if address not in found or rank < found[address][0]:
            found[address] = rank, name
    return {address: name for address, (_, name) in found.items()}
