"""The slow stream: up to eight signals every few milliseconds, with a count of what was lost on the way."""

from __future__ import annotations

import queue
import struct
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

from stillspin.counted import counted
from stillspin.drive.link_counts import ask_counts
from stillspin.drive.protocol import STREAM_EVENT, Request
from stillspin.drive.requester import Requester
from stillspin.drive.table import Signal
from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.link.records import Record

MOST = 8
_WAITING = 20000
_POLL = 0.2
_UNSENT = "not sent, the drive's port has no room for so many (fewer signals or a longer period help)"
_ON_THE_WAY = "lost on the way, this computer is too busy to fetch them or the line is disturbed"
_LEFT = "not fetched, this program is too busy"


@dataclass(frozen=True)
class Sample:
    """The signals of one control interrupt."""

    time: float
    """Seconds since the drive was switched on."""
    values: tuple[float, ...]
    """In the signals' units and order; NaN for what is unknown."""


class Stream:
    """Iterate over it for samples; use it as a context, or close it, to make the drive stop sending."""

    def __init__(self, requester: Requester, signals: Sequence[Signal], period: float) -> None:
        """Start the stream.

        Args:
            requester: the drive.
            signals: 1 to 8.
            period: s between samples, 1 ms and more.

        Raises:
            InputError: too many signals, or a period out of range.
        """
        if not 1 <= len(signals) <= MOST:
            raise InputError(f"a stream of {len(signals)} signals; 1 … {MOST} are possible")
        period_ms = round(period * 1e3)
        if not 1 <= period_ms <= 0xFFFF:
            raise InputError(f"a stream every {period:g} s; 0.001 … 65.535 s are possible")
        self.signals = tuple(signals)
        self.lost = 0
        """Samples that did not arrive."""
        self._left = 0  # of them, those that came and that nobody fetched in time
        self._requester = requester
        self._samples: queue.Queue[Sample] = queue.Queue(_WAITING)
        self._counter: int | None = None
        self._form = f"<I{len(signals)}iB"
        self._stack = ExitStack()
        self._stack.enter_context(requester.listening(event=self._take))
        numbers = struct.pack(f"<H{len(signals)}H", period_ms, *(signal.index for signal in signals))
        try:
            requester.request(Request.STREAM, numbers, repeat=True)
            self._stack.callback(self._stop)
        except BaseException:
            self._stack.close()
            raise

    def __enter__(self) -> Stream:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __iter__(self) -> Iterator[Sample]:
        while True:
            sample = self.next(_POLL)
            if sample is not None:
                yield sample

    def next(self, timeout: float) -> Sample | None:
        """The next sample, or None when none comes within `timeout` seconds.

        Raises:
            LinkError: the way to the drive is lost.
        """
        try:
            return self._samples.get(timeout=timeout)
        except queue.Empty:
            if self._requester.lost:
                raise self._requester.lost from None
            return None

    def why_lost(self) -> str:
        """How many samples did not arrive and where they went, for people; empty when all did. Asks the drive.

        The drive numbers its samples and counts those that it could not send: what is missing beside them was sent and
        did not get here.
        """
        if not (lost := self.lost):
            return ""
        said = f"{counted(lost, 'sample')} did not arrive"
        try:
            unsent = min(ask_counts(self._requester).unsent, lost - self._left)
        except DriveError:
            return said
        where = ((unsent, _UNSENT), (lost - unsent - self._left, _ON_THE_WAY), (self._left, _LEFT))
        parts = [(number, words) for number, words in where if number]
        if len(parts) == 1:
            return f"{said}: {parts[0][1]}"
        return f"{said}: " + "; ".join(f"{number} {words}" for number, words in parts)

    def close(self) -> None:
        """Make the drive stop sending."""
        self._stack.close()

    def _stop(self) -> None:
        if not self._requester.lost:
            self._requester.request(Request.STREAM, struct.pack("<H", 0), repeat=True)

    def _take(self, record: Record) -> None:
        if record.kind != STREAM_EVENT or len(record.body) != struct.calcsize(self._form):
            return
        if self._counter is not None:
            self.lost += (record.tag - self._counter - 1) % 256
        self._counter = record.tag
        time_ms, *raw, known = struct.unpack(self._form, record.body)
        self._put(time_ms / 1e3, raw, known)

    def _put(self, at: float, raw: Sequence[int], known: int) -> None:
        values = tuple(signal.to_user(value, known) for signal, value in zip(self.signals, raw, strict=True))
        try:
            self._samples.put_nowait(Sample(at, values))
        except queue.Full:
            self.lost += 1
            self._left += 1
