"""The watcher: asks the drive what it does, stops it when nobody holds it, and opens it again when it was away."""

from __future__ import annotations

import threading

from stillspin.link.errors import DriveError, LinkError, NoAnswerError
from stillspin.tune.connection import Connection, SwitchedOnError
from stillspin.tune.dead_man import DeadMan
from stillspin.tune.describe import describe
from stillspin.tune.messages import Tell, status_message
from stillspin.tune.streamer import Streamer

_STATUS = 0.1
_AGAIN = "stopped; it took more than one try"


class Watch(threading.Thread):
    """The dead man's switch and the questions that keep a guarded drive running are one loop: both, or neither."""

    def __init__(
        self, way: Connection, dead_man: DeadMan, streamer: Streamer, tell: Tell, end: threading.Event
    ) -> None:
        super().__init__(name="stillspin watch", daemon=True)
        self._way, self._dead_man, self._streamer = way, dead_man, streamer
        self._tell, self._end = tell, end
        self._owed: str | None = None
        """That the motor must still be stopped: what is told when it is, empty for nothing."""
        self._whoever = False
        """Whether it must be stopped also when somebody else has started it."""
        self._away = False

    def stop(self) -> None:
        """Stop, whoever holds it; what fails is tried again here, and nothing else is asked until then."""
        self._try(whoever=True)

    def let_go(self) -> bool:
        """The same for a motor that runs by a start of this page's, and for no other; whether it did."""
        return self._try(whoever=False)

    def _try(self, *, whoever: bool) -> bool:
        """At once. The watch, which comes by meanwhile, tries as well, and tells it only when this has failed."""
        self._owe("", whoever=whoever)
        try:
            return self._settle()
        except DriveError:
            if self._owed is not None:
                self._owed = _AGAIN
            raise

    def _owe(self, why: str, *, whoever: bool = False) -> None:
        self._owed, self._whoever = why, whoever

    def _settle(self) -> bool:
        drive = self._way.drive
        stopped = self._whoever or drive.let_go()
        if self._whoever:
            drive.stop()
        self._owed = None
        return stopped

    def run(self) -> None:
        """See Thread."""
        while not self._end.wait(_STATUS):
            try:
                if self._away:
                    self._come_back()
                else:
                    self._look()
            except NoAnswerError:
                self._say_away("silent")
            except LinkError as error:
                self._lose(error)
            except DriveError as error:
                self._tell({"t": "note", "text": str(error)})

    def _look(self) -> None:
        if self._dead_man.expired():
            self._owe("stopped: nothing was heard from the page")
        if (why := self._owed) is not None and self._settle() and why:
            self._tell({"t": "note", "text": why})
        self._tell(status_message(self._way.drive.describe_status(self._way.look())))

    def _lose(self, error: LinkError) -> None:
        self._away = True
        # A drive with a long link_timeout may still be running when it is back, and the first question keeps it so.
        if self._dead_man.release():
            self._owe("stopped: the connection to the drive was lost")
        if isinstance(error, SwitchedOnError):
            self._owed = None
            self._tell({"t": "note", "text": str(error)})
        self._say_away("lost")

    def _come_back(self) -> None:
        if self._way.reopen():
            self._tell(describe(self._way.drive, self._streamer.names))
            self._away = False
        else:
            self._say_away("lost")

    def _say_away(self, kind: str) -> None:
        self._tell({"t": kind, "text": self._way.trouble, "for": self._way.silence})
