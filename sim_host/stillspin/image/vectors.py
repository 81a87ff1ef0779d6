"""Interrupt vectors by the names that TI gives them."""

from __future__ import annotations

import re

from stillspin.errors import InputError

_PIE_FIRST = 32
_CHANNELS = 8
_GROUPS = 12
_TIMERS = (13, 14)
_OWN = {0: "RESET", 15: "DLOGINT", 16: "RTOSINT", 17: "EMUINT", 18: "NMI", 19: "ILLEGAL"}
_USER_FIRST = 20


def number(text: str, option: str) -> int:
    """The vector of INT1.1 to INT12.8, INT13 or INT14.

    Raises:
        InputError: there is none.
    """
    if match := re.fullmatch(r"INT(\d+)\.(\d+)", text.strip().upper()):
        group, channel = int(match[1]), int(match[2])
        if 1 <= group <= _GROUPS and 1 <= channel <= _CHANNELS:
            return _PIE_FIRST + _CHANNELS * (group - 1) + channel - 1
    if (match := re.fullmatch(r"INT(\d+)", text.strip().upper())) and int(match[1]) in _TIMERS:
        return int(match[1])
    raise InputError(f"{option}: '{text}' is no interrupt: INT1.1 to INT12.8 of the PIE, INT13, INT14")


def name(vector: int) -> str:
    """As TI numbers them: INTx.y of the PIE, or the CPU's own."""
    if vector >= _PIE_FIRST:
        group, channel = divmod(vector - _PIE_FIRST, _CHANNELS)
        return f"INT{group + 1}.{channel + 1}"
    if vector >= _USER_FIRST:
        return f"USER{vector - _USER_FIRST + 1}"
    return _OWN.get(vector, f"INT{vector}")
