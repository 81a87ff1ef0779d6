"""The drive as the page sees it: commands, the dead man's switch over them, and what is to be plotted."""

from __future__ import annotations

import threading
from collections.abc import Callable

from stillspin.drive import Drive
from stillspin.drive.protocol import Command
from stillspin.drive.state import COMMISSIONING_RUNNING
from stillspin.link.errors import DriveError
from stillspin.tune.connection import Connection
from stillspin.tune.dead_man import PATIENCE, DeadMan
from stillspin.tune.messages import Tell
from stillspin.tune.streamer import Streamer
from stillspin.tune.watch import Watch


class Workbench:
    """Everything blocks: call it from a thread. `tell` gets what all pages should know, from any thread."""

    def __init__(
        self, drive: Drive, tell: Tell, patience: float = PATIENCE, reopen: Callable[[], Drive] | None = None
    ) -> None:
        self.connection = Connection(drive, reopen)
        self.dead_man = DeadMan(patience)
        self.tell = tell
        self._end = threading.Event()
        self._capture = 0
        self.streamer = Streamer(self.connection, tell, self._end)
        self.watch = Watch(self.connection, self.dead_man, self.streamer, tell, self._end)

    @property
    def drive(self) -> Drive:
        """The drive; another object after it has been opened again."""
        return self.connection.drive

    def begin(self) -> None:
        """Watch and stream from now on."""
        self.watch.start()
        self.streamer.start()

    def close(self) -> None:
        """Stop the motor if a page holds it, and end."""
        try:
            if self.dead_man.release():
                self.watch.let_go()
        finally:
            self._end.set()
            self.watch.join()
            self.streamer.join()
            self.connection.close()

    # Commands

    def start(self, who: str, speed: float | str) -> None:
        """Start; it goes on while `who` tells the dead man's switch so."""
        self._run(who, lambda: self.drive.start(speed, guarded=True))

    def commission(self, who: str) -> None:
        """Measure machine and inverter; goes on as `start` does."""
        self._run(who, lambda: self.drive.command(Command.COMMISSION, self.drive.hold()))

    def _run(self, who: str, command: Callable[[], None]) -> None:
        status = self.drive.raw_status()
        if status.outcome == COMMISSIONING_RUNNING or self.drive.describe_status(status).energised:
            raise DriveError("the motor runs already")
        self.dead_man.take(who)
        try:
            command()
        except DriveError:
            if self.dead_man.release(who):
                self.watch.let_go()  # the command may have arrived although its answer did not
            raise
        if not self.dead_man.is_held_by(who):  # let go while the command was under way
            self.watch.let_go()

    def release(self, who: str, why: str) -> None:
        """`who` has let go: the motor stops if it was his."""
        if self.dead_man.release(who) and self.watch.let_go():
            self.tell({"t": "note", "text": why})

    def stop(self) -> None:
        """Stop, whoever holds it."""
        self.dead_man.release()
        self.watch.stop()

    def look_again(self) -> None:
        """Try to open a drive that is away now, and not only in half a second."""
        self.connection.hurry()

    def coast(self) -> None:
        """Gates off, whoever holds it."""
        self.dead_man.release()
        self.drive.coast()

    def plot(self, names: list[str]) -> None:
        """Stream these signals."""
        self.streamer.choose(names)

    def begin_capture(self) -> int:
        """The number of a new capture; from now on no other is under way."""
        self._capture += 1
        return self._capture

    def captures(self, number: int) -> bool:
        """Whether it is this capture that is under way."""
        return number == self._capture and not self._end.is_set()

    @property
    def plotted(self) -> list[str]:
        """Names of the signals that are streamed."""
        return self.streamer.names
