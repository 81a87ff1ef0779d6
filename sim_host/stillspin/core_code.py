"""Typed view of what a virtual board has that executes an image (sim_host/bench/module_code.cpp)."""

from __future__ import annotations

from typing import Protocol

Spent = tuple[int, int, int, int]
"""Cycles, and of them those waited for registers, data and fetches."""
Interrupt = tuple[int, int]
"""Vector and routine."""

Use = tuple[int, int, int, int]
"""Reads, writes, and of the first of them the instruction's address and the cycle."""

Change = tuple[int, int, int]
"""Of an input: samples before, looks at it since the last of them, value from then on."""


class NativeCode(Protocol):
    """What a board has that executes an image; RuntimeError from one that does not."""

    def code(self) -> dict[str, int]:
        """Cycles, instructions, the cycles that were waited for, pc and sp."""
        ...

    def profile(self) -> None:
        """Note from now on where the image's cycles go."""
        ...

    def spent(self) -> tuple[dict[int, Spent], dict[Interrupt, list[int]], int]:
        """Cycles by address, cycles of each interrupt, and the highest stack pointer.

        All addresses from 0x010000 to 0x3D77FF count as the first of them: an F2808 has nothing there.
        """
        ...

    def within(self) -> dict[Interrupt, dict[int, int]]:
        """Cycles by address in each interrupt, without its entry and the interrupts in between."""
        ...

    def registers(self) -> dict[str, int]:
        """ACC, P, XT, XAR0 to XAR7, PC, RPC, SP, DP, ST0, ST1, IFR, IER, DBGIER; between instructions when halted."""
        ...

    def set_register(self, name: str, value: int) -> None:
        """One of them. ValueError for a name that is none."""
        ...

    def stop_at(self, addresses: list[int], traps: bool = False, words: list[tuple[int, int]] = ...) -> None:
        """Let `advance` end before the instructions at these addresses, and no longer at others.

        Args:
            addresses: of code.
            traps: also at ESTOP0 and at what is no instruction, before it traps.
            words: addresses of data, and what an instruction does there behind which to end: 1 reads, 2 writes, 3 both.
        """
        ...

    @property
    def accessed(self) -> tuple[int, int] | None:
        """Which of those words was read (1), written (2) or both (3), where the last `advance` ended for that."""
        ...

    def stop_after(self, instructions: int) -> None:
        """Let `advance` end when so many more instructions have been executed, once."""
        ...

    @property
    def halted(self) -> bool:
        """Whether the last `advance` ended at such a place."""
        ...

    def trace(self, depth: int) -> None:
        """Keep the last so many instructions from now on, until one traps as illegal; 0 keeps that one alone."""
        ...

    def traced(self) -> list[tuple[int, dict[str, int]]]:
        """Of those kept, oldest first, cycles and registers before each."""
        ...

    def words(self, address: int, count: int) -> list[int]:
        """As inspect, of neighbours."""
        ...

    def put(self, blocks: list[tuple[int, list[int]]]) -> None:
        """Words into flash and RAM as a probe would; ValueError where there is neither."""
        ...

    def raise_interrupt(self, vector: int) -> None:
        """A request as if the vector's peripheral had made it; ValueError for a vector that has no line."""
        ...

    def record(self, given: list[int], inputs: list[list[Change]] = ...) -> None:
        """Note from now on what comes from outside and what is written to the ePWM; also of the firmware.

        Args:
            given: codes for the converter instead, in the order of its samples, as long as there are some.
            inputs: levels of pins, trip inputs and the encoder instead, as `recorded` has them.
        """
        ...

    def recorded(self) -> tuple[list[int], list[tuple[int, int, int, int]], list[list[Change]]]:
        """What has been noted.

        Codes; writes: samples before, address, value, address behind the instruction (0 of the firmware); changes of
        pins 0 to 15, 16 to 31 and 32 to 34, of the active trip inputs and of the encoder's edges.
        """
        ...

    def load_rom(self, blocks: list[tuple[int, list[int]]]) -> None:
        """Words of the boot ROM, of which the model has vectors and loaders alone; ValueError outside of it."""
        ...

    def unmodelled(self) -> dict[int, Use]:
        """What the program accessed that the chip of the model has not, by address; 8192 addresses at most."""
        ...

    def unallowed(self) -> dict[int, Use]:
        """The same of writes to protected registers with EALLOW clear, which are lost."""
        ...

    def unclocked(self) -> dict[int, Use]:
        """The same of accesses to a peripheral whose clock is off, which are lost; all count as writes."""
        ...

    def replace_flash_library(self, erase: int, program: int, verify: int, scale: int) -> None:
        """Addresses of TI's flash library and its variable, 0 for none: the model's cells do what it would."""
        ...
