"""Runs through the loop: one after the other on a board, or several at a time on virtual boards of their own."""

from __future__ import annotations

import multiprocessing as mp
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stillspin import core
from stillspin.cases import profile
from stillspin.core import Progress
from stillspin.drive import describe
from stillspin.drive.requester import Requester
from stillspin.errors import CampaignError
from stillspin.hil import runs
from stillspin.hil.boards import boards
from stillspin.hil.built import check_board
from stillspin.hil.loop import Loop
from stillspin.hil.results import Row, begun, ended
from stillspin.hil.runs import LoopRun
from stillspin.link import address
from stillspin.link.errors import DriveError, RefusedError
from stillspin.runs import commission, execute

_TIMEOUT = 1.0  # s; a step of a slow bus takes tens of milliseconds

ProgressOf = Callable[[LoopRun], Progress]


@dataclass(frozen=True)
class Wish:
    """What is to be stepped through, in words that another process understands, too.

    Attributes:
        scenarios, check: see runs.named.
        only: names of runs, all when empty.
        profile, seed, changes, params: of the plant and of the drive, as for `stillspin run`.
    """

    scenarios: tuple[str, ...]
    check: bool = False
    only: tuple[str, ...] = ()
    profile: str = "bench"
    seed: int = 1
    changes: tuple[str, ...] = ()
    params: Path | None = None
    revision: str = ""

    def runs(self, native: core.NativeCore) -> list[LoopRun]:
        """The runs that are meant.

        Raises:
            InputError: there is no such scenario, profile or parameter.
        """
        schema, known = core.plant_schema(native), core.parameters(native)

        def settings(motor: str) -> execute.Settings:
            chosen = profile.load(self.profile, schema, known, motor)
            if self.params:
                chosen = replace(chosen, parameters={**chosen.parameters, **commission.load(self.params, known)})
            changes = profile.changes(self.changes, schema, known)
            return execute.Settings(chosen, changes, self.seed, self.revision)

        found = runs.named(self.scenarios, settings, native, check=self.check)
        return [run for run in found if not self.only or run.name in self.only]


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


def on_virtual(wish: Wish, chosen: Sequence[int], kind: str, jobs: int) -> Iterator[Row]:
    """Runs of a wish, by their number in it, so many at a time; rows as they come.

    Args:
        wish: all runs.
        chosen: numbers of those that are meant.
        kind: serial or can, the way to the boards.
        jobs: how many boards.

    Raises:
        CampaignError: a board does not start, or a process has died.
    """
    context = mp.get_context("spawn")  # see campaign.py
    with boards(kind, jobs) as addresses:
        free = context.Queue()
        for where in addresses:
            free.put(where)
        stop = context.Value("b", 0, lock=False)
        with ProcessPoolExecutor(jobs, context, _begin_worker, (wish, free, stop)) as pool:
            try:
                for done in as_completed([pool.submit(_work, number) for number in chosen]):
                    yield done.result()
            except BrokenProcessPool as error:
                raise CampaignError("a worker process died (out of memory?); try fewer with --jobs") from error
            finally:
                stop.value = 1  # for what still runs, after an interrupt
                pool.shutdown(cancel_futures=True)


# ---- in a worker, which has one board for all its runs


class _Worker:
    def __init__(self, wish: Wish, where: str, stop: Any) -> None:
        self._native = core.load()
        self._revision = wish.revision
        self._runs = wish.runs(self._native)
        self._kind = address.parse(where).kind
        self._loop = Loop(_requester(where))
        self._firmware = describe.identity(self._loop.ask).text
        self._stop = stop

    def step_through(self, number: int) -> Row:
        run = self._runs[number]
        row = replace(begun(run, self._kind, self._revision), firmware=self._firmware)
        return _step_through(self._loop, run, row, self._native, lambda _share: not self._stop.value)[0]


_worker: list[_Worker] = []
"""The one of this process: what reaches a worker only through its start is kept in a global."""


def _begin_worker(wish: Wish, free: Any, stop: Any) -> None:
    _worker.append(_Worker(wish, free.get(), stop))


def _work(number: int) -> Row:
    return _worker[0].step_through(number)


# ---- both


def _step_through(loop: Loop, run: LoopRun, row: Row, native: core.NativeCore, progress: Progress) -> tuple[Row, bool]:
    """The row of a run, and whether the board can do another."""
    try:
        return ended(row, loop.run(native, run.play, progress)), True
    except DriveError as error:
        return replace(row, lost=str(error), lost_code=error.exit_code), isinstance(error, RefusedError)


def _requester(where: str) -> Requester:
    return Requester(address.connect(where), _TIMEOUT)


@contextmanager
def _loop(where: str) -> Iterator[Loop]:
    """A board in the loop, which is let go at the end."""
    requester = _requester(where)
    try:
        loop = Loop(requester)
        try:
            yield loop
        finally:
            with suppress(DriveError):  # a board that was never in the loop, or has left it already
                loop.leave()
    finally:
        requester.close()
