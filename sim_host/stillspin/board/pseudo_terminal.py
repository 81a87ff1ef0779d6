"""The plug of a serial port: a pseudo-terminal that any terminal program opens like a port.

It behaves like an adapter with nothing but wires behind it. What comes while nobody has the port open is lost, and the
bit rate that the program sets is a property of its end of the line, which may be the wrong one.
"""

from __future__ import annotations

import errno
import os
import select
import struct
import sys
import tempfile
from pathlib import Path

from stillspin.errors import InputError

if sys.platform != "win32":
    import fcntl
    import termios
    import tty

DEFAULT_RATE = 115200
BACKLOG = 65536
"""Octets kept for a program that has the port open and does not read."""

# Linux: the rates as numbers, also those without a constant. struct termios2, ispeed and ospeed at its end.
_TCGETS2 = 0x802C542A
_TERMIOS2_SIZE = 44
_SPEEDS = struct.Struct("=36xII")


class PseudoTerminal:
    """One pseudo-terminal, and a name for it that stays the same from one start to the next."""

    def __init__(self, link: Path | None = None, rate: int = DEFAULT_RATE) -> None:
        """Make it.

        Args:
            link: symbolic link to make to it; an old one is replaced, that of a board that runs is not.
            rate: bit/s that the port is set to until a program sets it.

        Raises:
            InputError: the link cannot be made, or there are no pseudo-terminals.
        """
        if sys.platform == "win32":
            raise InputError("Windows has no pseudo-terminals for the virtual board's port: run it under Linux or WSL")
        try:
            self._master, slave = os.openpty()
        except OSError as error:
            raise InputError(f"cannot open a pseudo-terminal: {error.strerror}") from error
        self.device = os.ttyname(slave)
        tty.setraw(slave)
        os.close(slave)
        os.set_blocking(self._master, False)
        self._rate = rate
        self._set_rate()
        self._poll = select.poll()
        self._poll.register(self._master, select.POLLIN)
        self._out = bytearray()
        self._was_open = False
        self.dropped = 0
        """Octets that a program which had the port open did not fetch in time."""
        self._link: Path | None = None
        self._lock: tuple[Path, int] | None = None
        try:
            self._make_link(link)
        except InputError:
            self.close()
            raise

    @property
    def name(self) -> str:
        """What to open: the link if there is one."""
        return str(self._link) if self._link else self.device

    @property
    def is_open(self) -> bool:
        """Whether a program has the port open."""
        hung_up = any(events & select.POLLHUP for _, events in self._poll.poll(0))
        if hung_up and self._was_open:
            self._set_rate()  # the next one finds the port as new
            self._out.clear()
        self._was_open = not hung_up
        return self._was_open

    @property
    def listens_to(self) -> int | None:
        """Descriptor at which the next octets of a program show; None while nobody has the port open."""
        return self._master if self.is_open else None

    @property
    def rate(self) -> int:
        """The bit rate that the program has set, bit/s; the default where the system does not tell."""
        try:
            state = fcntl.ioctl(self._master, _TCGETS2, bytes(_TERMIOS2_SIZE))
        except OSError:
            return self._rate
        return int(_SPEEDS.unpack(state)[1])

    def read(self, limit: int = 4096) -> bytes:
        """What the program has written, up to `limit` octets; empty when there is nothing."""
        try:
            return os.read(self._master, limit)
        except OSError as error:
            if error.errno in {errno.EAGAIN, errno.EIO}:  # nothing there; nobody there
                return b""
            raise

    def write(self, octets: bytes) -> None:
        """Hand octets to the program, if there is one. Never waits."""
        if not self.is_open:
            return
        self._out += octets
        while self._out:
            try:
                written = os.write(self._master, self._out)
            except OSError as error:
                if error.errno in {errno.EAGAIN, errno.EIO}:
                    break
                raise
            del self._out[:written]
        excess = len(self._out) - BACKLOG
        if excess > 0:
            del self._out[:excess]
            self.dropped += excess

    def close(self) -> None:
        """Give everything back; the link goes if it is still ours. May be called twice."""
        if self._master < 0:
            return
        if self._link and self._link.is_symlink() and str(self._link.readlink()) == self.device:
            self._link.unlink()
        if self._lock:
            self._lock[0].unlink(missing_ok=True)
            os.close(self._lock[1])
        os.close(self._master)
        self._master = -1

    def _set_rate(self) -> None:
        constant = getattr(termios, f"B{self._rate}")
        state = termios.tcgetattr(self._master)
        state[4] = state[5] = constant
        termios.tcsetattr(self._master, termios.TCSANOW, state)

    def _make_link(self, link: Path | None) -> None:
        if link is None:
            return
        if link.exists() and not link.is_symlink():
            raise InputError(f"{link}: exists already and is not a symbolic link; name another path")
        try:
            self._lock = _locked(link)
            with tempfile.TemporaryDirectory(prefix=f".{link.name}-", dir=link.absolute().parent) as beside:
                fresh = Path(beside) / link.name
                fresh.symlink_to(self.device)
                fresh.replace(link)
        except OSError as error:
            raise InputError(f"{link}: cannot be made ({error.strerror})") from error
        self._link = link


def _locked(link: Path) -> tuple[Path, int]:
    """The lock beside it that says that the link is in use; it ends with the process, however that ends.

    Raises:
        InputError: another board has it.
        OSError: it cannot be made.
    """
    beside = link.with_name(f".{link.name}.lock")
    lock = os.open(beside, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        os.close(lock)
        raise InputError(
            f"{link}: is the port of another virtual board that runs; end it, or name another path"
        ) from error
    return beside, lock
