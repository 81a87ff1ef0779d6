"""Steps a board through the periods of a run."""

from __future__ import annotations

import hashlib
import struct
import time
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass

from stillspin.core import NativeCore, Progress
from stillspin.core_loop import NativeStepLoop
from stillspin.drive import describe
from stillspin.drive.protocol import Request
from stillspin.drive.requester import REASONS, Requester
from stillspin.errors import CampaignError
from stillspin.hil import told
from stillspin.hil.recording import Pair
from stillspin.link.errors import DriveError, LinkError, RefusedError

_SIGNALS_AT_ONCE = 16
_PERIOD = 1e-4  # s
_TOLD_EVERY = 64  # requests

Play = Callable[[NativeCore, Progress, NativeStepLoop], str]
"""A run on the virtual drive whose recording the loop takes; the reason why it broke off, empty when it did not."""


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


class _Log:
    """The hashes over what board and virtual drive have said."""

    def __init__(self, loop: NativeStepLoop) -> None:
        self._loop = loop
        self._hashes = hashlib.sha256(), hashlib.sha256()

    def take(self) -> None:
        """Whatever has been said meanwhile."""
        for hash_, octets in zip(self._hashes, self._loop.take_logs(), strict=True):
            hash_.update(octets)

    @property
    def digests(self) -> tuple[str, str]:
        """Of the board and of the virtual drive."""
        board, native = (hash_.hexdigest() for hash_ in self._hashes)
        return board, native


class Loop:
    """A board that is stepped by this computer, which runs the plant.

    Every period the virtual drive executes is sent to the board with all that the hardware said in it; the board's
    answer has to be the same to the last bit. Its own power stage stays off until it is reset.
    """

    def __init__(self, requester: Requester, note: Callable[[bytes, bytes], None] | None = None) -> None:
        """`note` is told each request and its answer, which takes longer."""
        self._requester = requester
        self._note = note
        self._error: DriveError | None = None

    def run(self, native: NativeCore, play: Play, progress: Progress | None = None) -> LoopResult:
        """One run on the virtual drive and, period by period, on the board.

        Raises:
            CampaignError: the board cannot be put into the loop.
            DriveError: the way to the board is lost, or it refuses what the run asks of it.
        """
        self._enter()
        port = None if self._note else self._requester.transport.port
        loop = native.StepLoop.through(*port) if port else native.StepLoop.asking(self._ask)
        log = _Log(loop)

        def look(share: float) -> bool:
            log.take()
            return progress is None or progress(share)

        begin = time.perf_counter()
        with self._requester.resting() if port else nullcontext():
            reason = play(native, look, loop)
            loop.finish()
        seconds = time.perf_counter() - begin
        log.take()
        self._check(loop)
        difference = self._difference(loop)
        return LoopResult(loop.steps, seconds, *log.digests, difference, "" if difference else reason)

    def play(self, said: Sequence[Pair], progress: Progress | None = None) -> LoopResult:
        """One run as it is in a recording, up to the first answer that is another one.

        Raises:
            CampaignError: the board cannot be put into the loop.
            DriveError: the way to the board is lost.
        """
        self._enter()
        hashes = hashlib.sha256(), hashlib.sha256()
        steps, difference = 0, None
        begin = time.perf_counter()
        for number, (request, expected) in enumerate(said):
            answer = self._ask(request)
            if error := self._error:
                raise error
            steps += request[0] == Request.HIL_STEP
            for hash_, octets in zip(hashes, (answer, expected), strict=True):
                hash_.update(octets)
            if answer != expected:
                difference = Difference(steps, told.answered(Request(request[0]).name, answer, expected))
                break
            if progress and number % _TOLD_EVERY == 0:
                progress(number / len(said))
        seconds = time.perf_counter() - begin
        board, recording = (hash_.hexdigest() for hash_ in hashes)
        return LoopResult(steps, seconds, board, recording, difference, "")

    def ask(self, kind: Request, body: bytes = b"") -> bytes:
        """Anything of the board that may be asked twice, outside of a run."""
        return self._requester.request(kind, body, repeat=True)

    def leave(self) -> None:
        """Let the board reset itself."""
        self._requester.request(Request.HIL_LEAVE, repeat=True)

    def _enter(self) -> None:
        self._error = None
        try:
            self._requester.request(Request.HIL_ENTER, repeat=True)
        except RefusedError as error:
            raise CampaignError(f"the board does not enter host in the loop: {error}") from error

    def _ask(self, request: bytes) -> bytes:
        """A request by way of the requester."""
        try:
            answer = b"\0" + self._requester.request(Request(request[0]), request[1:], repeat=True)
        except RefusedError as error:
            answer = bytes((error.status,)) + str(error).encode()
        except DriveError as error:
            self._error = error
            return b""
        if self._note:
            self._note(request, answer)
        return answer

    def _check(self, loop: NativeStepLoop) -> None:
        """Whether the run broke off because of the board."""
        error, self._error = self._error, None
        if error:
            raise error
        if loop.lost:
            raise LinkError(f"{self._requester.transport.name}: {loop.lost}")
        if loop.refusal:
            status, words = loop.refusal
            text = words.decode("ascii", "replace").strip("\0 ")
            known = {int(code): reason for code, reason in REASONS.items()}
            raise RefusedError(
                f"step {loop.steps}: the board refuses: {text or known.get(status, f'status {status}')}", status
            )

    def _difference(self, loop: NativeStepLoop) -> Difference | None:
        if loop.mismatch is None:
            return None
        step, torn, board, native, signals = loop.mismatch
        if torn:
            return Difference(step, "the board accessed other hardware than the virtual drive did")
        return Difference(step, told.difference(board, native) or self._signal(signals))

    def _signal(self, ours: list[int]) -> str:
        """The first signal that differs, in words."""
        for first in range(0, len(ours), _SIGNALS_AT_ONCE):
            wanted = range(first, min(first + _SIGNALS_AT_ONCE, len(ours)))
            body = self._requester.request(Request.SIGNALS, struct.pack(f"<{len(wanted)}H", *wanted), repeat=True)
            *theirs, _known = describe.unpack(f"<{len(wanted)}iB", body)
            for index, value in zip(wanted, theirs, strict=True):
                if value != ours[index]:
                    name = self._requester.request(Request.SIGNAL_INFO, struct.pack("<H", index), repeat=True)
                    text = name[1:].split(b"\0")[0].decode("ascii", "replace")
                    return f"signal {text}: {value} on the board, {ours[index]} on the virtual drive (raw)"
        return "the check sums of the signals differ, the signals do not any more"
