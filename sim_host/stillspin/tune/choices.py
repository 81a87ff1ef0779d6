"""The words of numbers that stand for something, from the drive: a parameter's meaning says "0 encoder, 1 paper"."""

from __future__ import annotations

import re

from stillspin.drive import Drive
from stillspin.drive.protocol import Words
from stillspin.drive.table import Parameter

_MOST = 32
_YES_NO = ["no", "yes"]
_FLAGS = {"speed_known"}
_STATES, _STARTS, _LIMITS, _WIRINGS = 8, 9, 16, 12


def of_parameter(parameter: Parameter) -> list[str]:
    """Words for the values from the smallest to the largest; empty for a parameter that is a number."""
    low, high = round(parameter.minimum), round(parameter.maximum)
    if parameter.unit or parameter.decimals or parameter.q or not 1 <= high - low < _MOST:
        return []
    found = _listed(parameter.meaning, range(low, high + 1))
    return found or (_YES_NO if (low, high) == (0, 1) else [])


def _listed(meaning: str, numbers: range) -> list[str]:
    """What stands behind each number, where the text has all of them in order."""
    starts: list[tuple[int, int]] = []
    at = 0
    for number in numbers:
        match = re.compile(rf"(?:^|[,;:] ){number} ").search(meaning, at)
        if not match:
            return []
        starts.append(match.span())
        at = match.end() - 1
    ends = [begin for begin, _ in starts[1:]] + [len(meaning)]
    words = [meaning[begin:end] for (_, begin), end in zip(starts, ends, strict=True)]
    return [text.partition(";")[0].strip(" ,:") for text in words]


def of_signals(drive: Drive) -> dict[str, list[str]]:
    """Words for the values of signals that stand for something; of `limit`, for its bits."""
    kinds = {
        "state": (Words.STATE, _STATES),
        "fault": (Words.FAULT, drive.table.faults),
        "start_phase": (Words.START, _STARTS),
        "limit": (Words.LIMIT, _LIMITS),
        "wiring": (Words.WIRING, _WIRINGS),
    }
    known = {signal.name for signal in drive.table.signals}
    said = {
        name: [drive.words(kind, code) for code in range(count)]
        for name, (kind, count) in kinds.items()
        if name in known
    }
    said |= dict.fromkeys(_FLAGS & known, _YES_NO)
    return {name: words for name, words in said.items() if any(words)}  # an older drive may have none
