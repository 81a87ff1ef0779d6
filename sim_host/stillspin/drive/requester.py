"""Questions and answers over a transport: tags, time-outs, repetition, and whatever else comes in between."""

from __future__ import annotations

import contextlib
import queue
import random
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from stillspin.drive.protocol import Request, StatusCode
from stillspin.link.errors import DifferentError, LinkError, NoAnswerError, RefusedError
from stillspin.link.records import ANSWER, Record
from stillspin.link.splitter import Damaged, Item, Text
from stillspin.link.transport import Transport

_POLL = 0.05
_JOIN = 2.0

REASONS = {
    StatusCode.UNKNOWN: "the drive does not know this",
    StatusCode.RANGE: "out of range",
    StatusCode.RUNNING: "not while the motor is energised; stop it first",
    StatusCode.LENGTH: "the drive expects another length: client and firmware do not fit together",
    StatusCode.BUSY: "the drive is busy with another request; try again",
    StatusCode.STATE: "not in this state of the drive",
    StatusCode.CONFLICT: "the parameters do not go together",
    StatusCode.EDITION: "not in this edition of the firmware",
}


@dataclass
class Counts:
    """What has gone wrong on the way, since it was opened."""

    damaged: int = 0
    repeated: int = 0
    unexpected: int = 0


class Turns:
    """Who asks next: in the order of their coming; what is urgent goes before whatever else waits."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._taken = False
        self._waiting: deque[object] = deque()

    @contextmanager
    def turn(self, urgent: bool) -> Iterator[None]:
        """Wait for the turn, and have it while the context lasts."""
        me = object()
        with self._changed:
            (self._waiting.appendleft if urgent else self._waiting.append)(me)
            try:
                self._changed.wait_for(lambda: not self._taken and self._waiting[0] is me)
                self._taken = True
            finally:
                self._waiting.remove(me)
        try:
            yield
        finally:
            with self._changed:
                self._taken = False
                self._changed.notify_all()


class Requester:
    """Asks one question at a time, from any thread; hands events and text to whoever listens.

    A question that may be asked twice is repeated with the same tag, so that a late answer to the first still counts.
    """

    def __init__(self, transport: Transport, timeout: float = 0.6, tries: int = 4) -> None:
        self.transport = transport
        self.counts = Counts()
        self.timeout = timeout
        self.tries = tries
        self._tag = random.randrange(256)  # another client's answers on the same bus are unlikely to have mine
        self._turns = Turns()
        self._answers: queue.SimpleQueue[Record | LinkError] = queue.SimpleQueue()
        self._wanted: tuple[int, int] | None = None
        self._events: list[Callable[[Record], None]] = []
        self._texts: list[Callable[[bytes], None]] = []
        self._lost: LinkError | None = None
        self._closing = threading.Event()
        self._thread = self._begin()

    def request(
        self, kind: Request, body: bytes = b"", *, repeat: bool, timeout: float | None = None, urgent: bool = False
    ) -> bytes:
        """The body of the drive's answer.

        Args:
            kind: what is asked.
            body: of the request.
            repeat: ask again when no answer comes.
            timeout: seconds to wait for each answer.
            urgent: before all that waits, also before the repetition of what was not answered.

        Raises:
            RefusedError: the drive says no.
            NoAnswerError: it says nothing.
            LinkError: the way to it is lost.
        """
        record: Record | None = None
        for attempt in range(self.tries if repeat else 1):
            with self._turns.turn(urgent):
                record = record or self._numbered(kind, body)
                self.counts.repeated += attempt > 0
                answer = self._ask(record, timeout or self.timeout)
            if answer is not None:
                return accepted(answer)
        again = "" if repeat else "; whether it did what was asked is not known"
        raise NoAnswerError(f"no answer from the drive on {self.transport.name}{again}")

    @contextmanager
    def resting(self) -> Iterator[None]:
        """Leave the transport to somebody else while the context lasts; questions wait until then."""
        with self._turns.turn(urgent=False):
            self._end()
            try:
                yield
            finally:
                self._closing.clear()
                self._thread = self._begin()

    @contextmanager
    def listening(
        self, event: Callable[[Record], None] | None = None, text: Callable[[bytes], None] | None = None
    ) -> Iterator[None]:
        """Hand events or text over while the context lasts; called in the receiving thread, must not ask."""
        if event:
            self._events.append(event)
        if text:
            self._texts.append(text)
        try:
            yield
        finally:
            if event:
                self._events.remove(event)
            if text:
                self._texts.remove(text)

    @property
    def lost(self) -> LinkError | None:
        """Why nothing comes any more, if so."""
        return self._lost

    def close(self) -> None:
        """End the thread, give the port back. Who asks from now on, or waits for an answer, is told so."""
        self._end()
        closed = LinkError(f"the drive on {self.transport.name} is closed: close() was called or its context is over")
        self._lost = closed
        self._answers.put(closed)
        self.transport.close()

    def _begin(self) -> threading.Thread:
        thread = threading.Thread(target=self._receive, name="stillspin link", daemon=True)
        thread.start()
        return thread

    def _end(self) -> None:
        self._closing.set()
        if threading.current_thread() is not self._thread:
            self._thread.join(_JOIN)

    def _numbered(self, kind: Request, body: bytes) -> Record:
        self._tag = (self._tag + 1) % 256
        return Record(kind, self._tag, body)

    def _ask(self, record: Record, timeout: float) -> Record | None:
        while not self._answers.empty():
            self._answers.get()
        if self._lost:
            raise self._lost
        self._wanted = (record.kind | ANSWER, record.tag)
        try:
            self.transport.send(record)
            answer = self._answers.get(timeout=timeout)
        except queue.Empty:
            return None
        finally:
            self._wanted = None
        if isinstance(answer, LinkError):
            raise answer
        return answer

    def _receive(self) -> None:
        while not self._closing.is_set():
            try:
                items = self.transport.receive(_POLL)
            except LinkError as error:
                self._lost = error
                self._answers.put(error)
                return
            for item in items:
                self._dispatch(item)

    def _dispatch(self, item: Item) -> None:
        if isinstance(item, Damaged):
            self.counts.damaged += 1
        elif isinstance(item, Text):
            for take_text in list(self._texts):
                take_text(item.octets)
        elif item.is_answer:
            if (item.kind, item.tag) == self._wanted:
                self._answers.put(item)
            else:
                self.counts.unexpected += 1
        elif item.is_event:
            for take_event in list(self._events):
                take_event(item)


def accepted(answer: Record) -> bytes:
    """The body of an answer.

    Raises:
        RefusedError: the drive says no.
        DifferentError: it is no answer of this protocol.
    """
    if not answer.body:
        raise DifferentError("an answer without a status: install the client that belongs to the firmware")
    status, body = answer.body[0], answer.body[1:]
    if status == StatusCode.OK:
        return body
    words = body.decode("ascii", "replace").strip("\0 ") if body else ""
    with contextlib.suppress(ValueError):
        words = words or REASONS[StatusCode(status)]
    raise RefusedError(words or f"the drive refuses, status {status}", status)


def wait_until(condition: Callable[[], bool], timeout: float, interval: float = 0.02) -> bool:
    """Whether `condition` came true within `timeout` seconds."""
    end = time.monotonic() + timeout
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(interval)
    return True
