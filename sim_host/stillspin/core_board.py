"""Typed view of the native module's virtual board on the desk (sim_host/bench/virtual_board.hpp)."""

from __future__ import annotations

from typing import Protocol

from stillspin.core_code import NativeCode


class NativeBoard(NativeCode, Protocol):
    """A virtual board on the desk. Its time passes in `advance` alone; what is handed over takes effect at `now`.

    One at a time in a process, and no other virtual drive beside it. `close` frees the process for the next.
    """

    @property
    def now(self) -> int:
        """Ticks of 10 ns since it was powered."""
        ...

    serial_rate: float
    """Bit rate of the far end of the serial line, bit/s."""

    @property
    def serial_pending(self) -> int:
        """Ticks until the last octet that was handed over will have left."""
        ...

    def advance(self, ticks: int) -> None:
        """Let time pass. RuntimeError when the chip cannot go on."""
        ...

    def advance_until_heard(self, ticks: int) -> bool:
        """Let time pass until the drive has sent something and rests again, at most `ticks`; false: it sent nothing."""
        ...

    def serve_loop(self, serial: int, can: int, milliseconds: int) -> tuple[int, int, bytes, bytes, bytes]:
        """Of a board in the loop whose time is nobody's: pass requests and answers on, and let time pass between them.

        Ends early when it leaves the loop or something else has to be looked at.

        Args:
            serial: descriptor that does not block, -1 when nobody has the port open.
            can: the same of the SLCAN adapter, whose channel must be open, without time stamps, between two commands.
            milliseconds: how long.

        Returns:
            Octets in and out at the serial port; what the adapter has to look at itself; what the program at the port
            and the one at the adapter did not take.
        """
        ...

    @property
    def in_loop(self) -> bool:
        """Whether the drive is stepped by a computer that runs the plant."""
        ...

    @property
    def can_waiting(self) -> int:
        """Frames that were handed over and wait for the bus."""
        ...

    eeprom: bytes
    """What the board's EEPROM holds, 32768 octets; another content may be given before any time has passed."""

    def serial_write(self, octets: bytes) -> None:
        """Send octets to the drive, from now on, one after the other at `serial_rate`."""
        ...

    def serial_read(self) -> bytes:
        """What the drive has sent since the last call."""
        ...

    def serial_break(self, bits: float) -> None:
        """Hold the line low for so many bit times."""
        ...

    def serial_noise(self, flips_per_bit: float, seed: int) -> None:
        """Turn over that share of the bits that are sent from now on."""
        ...

    def serial_counts(self) -> dict[str, float]:
        """Octets sent and received, framing errors at the far end, the drive's bit rate (0: nothing came yet)."""
        ...

    def can_open(self, rate: int, listen_only: bool = False) -> None:
        """Join the CAN bus as its other node at `rate` bit/s; 0 leaves it and drops what waits."""
        ...

    def can_write(self, frame: tuple[int, bool, bool, int, bytes]) -> None:
        """Send a frame: identifier, extended, remote, length, data. ValueError for one that cannot be."""
        ...

    def can_read(self) -> list[tuple[int, int, bool, bool, int, bytes]]:
        """Frames that were heard since the last call, each behind the tick of its last bit."""
        ...

    def can_counts(self) -> dict[str, int]:
        """Frames sent and waiting, error counters and bus-offs of this node; frames and busy ticks of the bus."""
        ...

    def can_flood(self, frame: tuple[int, bool, bool, int, bytes] | None) -> None:
        """Send this frame whenever nothing else waits; None ends it."""
        ...

    def can_plug(self, plugged: bool) -> None:
        """Unplugged, the drive is alone on its bus."""
        ...

    def set_input(self, name: str, value: float) -> None:
        """An input of the board from now on; ValueError for a name that is none.

        emergency, run (0, 1), speed (V), heat_sink (degrees C), reference (codes), broken_ram (address).
        """
        ...

    def outputs(self) -> dict[str, float]:
        """What the board does: relay, brake, gates_pass (0, 1); lockouts of upper drivers without a supply."""
        ...

    def begin_run(self) -> None:
        """Say that the start procedure of an image is over: a brake lets go, times of faults count from now."""
        ...

    def set_load(self, torque: float) -> None:
        """Load torque from now on, N m; positive opposes positive rotation."""
        ...

    def truth(self) -> dict[str, float]:
        """The true machine: angle (rad), speed (rpm), torque and load_torque (N m), currents (A), link_voltage (V)."""
        ...

    def signals(self) -> dict[str, float]:
        """The firmware's signals as of its last control interrupt; angles in turns. Of an image nothing is known."""
        ...

    def statistics(self) -> dict[str, int]:
        """Interrupts, resets, trips of the comparator, lost writes, idle ticks since it was powered."""
        ...

    def inspect(self, address: int) -> int:
        """A word of a register or memory, without an effect on the run."""
        ...

    def close(self) -> None:
        """Switch it off. May be called twice."""
        ...
