"""Questions to a drive on a virtual board of this process, whose time passes period by period while an answer is due.

No thread and no clock: the same board, the same run.
"""

from __future__ import annotations

from collections.abc import Callable

from stillspin.board.advancing import advancing
from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.core_board import NativeBoard
from stillspin.drive.protocol import CONTROL_PERIOD, REPEATABLE, Request
from stillspin.drive.requester import accepted
from stillspin.link.errors import NoAnswerError, RefusedError
from stillspin.link.records import ANSWER, Record, to_wire
from stillspin.link.splitter import Splitter

PERIOD = round(CONTROL_PERIOD * TICKS_PER_SECOND)
"""Ticks."""
_PATIENCE = 3000
"""Periods until an answer is no longer waited for."""
_TRIES = 3
_COUNTER = 0x6804
"""TBCTR of ePWM1, which begins the drive's periods."""
_TAGS = 256


class SerialClient:
    """The far end of the board's serial line.

    Attributes:
        period: how many have passed since the board was switched on.
        refused: what the drive said no to of what it was told.
        sent: when what was sent, as a recording has it.
    """

    def __init__(self, board: NativeBoard, passed: Callable[[], None], event: Callable[[Record], None]) -> None:
        """Of a board that has just been switched on.

        Args:
            board: with the firmware or an image.
            passed: called behind every period.
            event: gets what the drive sends unasked, in the period in which its last octet came.
        """
        self.period = 0
        self.refused: list[str] = []
        self.sent: list[tuple[float, str]] = []
        self._board, self._passed, self._event = board, passed, event
        self._splitter = Splitter()
        self._tag = 0
        self._told: dict[int, str] = {}
        self._answer: Record | None = None

    def align(self) -> None:
        """Let the periods here begin with those of ePWM1, which counts ticks up."""
        self._advance((PERIOD - self._board.inspect(_COUNTER)) % PERIOD)

    def pass_periods(self, count: int) -> None:
        """Let time pass.

        Raises:
            CampaignError: the chip cannot go on.
        """
        for _ in range(count):
            self._advance(PERIOD)
            self.period += 1
            self._take(bytes(self._board.serial_read()))
            self._passed()

    def ask(self, kind: Request, body: bytes) -> bytes:
        """The body of the answer; a question that may be asked twice is repeated with its tag.

        Raises:
            RefusedError: the drive says no.
            NoAnswerError: nothing came.
            CampaignError: the chip cannot go on.
        """
        record = self._record(kind, body)
        self._answer = None
        for _ in range(_TRIES if kind in REPEATABLE else 1):
            self._send(record)
            for _ in range(_PATIENCE):
                self.pass_periods(1)
                if self._answer:
                    return accepted(self._answer)
        raise NoAnswerError(f"no answer to {kind.name} in the board's time")

    def tell(self, kind: Request, body: bytes, words: str) -> None:
        """Ask, and do not wait; what is refused is noted, with these words."""
        record = self._record(kind, body)
        self._told[record.tag] = words
        self._send(record)

    def _send(self, record: Record) -> None:
        octets = to_wire(record)
        self.sent.append((self._board.now / TICKS_PER_SECOND, octets.hex()))
        self._board.serial_write(octets)

    def _record(self, kind: Request, body: bytes) -> Record:
        self._tag = (self._tag + 1) % _TAGS
        self._told.pop(self._tag, None)
        return Record(kind, self._tag, body)

    def _advance(self, ticks: int) -> None:
        with advancing():
            self._board.advance(ticks)

    def _take(self, octets: bytes) -> None:
        for item in self._splitter.feed(octets, self.period * CONTROL_PERIOD):
            if not isinstance(item, Record):
                continue
            if item.is_event:
                self._event(item)
            elif item.tag in self._told:
                self._note(item, self._told.pop(item.tag))
            elif item.tag == self._tag and item.kind & ANSWER:
                self._answer = item

    def _note(self, answer: Record, words: str) -> None:
        try:
            accepted(answer)
        except RefusedError as error:
            self.refused.append(f"{words}: {error}")
