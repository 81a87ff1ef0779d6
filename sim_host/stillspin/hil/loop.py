"""Steps a board through the periods of a run."""

from __future__ import annotations

import hashlib
import struct
import time
from dataclasses import dataclass

from stillspin.core import NativeCore, Progress
from stillspin.drive.protocol import Request, StatusCode
from stillspin.drive.requester import Requester
from stillspin.errors import CampaignError
from stillspin.execute import Job, play
from stillspin.hil import told
from stillspin.link.errors import RefusedError

_SIGNALS_AT_ONCE = 16
_PERIOD = 1e-4  # s


@dataclass(frozen=True)
class Difference:
    """The first period in which a board does something else. `step`: from power-on."""

    step: int
    words: str

    def __str__(self) -> str:
        return f"step {self.step} ({self.step * _PERIOD:.4f} s from power-on): {self.words}"


@dataclass(frozen=True)
class LoopResult:
    """What came of a run.

    Attributes:
        steps: periods that the board was stepped through; seconds: how long that took.
        board, native: hashes over everything that the two said, in hexadecimal; equal when they agree.
        difference: None when they agree.
        reason: why the run itself broke off, empty when it did not.
    """

    steps: int
    seconds: float
    board: str
    native: str
    difference: Difference | None
    reason: str

    @property
    def rate(self) -> float:
        """Steps per second."""
        return self.steps / self.seconds if self.seconds > 0.0 else 0.0


class Loop:
    """A board that is stepped by this computer, which runs the plant.

    Every period the virtual drive executes is sent to the board with all that the hardware said in it; the board's
    answer has to be the same to the last bit. Its own power stage stays off until it is reset.
    """

    def __init__(self, requester: Requester) -> None:
        self._requester = requester
        self._steps = 0
        self._difference: Difference | None = None
        self._error: Exception | None = None

    def run(self, native: NativeCore, job: Job, progress: Progress | None = None) -> LoopResult:
        """One run of a scenario on the virtual drive and, period by period, on the board.

        Raises:
            CampaignError: the board cannot be put into the loop.
            LinkError: the way to the board is lost.
        """
        self._enter()
        hashes = hashlib.sha256(), hashlib.sha256()
        begin = time.perf_counter()

        def step(requests: list[bytes], body: bytes, expected: bytes, signals: bytes) -> bool:
            if self._difference or self._error:
                return False  # the run goes on for some periods before it is broken off
            try:
                self._ask(requests)
                answer = self._requester.request(Request.HIL_STEP, body, repeat=True)
                hashes[0].update(answer)
                hashes[1].update(expected)
                if answer != expected:
                    words = self._compare(told.answer(answer), told.answer(expected), signals)
                    self._difference = Difference(self._steps, words)
            except Exception as error:
                self._error = error
            self._steps += 1
            return self._difference is None and self._error is None

        result = play(native, job, progress, step)
        if self._error:
            raise self._error
        seconds = time.perf_counter() - begin
        reason = "" if self._difference else result.reason
        board, ours = (hash_.hexdigest() for hash_ in hashes)
        return LoopResult(self._steps, seconds, board, ours, self._difference, reason)

    def leave(self) -> None:
        """Let the board reset itself."""
        self._requester.request(Request.HIL_LEAVE, repeat=True)

    def _enter(self) -> None:
        self._steps, self._difference, self._error = 0, None, None
        try:
            self._requester.request(Request.HIL_ENTER, repeat=True)
        except RefusedError as error:
            raise CampaignError(f"the board does not go into the loop: {error}") from error

    def _ask(self, requests: list[bytes]) -> None:
        for request in requests:
            try:
                self._requester.request(Request(request[0]), request[1:], repeat=True)
            except RefusedError as error:
                # With the power stage off a parameter is taken even if it does not go together with the others yet.
                if error.status != StatusCode.CONFLICT:
                    raise

    def _compare(self, board: told.Answer, native: told.Answer, signals: bytes) -> str:
        """What is different, in words."""
        if board.torn:
            return "the board asked its hardware for something else than the virtual drive did"
        words = told.difference(board, native)
        if words:
            return words
        ours = struct.unpack(f"<{len(signals) // 4}i", signals)
        for first in range(0, len(ours), _SIGNALS_AT_ONCE):
            wanted = range(first, min(first + _SIGNALS_AT_ONCE, len(ours)))
            body = self._requester.request(Request.SIGNALS, struct.pack(f"<{len(wanted)}H", *wanted), repeat=True)
            theirs = struct.unpack_from(f"<{len(wanted)}i", body, len(body) - 4 * len(wanted))
            for index, value in zip(wanted, theirs, strict=True):
                if value != ours[index]:
                    name = self._requester.request(Request.SIGNAL_INFO, struct.pack("<H", index), repeat=True)
                    text = name[1:].split(b"\0")[0].decode("ascii", "replace")
                    return f"signal {text}: {value} on the board, {ours[index]} on the virtual drive (raw)"
        return "the check sums of the signals differ, the signals do not any more"
