"""The serial port as octets in and out, for the boot ROM and the kernel: no records yet."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Protocol, Self

import serial

from stillspin.link.errors import LinkError, gone
from stillspin.link.serial_port import explain

_WRITE_TIMEOUT = 2.0
_PATIENCE = 100
_PSEUDO = re.compile(r"/dev/(pts/\d+|ttys\d+)")
"""On Linux and on macOS; Windows has none."""


class Line(Protocol):
    """Octets to a chip and back."""

    @property
    def name(self) -> str:
        """For people."""
        ...

    @property
    def is_pseudo_terminal(self) -> bool:
        """Whether a program is at the other end, not a cable."""
        ...

    def set_rate(self, rate: int) -> None:
        """Bit rate from now on, for what is sent and what comes."""
        ...

    def write(self, octets: bytes) -> None:
        """Send.

        Raises:
            LinkError: the port is lost.
        """
        ...

    def read(self, most: int, timeout: float) -> bytes:
        """What comes, up to `most` octets; empty when nothing does for `timeout` seconds.

        Raises:
            LinkError: the port is lost.
        """
        ...


class SerialLine:
    """A serial port of this computer, held by this process alone."""

    def __init__(self, port: str) -> None:
        """Open it.

        Raises:
            LinkError: it cannot be opened.
        """
        self.name = f"serial port {port}"
        self.is_pseudo_terminal = self.is_pseudo(port)
        try:
            self._port = serial.Serial(port, exclusive=True, write_timeout=_WRITE_TIMEOUT)
        except (OSError, serial.SerialException, ValueError) as error:
            raise LinkError(explain(port, error)) from error

    @staticmethod
    def is_pseudo(port: str) -> bool:
        """Whether a port is a pseudo-terminal, also by a link to it."""
        return _PSEUDO.fullmatch(str(Path(port).resolve())) is not None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._port.close()

    def set_rate(self, rate: int) -> None:
        """See Line."""
        try:
            self._port.baudrate = rate
        except (OSError, serial.SerialException, ValueError) as error:
            raise LinkError(f"{self.name} cannot be set to {rate} bit/s: {error}") from error

    def write(self, octets: bytes) -> None:
        """See Line."""
        try:
            self._port.write(octets)
            self._port.flush()
        except (OSError, serial.SerialException) as error:
            raise gone(self.name) from error

    def read(self, most: int, timeout: float) -> bytes:
        """See Line."""
        try:
            self._port.timeout = timeout
            octets = bytes(self._port.read(1))
            if octets:
                octets += bytes(self._port.read(min(self._port.in_waiting, most - 1)))
        except (OSError, serial.SerialException, TypeError) as error:
            raise gone(self.name) from error
        return octets


def drop(line: Line, silence: float = 0.05) -> None:
    """Throw away what comes until nothing has come for `silence` seconds; not for ever."""
    for _ in range(_PATIENCE):
        if not line.read(4096, silence):
            return
