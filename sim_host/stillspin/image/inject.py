"""An interrupt at each instruction of a stretch of code, and whether anyone could tell.

The board runs to the beginning of the stretch. Before each instruction that is executed from there to its end, a copy
of the whole board (a child of this process) gets the interrupt, goes on to the end, and says what is in memory and
registers there. Code that is safe gives one of two results wherever the interrupt comes: that of an interrupt before
the stretch, or that of one behind it. Any other is one that nobody has written the program for: an access in two parts
between which the interrupt came, or a register that the interrupt did not put back.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, TypeVar

from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.errors import CampaignError
from stillspin.flash import layout
from stillspin.image import opened

_LATER = frozenset({"PC", "IFR"})
"""Registers that time changes."""

_ENTRY = 10e-6
"""Seconds that an interrupt has for its entry."""

Watched = Sequence[tuple[int, int]]
"""Addresses and numbers of words."""
Key = str | int
"""The name of a register, or the address of a word."""


@dataclass(frozen=True)
class Stretch:
    """What is asked for."""

    begin: int
    end: int
    """The address before which it ends; the same as `begin` for once around a loop."""
    vector: int
    watched: Watched = ()
    """Empty: all of RAM but what lies above the stack pointer."""
    most: int = 10_000
    """Instructions."""
    seconds: float = 1.0
    """Until it begins, and until it has ended."""


@dataclass(frozen=True)
class Difference:
    """A register or word that is not what it is with an interrupt before, or not what it is with one behind."""

    what: Key
    value: int
    before: int
    after: int


@dataclass
class Report:
    """What came out, by the address of the instruction before which the interrupt was asked for."""

    executed: list[int]
    held_off: list[int] = field(default_factory=list)
    """It was taken behind the end only."""
    unclear: list[int] = field(default_factory=list)
    """Another interrupt came within the stretch because of it, or no longer did."""
    spoilt: list[tuple[int, list[Difference]]] = field(default_factory=list)
    """Registers that are not what they were before the interrupt when it returns."""
    differences: list[tuple[int, list[Difference]]] = field(default_factory=list)


_Found = TypeVar("_Found")


@dataclass(frozen=True)
class _AtEnd:
    """What is there at the end."""

    found: dict[Key, int]
    interrupts: int
    """Taken until then."""
    spoilt: list[Difference]
    """Registers that the interrupt did not put back."""


@dataclass(frozen=True)
class _Tried:
    """The interrupt before one instruction."""

    address: int
    interrupts: int
    """Taken until then."""
    at_end: _AtEnd | None
    """None: the end did not come."""


class _Place(NamedTuple):
    """Where a program is. An interrupt may call the very function that it came into: the stack tells the two apart."""

    address: int
    stack: int

    def is_at(self, board: NativeBoard) -> bool:
        """Whether a halted board is there."""
        registers = board.registers()
        return (registers["PC"], registers["SP"]) == self

    def run_to(self, board: NativeBoard, seconds: float) -> bool:
        """Let time pass until the program is there; false: it never was."""
        end = board.now + round(seconds * TICKS_PER_SECOND)
        while (left := end - board.now) > 0:
            if not opened.run_to(board, [self.address], left / TICKS_PER_SECOND):
                return False
            if self.is_at(board):
                return True
        return False


def inject(board: NativeBoard, stretch: Stretch, progress: Callable[[int], None] | None = None) -> Report:
    """Go through a stretch once and try the interrupt at each instruction.

    Args:
        board: executes the image; afterwards it stands at the end of the stretch.
        stretch: what to try.
        progress: gets the number of instructions done.

    Raises:
        CampaignError: the stretch is not reached, does not end, or the interrupt is never taken.
    """
    if not opened.run_to(board, [stretch.begin], stretch.seconds):
        raise CampaignError(
            f"0x{stretch.begin:06X}, the beginning, was not reached within {stretch.seconds:g} s; give it longer with "
            "--within"
        )
    reached, there = _in_a_copy(lambda: (opened.run_to(board, [stretch.end], stretch.seconds), board.registers()))
    if not reached:
        raise CampaignError(
            f"0x{stretch.end:06X}, the end, was not reached within {stretch.seconds:g} s; the program is at "
            f"0x{there['PC']:06X}; give it longer with --within"
        )
    end = _Place(stretch.end, there["SP"])
    tried = [_try(board, stretch, end, first=True)]
    while len(tried) == 1 or not end.is_at(board):
        if len(tried) > stretch.most:
            raise CampaignError(
                f"0x{stretch.end:06X}, the end, was not reached within {counted(stretch.most, 'instruction')}; the "
                f"program is at 0x{tried[-1].address:06X}; allow more with --most"
            )
        if not opened.step(board, stretch.seconds):
            raise CampaignError(
                f"the CPU slept for {stretch.seconds:g} s within the stretch; give it longer with --within"
            )
        tried.append(_try(board, stretch, end))
        if progress:
            progress(len(tried))
    return _compared(tried)


def _try(board: NativeBoard, stretch: Stretch, end: _Place, *, first: bool = False) -> _Tried:
    """Ask for the interrupt now, in a copy of the board."""
    there, interrupts = board.registers(), board.statistics()["interrupts"]
    here = _Place(there["PC"], there["SP"])
    behind = here == end and not first  # only an interrupt that comes at once is one behind the stretch

    def run() -> _AtEnd | None:
        board.raise_interrupt(stretch.vector)
        spoilt: list[Difference] = []
        at_once = _comes_at_once(board)
        if at_once:
            if not here.run_to(board, stretch.seconds):
                return None
            spoilt = [
                Difference(name, value, there[name], there[name])
                for name, value in board.registers().items()
                if name not in _LATER and value != there[name]
            ]
        there_already = behind if at_once else end.is_at(board)
        if (behind and not at_once) or not (there_already or end.run_to(board, stretch.seconds)):
            return None
        return _AtEnd(_look(board, stretch.watched), board.statistics()["interrupts"], spoilt)

    return _Tried(here.address, interrupts, _in_a_copy(run))


def _comes_at_once(board: NativeBoard) -> bool:
    """Whether an interrupt that has just been asked for is entered before anything else is executed."""
    before = board.code()["instructions"]
    board.stop_after(0)
    opened.run_to(board, (), _ENTRY)
    return board.code()["instructions"] == before and board.halted


def _look(board: NativeBoard, watched: Watched) -> dict[Key, int]:
    registers = board.registers()
    found: dict[Key, int] = {name: value for name, value in registers.items() if name not in _LATER}
    for first, count in watched or _below_the_stack(registers["SP"]):
        found.update(enumerate(board.words(first, count), start=first))
    return found


def _below_the_stack(pointer: int) -> Watched:
    return [(first, (pointer if first <= pointer < end else end) - first) for first, end in layout.RAM]


def _in_a_copy(work: Callable[[], _Found]) -> _Found:
    """What a copy of this process finds."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        try:
            with os.fdopen(writer, "wb") as pipe:
                pickle.dump(work(), pipe)
        finally:
            os._exit(0)  # nothing of the parent's is to be closed, flushed or said twice
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        octets = pipe.read()
    os.waitpid(child, 0)
    if not octets:
        raise CampaignError("the chip could not go on in the stretch, or after an interrupt that was asked for in it")
    found: _Found = pickle.loads(octets)  # this program's own words
    return found


def _compared(tried: list[_Tried]) -> Report:
    report = Report([one.address for one in tried[:-1]])
    until_end = tried[-1].interrupts
    taken: list[tuple[int, dict[Key, int]]] = []
    for one in tried:
        by_itself = until_end - one.interrupts
        more = one.at_end.interrupts - one.interrupts - by_itself if one.at_end else 0
        if one.at_end and more == 1:
            taken.append((one.address, one.at_end.found))
            if one.at_end.spoilt:
                report.spoilt.append((one.address, one.at_end.spoilt))
        elif more == 0:
            report.held_off.append(one.address)
        else:
            report.unclear.append(one.address)
    if not taken:
        raise CampaignError(
            "the interrupt is never taken within the stretch: is it enabled, and its group acknowledged?"
        )
    before, after = taken[0][1], taken[-1][1]
    for address, found in taken:
        if found not in (before, after):
            report.differences.append((address, _differences(found, before, after)))
    return report


def _differences(found: dict[Key, int], before: dict[Key, int], after: dict[Key, int]) -> list[Difference]:
    return [
        Difference(what, value, before[what], after[what])
        for what, value in found.items()
        if what in before and what in after and not value == before[what] == after[what]
    ]
