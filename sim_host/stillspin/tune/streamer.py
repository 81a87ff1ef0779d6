"""Streams the plotted signals from the drive to the pages, in batches."""

from __future__ import annotations

import threading
import time

from stillspin.drive import Drive, Stream
from stillspin.link.errors import DriveError, LinkError
from stillspin.tune.connection import Connection
from stillspin.tune.history import History
from stillspin.tune.messages import Tell

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
        self._names = self._known(_DEFAULT)
        self.history = History()

    @property
    def names(self) -> list[str]:
        """Of the signals that are streamed."""
        return list(self._names)

    def choose(self, names: list[str]) -> None:
        """Stream these from now on."""
        self._names = list(dict.fromkeys(names))
        self._anew.set()

    def run(self) -> None:
        """See Thread."""
        while not self._end.is_set():
            self._anew.clear()
            drive = self._way.drive
            names = self._known(self._names)
            try:
                with drive.stream(names, _PERIOD) as stream:
                    self._tell({"t": "plotted", "signals": names})
                    self.history.begin({signal.name: signal.unit for signal in stream.signals})
                    self._forward(stream, drive)
            except DriveError as error:
                if not (isinstance(error, LinkError) or self._way.trouble):  # the watch says those
                    self._tell({"t": "note", "text": str(error)})
                self._end.wait(_AGAIN)

    def _forward(self, stream: Stream, drive: Drive) -> None:
        times: list[float] = []
        rows: list[tuple[float, ...]] = []
        sent = time.monotonic()
        while (
            self._way.drive is drive and self._way.silence < _SILENT and not (self._end.is_set() or self._anew.is_set())
        ):
            sample = stream.next(_BATCH)
            if sample:
                times.append(sample.time)
                rows.append(sample.values)
            now = time.monotonic()
            if rows and now - sent >= _BATCH:
                columns = [list(column) for column in zip(*rows, strict=True)]
                self.history.add(times, columns)
                self._tell({"t": "samples", "time": times, "values": columns, "lost": stream.lost})
                times, rows, sent = [], [], now

    def _known(self, names: list[str]) -> list[str]:
        known = [signal.name for signal in self._way.drive.table.signals]
        return [name for name in dict.fromkeys(names) if name in known] or known[:1]
