"""A CAN adapter with a serial port: the LAWICEL ASCII protocol as a CANable speaks it.

A command ends with a carriage return. It is answered with a carriage return, with something before it, or with BEL when
it is wrong or not possible now. Received frames come unasked once the channel is open.

    S0 .. S8, S9   bit rate 10, 20, 50, 100, 125, 250, 500, 750, 1000 kbit/s, 83.3 kbit/s; closed only
    sXXYY          bit rate by the registers BTR0, BTR1 of an SJA1000 at 16 MHz; closed only
    O  L  C        open, open to listen only, close
    tIIILDD..  TIIIIIIIILDD..   send a frame with 11 or 29 bits of identifier, L octets of data
    rIIIL      RIIIIIIIIL       send a remote frame
    F              state: bit 2 error warning, 5 error passive, 7 bus error; open only
    Z0  Z1         frames without or with a time stamp in ms, 0 to 59999; closed only
    V  N           versions, serial number

What else the protocol knows (acceptance filters, polling, rate of the serial port) is answered with BEL.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

OK: Final = b"\r"
ERROR: Final = b"\a"
VERSION: Final = b"V1013\r"
SERIAL: Final = b"NSTSP\r"
QUEUE = 32
"""Frames that may wait for the bus before a program that writes is held back."""

_RATES = {
    "0": 10_000,
    "1": 20_000,
    "2": 50_000,
    "3": 100_000,
    "4": 125_000,
    "5": 250_000,
    "6": 500_000,
    "7": 750_000,
    "8": 1_000_000,
    "9": 83_333,
}
_LONGEST = 32  # a command
_WRAP_MS = 60_000
_TICKS_PER_MS = 100_000
_WARNING, _PASSIVE = 96, 128
_STANDARD_MAX, _EXTENDED_MAX = 0x7FF, 0x1FFFFFFF
_HEX = re.compile(r"[0-9A-Fa-f]+\Z")


class Bus(Protocol):
    """What the adapter's controller does; a virtual board has it."""

    def can_open(self, rate: int, listen_only: bool = False) -> None:
        """Join the bus at this bit rate; 0 leaves it."""
        ...

    def can_write(self, frame: tuple[int, bool, bool, int, bytes]) -> None:
        """Send (identifier, extended, remote, length, data)."""
        ...

    @property
    def can_waiting(self) -> int:
        """Frames that wait."""
        ...

    def can_counts(self) -> dict[str, int]:
        """Error counters."""
        ...


@dataclass(frozen=True)
class Frame:
    """A frame that was received, at `tick` of 10 ns."""

    tick: int
    identifier: int
    extended: bool
    remote: bool
    length: int
    data: bytes


