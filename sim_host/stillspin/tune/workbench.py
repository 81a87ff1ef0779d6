"""The drive as the page sees it: one watcher that asks for its status, stops it when nobody holds it, and streams."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from stillspin.drive import Drive, Stream
from stillspin.drive.protocol import GUARDED, Command
from stillspin.drive.state import COMMISSIONING_RUNNING, Status
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, LinkError
from stillspin.tune.dead_man import PATIENCE, DeadMan

Message = dict[str, Any]
Tell = Callable[[Message], None]

_STATUS = 0.1
_BATCH = 0.05
_STREAM = 0.02
_DEFAULT = ["speed", "speed_reference", "current_d", "current_q"]


class Workbench:
    """Everything blocks: call it from a thread. `tell` gets what all pages should know, from any thread."""

    def __init__(self, drive: Drive, tell: Tell, patience: float = PATIENCE) -> None:
        self.drive = drive
        self.dead_man = DeadMan(patience)
        self.tell = tell
        self._end = threading.Event()
        self._stop_owed = False
        self._plotted = list(dict.fromkeys(self._known(_DEFAULT)))
        self._replot = threading.Event()
        self._last: Message = {}
        self._capture = 0
        self._threads = [
            threading.Thread(target=self._watch, name="stillspin watch", daemon=True),
            threading.Thread(target=self._pump, name="stillspin stream", daemon=True),
        ]

    def begin(self) -> None:
        """Watch and stream from now on."""
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """Stop the motor if a page holds it, and end."""
        if self.dead_man.release():
            self.stop()
        self._end.set()
        for thread in self._threads:
            thread.join(2.0)

    # Commands

    def start(self, who: str, speed: float) -> None:
        """Start; it goes on while `who` tells the dead man's switch so."""
        self._run(who, lambda: self.drive.start(speed, guarded=True))

    def commission(self, who: str) -> None:
        """Measure machine and inverter; goes on as `start` does."""
        self._run(who, lambda: self.drive.command(Command.COMMISSION, GUARDED))

    def _run(self, who: str, command: Callable[[], None]) -> None:
        status = self.drive.raw_status()
        if status.outcome == COMMISSIONING_RUNNING or self.drive.describe_status(status).energised:
            raise DriveError("the motor runs already")
        self.dead_man.take(who)
        try:
            command()
        except DriveError:
            if self.dead_man.release(who):
                self.stop()  # the command may have arrived although its answer did not
            raise
        if not self.dead_man.is_held_by(who):  # let go while the command was under way
            self._stop()

    def release(self, who: str, why: str) -> None:
        """`who` has let go: the motor stops if it was his."""
        if self.dead_man.release(who):
            self.stop()
            self.tell({"t": "note", "text": why})

    def stop(self) -> None:
        """Stop, whoever holds it."""
        self.dead_man.release()
        self._stop()

    def _stop(self) -> None:
        """Stop; what fails is tried again by the watch, which asks for nothing else until then."""
        self._stop_owed = True
        self.drive.stop()
        self._stop_owed = False

    def coast(self) -> None:
        """Gates off, whoever holds it."""
        self.dead_man.release()
        self.drive.coast()

    def plot(self, names: list[str]) -> None:
        """Stream these signals."""
        self.drive.table.chosen(names)
        if not 1 <= len(names) <= 8:
            raise InputError(f"{len(names)} signals; 1 … 8 can be plotted at once")
        self._plotted = list(dict.fromkeys(names))
        self._replot.set()

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
        return list(self._plotted)

    @property
    def last_status(self) -> Mapping[str, Any]:
        """As it was told last."""
        return self._last

    # Threads

    def _watch(self) -> None:
        """The dead man's switch and the questions that keep a guarded drive running are one loop: both, or neither."""
        while not self._end.wait(_STATUS):
            try:
                if self.dead_man.expired():
                    self._stop_owed = True
                if self._stop_owed:
                    self._stop()
                    self.tell({"t": "note", "text": "stopped: nothing was heard from the page"})
                self._last = status_message(self.drive.status())
                self.tell(self._last)
            except LinkError as error:
                self.tell({"t": "lost", "text": str(error)})
                return
            except DriveError as error:
                self.tell({"t": "note", "text": str(error)})

    def _pump(self) -> None:
        while not self._end.is_set():
            self._replot.clear()
            names = self.plotted
            if not names:
                return
            try:
                with self.drive.stream(names, _STREAM) as stream:
                    self.tell({"t": "plotted", "signals": names})
                    self._forward(stream)
            except LinkError:
                return
            except DriveError as error:
                self.tell({"t": "note", "text": str(error)})
                self._end.wait(1.0)

    def _forward(self, stream: Stream) -> None:
        times: list[float] = []
        rows: list[tuple[float, ...]] = []
        sent = time.monotonic()
        while not (self._end.is_set() or self._replot.is_set()):
            sample = stream.next(_BATCH)
            if sample:
                times.append(sample.time)
                rows.append(sample.values)
            now = time.monotonic()
            if rows and now - sent >= _BATCH:
                columns = [list(column) for column in zip(*rows, strict=True)]
                self.tell({"t": "samples", "time": times, "values": columns, "lost": stream.lost})
                times, rows, sent = [], [], now

    def _known(self, names: list[str]) -> list[str]:
        known = [signal.name for signal in self.drive.table.signals]
        return [name for name in names if name in known] or known[:1]


def status_message(status: Status) -> Message:
    """A status for the page."""
    raw = status.raw
    return {
        "t": "status",
        "time": status.time,
        "state": status.state,
        "number": raw.state,
        "energised": status.energised,
        "fault": status.fault,
        "remedy": status.remedy,
        "limits": list(status.limits),
        "speed": status.speed,
        "reference": status.reference,
        "store": status.store,
        "commissioning": {"outcome": raw.outcome, "phase": raw.phase, "progress": raw.progress / 1000},
    }
