"""Runs through the loop: one after the other on a board, or several at a time on virtual boards of their own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace

from stillspin import core
from stillspin.core import Progress
from stillspin.drive.requester import Requester
from stillspin.hil import boards
from stillspin.hil.built import check_board
from stillspin.hil.kept_board import TIMEOUT, kept_board
from stillspin.hil.loop import Loop
from stillspin.hil.results import Row, begun, ended
from stillspin.hil.runs import LoopRun
from stillspin.link import address
from stillspin.link.errors import DriveError, RefusedError
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

ProgressOf = Callable[[LoopRun], Progress]


def on_one(chosen: Sequence[LoopRun], where: str, revision: str, progress: ProgressOf) -> Iterator[Row]:
    """The runs one after the other; what is lost with the board ends them behind a row that says so."""
    native = core.load()
    kind = address.parse(where).kind
    with _loop(where) as loop:
        firmware = check_board(loop.ask).text
        for run in chosen:
            row = replace(begun(run, kind, revision), firmware=firmware)
            row, goes_on = _step_through(loop, run, row, native, progress(run))
            yield row
            if not goes_on:
                return


def on_virtual(chosen: Sequence[LoopRun], kind: str, revision: str, where: Where) -> Iterator[Row]:
    """Runs on virtual boards of the workers; rows as they come.

    Args:
        chosen: the runs.
        kind: serial or can, the way to the boards.
        revision: of the sources, for the rows.
        where: whose boards.

    Raises:
        CampaignError: a board does not start, or a process has died.
    """
    memory = boards.memory()
    with workers(where) as crew:
        for _, row in crew.finished(deque(Task(_work, (begun(run, kind, revision), run, memory)) for run in chosen)):
            yield row


def _work(row: Row, run: LoopRun, memory: bytes) -> Row:
    """In a worker, which has one board for all its runs."""
    with kept_board(row.link, memory) as board:
        named = replace(row, firmware=board.firmware)
        row, board.good = _step_through(board.loop, run, named, core.load(), lambda share: report(0, share))
        return row


# ---- both


def _step_through(loop: Loop, run: LoopRun, row: Row, native: core.NativeCore, progress: Progress) -> tuple[Row, bool]:
    """The row of a run, and whether the board can do another."""
    try:
        return ended(row, loop.run(native, run.play, progress)), True
    except DriveError as error:
        return replace(row, lost=str(error), lost_code=error.exit_code), isinstance(error, RefusedError)


@contextmanager
def _loop(where: str) -> Iterator[Loop]:
    """A board in the loop, which is let go at the end."""
    requester = Requester(address.connect(where), TIMEOUT)
    try:
        loop = Loop(requester)
        try:
            yield loop
        finally:
            with suppress(DriveError):  # a board that was never in the loop, or has left it already
                loop.leave()
    finally:
        requester.close()
