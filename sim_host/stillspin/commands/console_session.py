"""A session of the console: it begins with nothing of the one before, and no motor runs on behind it unless told so.

While it lasts, records beside the text keep the drive's watchdog alive, so that a bare `start` is taken and a session
that dies stops the motor; one that ends, in whatever way, stops what it has started at once.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

from stillspin.commands.transcript import is_prompt
from stillspin.drive import Drive
from stillspin.drive.requester import wait_until
from stillspin.drive.state import ENERGISED, STOP
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import DriveError, NoAnswerError

LINE_END = b"\r"
CTRL_C = b"\x03"
_QUIET = 0.2
"""Seconds without a character behind a prompt: nothing runs any more."""
_PATIENCE = 3.0
_KEEP_ALIVE = 0.1


class Session:
    """What goes to the console, and whether a motor runs by it."""

    def __init__(self, drive: Drive, keep_running: bool = False) -> None:
        self.keep_running = keep_running
        """Leave a motor that this session has started running when it ends."""
        self._drive = drive

    def send(self, line: str) -> None:
        """A line with its end.

        Raises:
            LinkError: the way is lost.
        """
        self._drive.link.transport.send_text(line.encode("ascii", "replace") + LINE_END)

    def interrupt(self) -> None:
        """Empties the line, or ends a long answer, at the drive."""
        self._drive.link.transport.send_text(CTRL_C)

    def holds_motor(self) -> bool:
        """Whether a motor runs that this session has started, and that its end would stop."""
        return self._drive.raw_status().held

    def clear(self) -> None:
        """End what the session before has left running, and what it left in the line; nothing of it is shown.

        Raises:
            NoAnswerError: no prompt comes.
        """
        heard = bytearray()
        came = threading.Event()

        def take(octets: bytes) -> None:
            heard.extend(octets)
            came.set()

        with self._drive.link.listening(text=take):
            self.interrupt()
            end = time.monotonic() + _PATIENCE
            while time.monotonic() < end:
                if not came.wait(_QUIET) and is_prompt(heard.rpartition(b"\n")[2].decode("ascii", "replace")):
                    return
                came.clear()
        raise NoAnswerError(f"no prompt from the console on {self._drive.link.transport.name}")

    def stop(self) -> None:
        """Stop a motor that this session has started, unless it is to run on."""
        if not self.keep_running:
            self._drive.let_go()

    def _set_free(self) -> str:
        """Take the watchdog off a motor that runs, and say what became of it.

        The port may be closed at once after this: the answer is waited for, so that no octet of the line is lost.
        """
        self.interrupt()
        self.send("start free")
        freed = wait_until(lambda: not self._drive.raw_status().guarded, _PATIENCE)
        if freed and self._drive.raw_status().state in ENERGISED - {STOP}:
            return "the motor runs on; nobody watches it"
        return "the motor does not run on: the drive has not taken 'start free'"

    def end(self) -> None:
        """End what still answers, and stop the motor of this session unless it is to run on."""
        if self._drive.link.lost:
            return
        if self.holds_motor():
            if self.keep_running:
                said = self._set_free()
            else:
                self._drive.stop()
                said = "the motor stops, because the session that started it ends"
            with suppress(OSError):  # the terminal may be gone
                print(said, flush=True)
        self.interrupt()


@contextmanager
def session(drive: Drive, *, keep_running: bool = False) -> Iterator[Session]:
    """A session on a serial port's console, until the context ends, by a signal too.

    Raises:
        NoAnswerError: the console shows no prompt.
    """
    current = Session(drive, keep_running)
    with _ends_orderly(current), drive.kept_alive(_KEEP_ALIVE):
        try:
            current.clear()
            yield current
        finally:
            with suppress(DriveError):
                current.end()


@contextmanager
def _ends_orderly(current: Session) -> Iterator[None]:
    """A closed terminal and a request to end (SIGHUP, SIGTERM) stop the motor and unwind the program.

    Whatever the program is at swallows an exception now and then: the motor does not wait for that, nor does the end.
    """
    ended = threading.Event()

    def see_to_it() -> None:
        with suppress(DriveError):
            current.stop()
        if not ended.wait(_PATIENCE):
            os._exit(ExitCode.INTERRUPTED)

    def leave(_number: int, _frame: FrameType | None) -> None:
        threading.Thread(target=see_to_it, daemon=True).start()
        raise SystemExit(ExitCode.INTERRUPTED)

    names = ("SIGHUP", "SIGTERM") if threading.current_thread() is threading.main_thread() else ()
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    before = [(number, signal.signal(number, leave)) for number in numbers]
    try:
        yield
    finally:
        ended.set()
        for number, handler in before:
            signal.signal(number, handler)
