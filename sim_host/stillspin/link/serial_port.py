"""Records and console text over a serial port, real or pseudo-terminal."""

from __future__ import annotations

import errno
import re
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import serial
from serial.tools import list_ports

from stillspin.link.errors import LinkError, gone
from stillspin.link.records import Record, to_wire
from stillspin.link.splitter import Item, Splitter
from stillspin.link.transport import beats_of_clock

DEFAULT_BAUD = 115200
_WRITE_TIMEOUT = 2.0
_WINDOWS = re.compile(r"Error\((\d+),")
"""There pyserial has the error number in its text alone: PermissionError(13, 'Access is denied.', None, 5)."""


class SerialTransport:
    """A serial port, 8 data bits, no parity, 1 stop bit, held by this process alone."""

    has_console = True

    def __init__(self, port: str, baud: int = DEFAULT_BAUD) -> None:
        self.name = f"serial port {port}"
        self._port = _open(port, baud)
        self._splitter = Splitter()
        self._sending = threading.Lock()

    @property
    def port(self) -> tuple[int, int] | None:
        """See Transport."""
        return descriptor_of(self._port, 0)

    def send(self, record: Record) -> None:
        """See Transport."""
        self._write(to_wire(record))

    def send_text(self, octets: bytes) -> None:
        """See Transport."""
        self._write(octets)

    def receive(self, timeout: float) -> list[Item]:
        """See Transport."""
        try:
            self._port.timeout = timeout
            octets = self._port.read(1)
            if octets:
                octets += self._port.read(self._port.in_waiting)
        except (OSError, serial.SerialException, TypeError) as error:  # TypeError: closed during the read
            raise gone(self.name) from error
        return self._splitter.feed(octets, time.monotonic())

    def beats(self, interval: float, end: threading.Event) -> Iterator[None]:
        """See Transport."""
        return beats_of_clock(interval, end)

    def close(self) -> None:
        """See Transport."""
        self._port.close()

    def _write(self, octets: bytes) -> None:
        try:
            with self._sending:
                self._port.write(octets)
        except serial.SerialTimeoutException as error:
            raise LinkError(f"{self.name} accepts no data: is anything connected to it?") from error
        except (OSError, serial.SerialException, TypeError) as error:
            raise gone(self.name) from error


def _open(port: str, baud: int) -> serial.Serial:
    try:
        return serial.Serial(port, baud, exclusive=True, timeout=0, write_timeout=_WRITE_TIMEOUT)
    except (OSError, serial.SerialException, ValueError) as error:
        raise LinkError(explain(port, error)) from error


def descriptor_of(port: serial.Serial, node: int) -> tuple[int, int] | None:
    """What Transport.port gives for a serial port; nothing where the system has no descriptors."""
    try:
        return port.fileno(), node
    except (AttributeError, OSError):
        return None


def explain(port: str, error: Exception) -> str:
    """Why a port cannot be opened, and what to do about it."""
    code = getattr(error, "errno", None)
    text = str(error)
    windows = _WINDOWS.search(text) if code is None else None
    if windows:
        code = int(windows[1])
    taken = code == errno.EACCES if windows else code in {errno.EBUSY, errno.EAGAIN, errno.EWOULDBLOCK}
    if taken or "exclusively lock" in text:
        return f"serial port {port} is in use by another program; close that one first"
    if code == errno.ENOENT or not (windows or Path(port).exists()):
        return f"there is no serial port {port}; {_ports()}"
    if code in {errno.EACCES, errno.EPERM}:
        return (
            f"no permission for serial port {port}; on Debian and Ubuntu the members of the group dialout have it: "
            "sudo adduser $USER dialout, then log in again"
        )
    if code in {errno.ENOTTY, errno.EINVAL} or "configure port" in text:
        return f"{port} is no serial port"
    return f"serial port {port} cannot be opened: {_reason(error)}"


def _ports() -> str:
    names = sorted(port.device for port in list_ports.comports())
    return f"there are {', '.join(names)}" if names else "there are none; is the adapter plugged in?"


def _reason(error: Exception) -> str:
    words = error.strerror if isinstance(error, OSError) else None
    return words or " ".join(str(error).split()) or type(error).__name__