class Adapter:
    """One adapter: octets of its serial port in, answers and frames out."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._line = bytearray()
        self._too_long = False
        self._rate = 0
        self._stamps = False
        self.is_open = False
        self._listens = False
        self.refused = 0
        """Commands that were answered with BEL."""
        self._commands: dict[str, Callable[[str], bytes]] = {
            "S": self._set_rate,
            "s": self._set_registers,
            "O": self._open,
            "L": self._listen,
            "C": self._close,
            "t": lambda text: self._send(text, extended=False, remote=False),
            "T": lambda text: self._send(text, extended=True, remote=False),
            "r": lambda text: self._send(text, extended=False, remote=True),
            "R": lambda text: self._send(text, extended=True, remote=True),
            "F": self._flags,
            "Z": self._set_stamps,
            "V": lambda text: ERROR if text else VERSION,
            "N": lambda text: ERROR if text else SERIAL,
        }

    @property
    def has_room(self) -> bool:
        """Whether more commands should be taken from the port."""
        return not self.is_open or self._bus.can_waiting < QUEUE

    @property
    def is_plain(self) -> bool:
        """Whether the next octet begins a command, and a frame is a line without a time stamp."""
        return self.is_open and not (self._listens or self._stamps or self._line or self._too_long)

    def feed(self, octets: bytes) -> bytes:
        """Carry out commands; returns the answers. Whatever comes is answered and never raises."""
        answers = bytearray()
        *lines, rest = octets.translate(None, b"\n").split(b"\r")
        for line in lines:
            self._append(line)
            answers += self._finish()
        self._append(rest)
        return bytes(answers)

    def frame(self, frame: Frame) -> bytes:
        """What a received frame is on the port; nothing while the channel is closed."""
        if not self.is_open:
            return b""
        kind = ("tT", "rR")[frame.remote][frame.extended]
        identifier = f"{frame.identifier:08X}" if frame.extended else f"{frame.identifier:03X}"
        data = "" if frame.remote else frame.data.hex().upper()
        stamp = f"{frame.tick // _TICKS_PER_MS % _WRAP_MS:04X}" if self._stamps else ""
        return f"{kind}{identifier}{frame.length}{data}{stamp}\r".encode()

    def _append(self, octets: bytes) -> None:
        self._line += octets
        if len(self._line) > _LONGEST:
            del self._line[_LONGEST:]
            self._too_long = True

    def _finish(self) -> bytes:
        line, self._line = self._line.decode("latin-1"), bytearray()
        too_long, self._too_long = self._too_long, False
        if not line and not too_long:
            return OK
        command = self._commands.get(line[0])
        answer = ERROR if command is None or too_long else command(line[1:])
        self.refused += answer == ERROR
        return answer

    def _set_rate(self, text: str) -> bytes:
        if self.is_open or text not in _RATES:
            return ERROR
        self._rate = _RATES[text]
        return OK

    def _set_registers(self, text: str) -> bytes:
        if self.is_open or len(text) != 4 or not _HEX.match(text):
            return ERROR
        prescaler = (int(text[:2], 16) & 0x3F) + 1
        second = int(text[2:], 16)
        quanta = 3 + (second & 0x0F) + (second >> 4 & 0x07)
        rate = 8_000_000 / (prescaler * quanta)
        if rate > 1_000_000:
            return ERROR
        self._rate = round(rate)
        return OK

    def _join(self, text: str, *, listens: bool) -> bytes:
        if text or self.is_open or not self._rate:
            return ERROR
        self._bus.can_open(self._rate, listens)
        self.is_open, self._listens = True, listens
        return OK

    def _open(self, text: str) -> bytes:
        return self._join(text, listens=False)

    def _listen(self, text: str) -> bytes:
        return self._join(text, listens=True)

    def _close(self, text: str) -> bytes:
        if text or not self.is_open:
            return ERROR
        self._bus.can_open(0)
        self.is_open = False
        return OK

    def _send(self, text: str, *, extended: bool, remote: bool) -> bytes:
        digits = 8 if extended else 3
        if not self.is_open or self._listens or not _HEX.match(text) or len(text) <= digits:
            return ERROR
        identifier, length = int(text[:digits], 16), int(text[digits], 16)
        octets = 0 if remote else length
        highest = _EXTENDED_MAX if extended else _STANDARD_MAX
        if identifier > highest or length > 8 or len(text) != digits + 1 + 2 * octets:
            return ERROR
        self._bus.can_write((identifier, extended, remote, length, bytes.fromhex(text[digits + 1 :])))
        return b"Z\r" if extended else b"z\r"

    def _flags(self, text: str) -> bytes:
        if text or not self.is_open:
            return ERROR
        counts = self._bus.can_counts()
        worst = max(counts["transmit_errors"], counts["receive_errors"])
        bits = (worst >= _WARNING) << 2 | (worst >= _PASSIVE) << 5 | (worst > 0) << 7
        return f"F{bits:02X}\r".encode()

    def _set_stamps(self, text: str) -> bytes:
        if self.is_open or text not in {"0", "1"}:
            return ERROR
        self._stamps = text == "1"
        return OK
