"""Typed view of the native module's board that gets its firmware (sim_host/bench/loader_board.hpp)."""

from __future__ import annotations

from typing import Protocol


class NativeLoader(Protocol):
    """Chip with boot ROM and flash, jumpers, serial port; no power stage. Its time passes in the two advances alone.

    One at a time in a process, and no virtual drive beside it. Downloaded words cannot run here: `running` is "kernel"
    when RAM holds the kernel that was given and the boot ROM has jumped to its entry; its C runs then.
    """

    flash: list[int]
    """All words from 0x3E8000 on, as a JTAG probe reads and writes them."""
    serial_rate: float
    """Bit rate of the far end, bit/s."""

    @property
    def now(self) -> int:
        """Ticks of 10 ns since it was made."""
        ...

    @property
    def running(self) -> str:
        """Boot ROM, kernel, drive (the mark is there), waiting (it is not), unknown (code that cannot be told)."""
        ...

    @property
    def driven(self) -> int:
        """How often a pin has been driven to another level than its pull-down's: of a gate, the enable line, any."""
        ...

    @property
    def in_loop(self) -> bool:
        """Never."""
        ...

    @property
    def serial_pending(self) -> int:
        """Ticks until the far end has sent all."""
        ...

    def set_serial_boot(self, on: bool) -> None:
        """The jumpers: serial boot or flash boot, from the next reset on."""
        ...

    def power_cycle(self) -> None:
        """Off and on, at any moment: RAM is gone, the flash stays as it is."""
        ...

    def advance(self, ticks: int) -> None:
        """Let time pass."""
        ...

    def advance_until_heard(self, ticks: int) -> bool:
        """Let time pass until the chip has sent something and rests, at most so many ticks; false when it has not."""
        ...

    def serial_write(self, octets: bytes) -> None:
        """The far end sends."""
        ...

    def serial_read(self) -> bytes:
        """What the far end has heard since the last call."""
        ...

    def serial_counts(self) -> dict[str, float]:
        """Octets received by the far end, and the bit rate at which the chip sent last, as drive_rate."""
        ...

    def close(self) -> None:
        """Switch it off. May be called twice."""
        ...
