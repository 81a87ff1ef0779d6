"""The virtual board of a worker: switched on for its first run, kept for the next one, off when none comes."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing.util import Finalize

from stillspin.drive import describe
from stillspin.drive.connect import connect
from stillspin.drive.requester import Requester
from stillspin.hil.boards import Board
from stillspin.hil.loop import Loop

TIMEOUT = 1.0  # s; a step of a slow bus takes tens of milliseconds
_IDLE = 10.0  # s; a board runs as fast as it can, and takes a processor for that


class KeptBoard:
    """A board in the loop. `good`: it can do another run."""

    def __init__(self, kind: str, memory: bytes) -> None:
        self.kind, self.good = kind, True
        with ExitStack() as held:
            board = held.enter_context(Board(memory))
            requester = Requester(connect(board.wait(kind)), TIMEOUT)
            held.callback(requester.close)
            self.loop = Loop(requester)
            self.firmware = describe.identity(self.loop.ask).text
            self._held = held.pop_all()
        self.close = Finalize(self, self._held.close, exitpriority=10)  # a worker ends without what is registered else


class _Place:
    """Where the board of this process is."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.board: KeptBoard | None = None
        self.timer = threading.Timer(_IDLE, self.idle)

    def idle(self) -> None:
        with self.lock:
            self.let_go()

    def let_go(self) -> None:
        if self.board:
            self.board.close()
        self.board = None

    def wait(self) -> None:
        self.timer = threading.Timer(_IDLE, self.idle)
        self.timer.daemon = True
        self.timer.start()


_place = _Place()


@contextmanager
def kept_board(kind: str, memory: bytes) -> Iterator[KeptBoard]:
    """The board of this process, for a run; it is switched off when that ends without calling it good.

    Args:
        kind: serial or can, the way to it.
        memory: what it finds in its memory, see boards.memory.

    Raises:
        CampaignError: it does not start.
    """
    with _place.lock:
        _place.timer.cancel()
        if _place.board and _place.board.kind != kind:
            _place.let_go()
        board = _place.board = _place.board or KeptBoard(kind, memory)
        board.good = False
        try:
            yield board
        finally:
            if not board.good:
                _place.let_go()
            _place.wait()
