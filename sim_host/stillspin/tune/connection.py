"""The way to the drive: what is heard on it, and opening it again for as long as it takes."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from stillspin.drive import Drive
from stillspin.drive.state import RawStatus
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, LinkError, NoAnswerError

_ANSWER = 0.25
"""Seconds to wait for a status; the next question comes at once, so none is repeated."""
_AGAIN = 0.5
_STEP_BACK = 0.5
"""Seconds by which the drive's clock must be behind to have been switched on anew."""


class SwitchedOnError(LinkError):
    """The drive has been switched off and on: nothing that was known of it holds."""


class Connection:
    """The drive of the page. One thread looks and opens; every thread may use `drive`."""

    def __init__(self, drive: Drive, reopen: Callable[[], Drive] | None) -> None:
        self.drive = drive
        self.trouble = ""
        """Why nothing is known of the drive, in words; empty when it answers."""
        self._first = drive
        self._open = reopen
        self._heard = time.monotonic()
        self._time = 0.0
        self._next = 0.0
        self._hurry = threading.Event()

    @property
    def silence(self) -> float:
        """Seconds since the drive was heard last."""
        return time.monotonic() - self._heard

    def look(self) -> RawStatus:
        """What the drive does, asked once.

        Raises:
            NoAnswerError: it did not say.
            LinkError: the way is lost; SwitchedOnError: the drive began anew.
        """
        name = self.drive.link.transport.name
        try:
            status = self.drive.raw_status(once=_ANSWER)
        except NoAnswerError:
            self.trouble = f"the drive on {name} does not answer: is it switched on, is the cable in?"
            raise
        except LinkError as error:
            self.trouble = str(error)
            raise
        at = status.time_ms / 1e3
        self._heard, before, self._time = time.monotonic(), self._time, at
        if self._open and at < before - _STEP_BACK:
            self.trouble = "the drive was switched off and on again: what was not saved is lost"
            raise SwitchedOnError(self.trouble)
        self.trouble = ""
        return status

    def hurry(self) -> None:
        """Try to open it now."""
        self._hurry.set()

    def reopen(self) -> bool:
        """Try to open the drive again, twice a second; true when it is there.

        Raises:
            LinkError: it can not be opened again, because nobody said how.
        """
        if not self._open:
            raise LinkError(self.trouble)
        if time.monotonic() < self._next and not self._hurry.is_set():
            return False
        self._hurry.clear()
        self._next = time.monotonic() + _AGAIN
        holder = self.drive.holder
        self.drive.close()
        try:
            self.drive = self._open()
        except (DriveError, InputError) as error:
            self.trouble = str(error)
            return False
        self.drive.holder = holder  # what ran for the page is still the page's
        self._heard, self._time, self.trouble = time.monotonic(), 0.0, ""
        return True

    def close(self) -> None:
        """Give a port back that was opened here."""
        if self.drive is not self._first:
            self.drive.close()
