"""What a drive told its hardware in a period, in words: the outputs of a step's answer (hal/hal_replay.h)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

_LEGS = tuple(f"{edge} of leg {leg}" for leg in "abc" for edge in ("rise", "fall"))
_BURSTS = tuple(f"{end} burst of window {window}" for window in (1, 2, 3) for end in ("first", "last"))

_TOLD: dict[int, tuple[str, tuple[str, ...]]] = {
    1: ("next period", (*_LEGS, *_BURSTS, "deadline")),
    2: ("gates on", ()),
    3: ("gates off", ()),
    4: ("dead band", ("ticks",)),
    5: ("enable line toggled", ()),
    6: ("fault lamp", ("lit",)),
    7: ("slices", ("ticks",)),
    8: ("legs", ("levels",)),
}
"""What -> its name, and the names of the words that belong to it."""


def difference(board: Sequence[int], native: Sequence[int]) -> str | None:
    """The first output in which two periods differ, in words; None when the outputs are the same."""
    for one, other in zip_longest(_named(board), _named(native)):
        if one == other:
            continue
        if one is None or other is None or one[0] != other[0]:
            here, there = (item[0] if item else "nothing" for item in (one, other))
            return f"the board told its hardware '{here}', the virtual drive '{there}'"
        return f"{one[0]}: {one[1]} on the board, {other[1]} on the virtual drive"
    return None


def answered(request: str, board: bytes, recording: bytes) -> str:
    """The first octet in which two answers differ, in words; status and body."""
    for place, (one, other) in enumerate(zip_longest(board, recording)):
        if one != other:
            here, there = ("nothing" if octet is None else f"0x{octet:02x}" for octet in (one, other))
            return f"answer to {request}, octet {place}: {here} on the board, {there} in the recording"
    return "the answers are the same"


def _named(outputs: Sequence[int]) -> Iterator[tuple[str, int | None]]:
    at = 0
    while at < len(outputs):
        what, words = _TOLD.get(outputs[at], (f"unknown output {outputs[at]}", ()))
        at += 1
        if not words:
            yield what, None
        for word in words:
            yield f"{what}, {word}", outputs[at] if at < len(outputs) else None
            at += 1
