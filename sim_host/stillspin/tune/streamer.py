"""Streams the plotted signals from the drive to the pages, in batches."""

from __future__ import annotations

import threading
import time

from stillspin.drive import Drive, Stream
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, LinkError
from stillspin.tune.connection import Connection
from stillspin.tune.derived import Choice
from stillspin.tune.history import History
from stillspin.tune.messages import Tell, for_page

_BATCH = 0.05
_PERIOD = 0.02
_AGAIN = 0.2
_SILENT = 1.0
_DEFAULT = ["speed", "speed_reference", "current_d", "current_q"]


class Streamer(threading.Thread):
    """One stream, begun anew when other signals are wanted, the drive is another, or it has been silent."""

    def __init__(self, connection: Connection, tell: Tell, end: threading.Event) -> None:
        super().__init__(name="stillspin stream", daemon=True)
        self._way = connection
        self._tell = tell
        self._end = end
        self._anew = threading.Event()
        self._names = list(_DEFAULT)
        self._parameters: dict[str, float] = {}
        self.history = History()

    @property
    def names(self) -> list[str]:
        """Of the signals that are plotted."""
        return self._choice().names

    def choose(self, names: list[str]) -> None:
        """Plot these from now on.

        Raises:
            InputError: no such signal, or too many.
        """
        self._names = Choice(names, self._way.drive.table).names
        self._anew.set()

    def learn(self, values: dict[str, float]) -> None:
        """Parameters that are in force now."""
        self._parameters |= values

    def run(self) -> None:
        """See Thread."""
        while not self._end.is_set():
            self._anew.clear()
            drive, choice = self._way.drive, self._choice()
            try:
                self.learn({name: drive.get(name) for name in choice.parameters})
                with drive.stream(choice.streamed, _PERIOD) as stream:
                    self._tell({"t": "plotted", "signals": choice.names})
                    self.history.begin(choice.units)
                    self._forward(stream, drive, choice)
            except DriveError as error:
                if not (isinstance(error, LinkError) or self._way.trouble):  # the watch says those
                    self._tell({"t": "note", "text": str(error)})
                self._end.wait(_AGAIN)

    def _forward(self, stream: Stream, drive: Drive, choice: Choice) -> None:
        times: list[float] = []
        rows: list[list[float]] = []
        sent = asked = time.monotonic()
        lost, why = 0, ""
        while (
            self._way.drive is drive and self._way.silence < _SILENT and not (self._end.is_set() or self._anew.is_set())
        ):
            sample = stream.next(_BATCH)
            if sample:
                times.append(sample.time)
                rows.append(choice.row(sample.values, self._parameters))
            now = time.monotonic()
            if rows and now - sent >= _BATCH:
                if stream.lost != lost and now - asked >= _SILENT:
                    why, lost, asked = stream.why_lost(), stream.lost, now
                self._hand_over(times, [list(column) for column in zip(*rows, strict=True)], why)
                times, rows, sent = [], [], now

    def _hand_over(self, times: list[float], columns: list[list[float]], lost: str) -> None:
        self.history.add(times, columns)
        shown = [list(map(for_page, column)) for column in columns]
        self._tell({"t": "samples", "time": times, "values": shown, "lost": lost})

    def _choice(self) -> Choice:
        """What is wanted, as far as this drive has it."""
        table = self._way.drive.table
        try:
            return Choice(self._names, table)
        except InputError:
            known = [signal.name for signal in table.signals]
            return Choice([name for name in self._names if name in known][:4] or known[:1], table)
