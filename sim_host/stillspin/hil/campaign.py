"""Runs through the loop: one after the other on a board, or several at a time on virtual boards of their own."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from itertools import chain
from pathlib import Path

from stillspin import core
from stillspin.core import Progress
from stillspin.drive.connect import connect
from stillspin.drive.describe import Identity
from stillspin.drive.requester import Requester
from stillspin.errors import InputError
from stillspin.hil import boards
from stillspin.hil.built import check_board, check_recorded
from stillspin.hil.kept_board import TIMEOUT, kept_board
from stillspin.hil.loop import Loop
from stillspin.hil.recording import Heading, RecordingWriter, recorded
from stillspin.hil.results import Row, begun, ended
from stillspin.hil.runs import LoopRun
from stillspin.link import address
from stillspin.link.errors import DriveError, RefusedError
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

ProgressOf = Callable[[LoopRun], Progress]
Note = Callable[[bytes, bytes], None]


def on_one(
    chosen: Sequence[LoopRun], where: str, revision: str, progress: ProgressOf, recording: RecordingWriter | None = None
) -> Iterator[Row]:
    """The runs one after the other; what is lost with the board ends them behind a row that says so.

    Args:
        chosen: the runs.
        where: address of the board.
        revision: of the sources, for the rows.
        progress: of a run.
        recording: gets those that are identical.
    """
    native = core.load()
    kind = address.parse(where).kind
    with _loop(where, recording.note if recording else None) as loop:
        identity = check_board(loop.ask)
        for run in chosen:
            if recording:
                recording.begin()
            row = replace(begun(run, kind, revision), firmware=identity.text)
            row, goes_on = _step_through(loop, run, row, native, progress(run))
            if recording and row.identical:
                recording.keep(_heading(row, identity))
            yield row
            if not goes_on:
                return


def _heading(row: Row, of: Identity) -> Heading:
    run = (row.scenario, row.run, row.profile, row.whole, row.revision)
    return Heading(*run, of.version, of.edition, of.board, of.crc)


def played(file: Path, where: str, progress: Callable[[Heading], Progress]) -> Iterator[Row]:
    """The runs of a recording one after the other; what is lost with the board ends them behind a row that says so.

    Raises:
        InputError: it is no recording.
        DifferentError: the board is not built like the drive on it.
    """
    kind = address.parse(where).kind
    runs = recorded(file)
    if (first := next(runs, None)) is None:
        raise InputError(f"--play {file}: there is no run in this recording")
    with _loop(where) as loop:
        for heading, said in chain([first], runs):
            firmware = check_recorded(loop.ask, heading).text
            run = (heading.scenario, heading.run, heading.profile, heading.whole)
            row = Row(*run, kind, heading.revision, firmware=firmware)
            try:
                yield ended(row, loop.play(said, progress(heading)))
            except DriveError as error:
                yield replace(row, lost=str(error), lost_code=error.exit_code)
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
def _loop(where: str, note: Note | None = None) -> Iterator[Loop]:
    """A board in the loop, which is let go at the end."""
    requester = Requester(connect(where), TIMEOUT)
    try:
        loop = Loop(requester, note)
        try:
            yield loop
        finally:
            with suppress(DriveError):  # a board that was never in the loop, or has left it already
                loop.leave()
    finally:
        requester.close()
