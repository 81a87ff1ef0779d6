"""Typed view of the native module's part that steps a board through a run (sim_host/bench/module_hil.cpp)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

Ask = Callable[[bytes], bytes]
"""Gets type and body of a request, gives status and body of its answer; nothing at all ends the run."""


class NativeStepLoop(Protocol):
    """A board that is stepped through a run: takes what one run or commissioning records, compares every answer."""

    @property
    def steps(self) -> int:
        """Periods that the board was stepped through."""
        ...

    @property
    def mismatch(self) -> tuple[int, bool, list[int], list[int], list[int]] | None:
        """The first period that differed, which ended the run.

        Its number from power-on, whether the board asked its hardware for something else, the words that the board and
        the virtual drive told their hardware, and the raw signals of the virtual drive behind it.
        """
        ...

    @property
    def refusal(self) -> tuple[int, bytes] | None:
        """Status and words of a request that the board refused, which ended the run."""
        ...

    @property
    def lost(self) -> str:
        """Why the way to the board is lost, which ended the run; empty when it is not."""
        ...

    def finish(self) -> None:
        """Compare the answer to the last period, which is looked at behind every other with the next one."""
        ...

    def take_logs(self) -> tuple[bytes, bytes]:
        """What board and virtual drive have answered since the last call."""
        ...


class NativeStepLoops(Protocol):
    """The two ways to a board."""

    def through(self, descriptor: int, node: int) -> NativeStepLoop:
        """Over an open serial port (node 0), or an open SLCAN adapter to a node of its bus."""
        ...

    def asking(self, ask: Ask) -> NativeStepLoop:
        """By a function, for every other way."""
        ...
