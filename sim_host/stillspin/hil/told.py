"""What a drive told its hardware in a period, in words: the outputs of a step's answer (hal/hal_tape.h)."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Answer:
    """The answer to a step, taken apart. `torn`: the step was not the one that the drive ran."""

    sequence: int
    torn: bool
    outputs: tuple[int, ...]
    signals_crc: int


def answer(body: bytes) -> Answer:
    """Take a step's answer apart.

    Raises:
        ValueError: it has another shape.
    """
    try:
        sequence, torn, count = struct.unpack_from("<HBB", body)
        outputs = struct.unpack_from(f"<{count}H", body, 4)
        (crc,) = struct.unpack_from("<I", body, 4 + 2 * count)
    except struct.error as error:
        raise ValueError(f"{len(body)} octets are no answer to a step") from error
    return Answer(sequence, bool(torn), outputs, crc)


def difference(board: Answer, native: Answer) -> str | None:
    """The first output in which two answers differ, in words; None when the outputs are the same."""
    for one, other in zip_longest(_named(board.outputs), _named(native.outputs)):
        if one == other:
            continue
        if one is None or other is None or one[0] != other[0]:
            here, there = (item[0] if item else "nothing" for item in (one, other))
            return f"the board told its hardware '{here}', the virtual drive '{there}'"
        return f"{one[0]}: {one[1]} on the board, {other[1]} on the virtual drive"
    return None


def _named(outputs: tuple[int, ...]) -> Iterator[tuple[str, int | None]]:
    at = 0
    while at < len(outputs):
        what, words = _TOLD.get(outputs[at], (f"unknown output {outputs[at]}", ()))
        at += 1
        if not words:
            yield what, None
        for word in words:
            yield f"{what}, {word}", outputs[at] if at < len(outputs) else None
            at += 1
