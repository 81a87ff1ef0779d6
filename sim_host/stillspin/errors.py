"""What goes wrong because of what the user gave, said in one line: the value, what is allowed, what is near."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from stillspin.exit_codes import ExitCode


class StillspinError(Exception):
    """Whatever is told to people in one line; the command line ends with `exit_code`."""

    exit_code = ExitCode.SHORT


class InputError(StillspinError):
    """Bad input."""

    exit_code = ExitCode.BAD_INPUT


class CampaignError(StillspinError):
    """The runs could not be carried out for a reason outside them."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A hint after an unknown name: the nearest known one, or all of them when they are few and none is near.

    Args:
        word: what was given.
        known: the names that exist.

    Returns:
        Text to append to a message, starting with "; ".
    """
    names = sorted(known)
    if not names:
        return "; there are none"
    lower = {name.lower(): name for name in names}
    near = difflib.get_close_matches(word.lower(), lower, n=1, cutoff=0.6)
    hint = f"; did you mean '{lower[near[0]]}'?" if near else ""
    if len(names) <= 12 or not near:
        shown = ", ".join(names[:40]) + (", …" if len(names) > 40 else "")
        hint += f"{' ' if hint else '; '}known: {shown}"
    return hint
