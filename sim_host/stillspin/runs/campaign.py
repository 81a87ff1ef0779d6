"""Many runs at a time on worker processes, and the evaluation of each scenario as soon as its runs are done."""

from __future__ import annotations

import multiprocessing as mp
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stillspin.cases.scenario import Scenario
from stillspin.errors import CampaignError
from stillspin.runs.assess import ScenarioResult, assess
from stillspin.runs.execute import Job, Outcome, execute

_POLL = 0.1  # s between two looks at the progress of the workers


@dataclass(frozen=True)
class Plan:
    """What is to be done.

    Attributes:
        scenarios: in the order of the report; jobs: all their runs.
        directory: existing, for the records.
        profile: name, for the goals.
        draw: whether to draw.
    """

    scenarios: Sequence[Scenario]
    jobs: Sequence[Job]
    directory: Path
    profile: str
    draw: bool


class Watcher:
    """Is told how far the campaign is; the command line draws a progress bar from it. This one does nothing."""

    def total(self, runs: int, scenarios: int) -> None:
        """How much there is to do."""

    def progress(self, shares: Sequence[float]) -> None:
        """Share done (0 … 1) of every run."""

    def finished(self, outcome: Outcome) -> None:
        """A run ended."""

    def assessed(self, result: ScenarioResult) -> None:
        """A scenario's figures and plots are ready."""


def run_all(plan: Plan, workers: int, watcher: Watcher) -> list[ScenarioResult]:
    """Carry out a plan.

    Args:
        plan: what to do.
        workers: processes; 1 runs everything in this one.
        watcher: is told what happens.

    Raises:
        CampaignError: a worker died.
    """
    watcher.total(len(plan.jobs), len(plan.scenarios))
    return _serial(plan, watcher) if workers == 1 else _Pool(plan, workers, watcher).run()


def _serial(plan: Plan, watcher: Watcher) -> list[ScenarioResult]:
    shares = [0.0] * len(plan.jobs)
    outcomes: list[Outcome] = []
    results: dict[str, ScenarioResult] = {}
    for slot, job in enumerate(plan.jobs):

        def report(share: float, slot: int = slot) -> bool:
            shares[slot] = share
            watcher.progress(shares)
            return True

        outcomes.append(execute(job, plan.directory, report))
        watcher.finished(outcomes[-1])
        scenario = next(item for item in plan.scenarios if item.id == job.scenario)
        if sum(item.scenario == scenario.id for item in outcomes) == len(scenario.runs):
            result = assess(scenario, _of(scenario, outcomes), plan.directory, plan.profile, plan.draw)
            results[scenario.id] = result
            watcher.assessed(result)
    return [results[scenario.id] for scenario in plan.scenarios]


def _of(scenario: Scenario, outcomes: Sequence[Outcome]) -> list[Outcome]:
    """The scenario's outcomes in the order of its runs."""
    by_run = {outcome.run: outcome for outcome in outcomes if outcome.scenario == scenario.id}
    return [by_run[run.name] for run in scenario.runs]


_shares: Any = None
_stop: Any = None


def _start_worker(shares: Any, stop: Any) -> None:
    """Shared memory reaches a worker only through its start, so it is kept in globals there."""
    global _shares, _stop
    _shares, _stop = shares, stop


def _work(slot: int, job: Job, directory: Path) -> Outcome:
    def report(share: float) -> bool:
        _shares[slot] = share
        return not _stop.value

    return execute(job, directory, report)


class _Pool:
    """A plan on worker processes."""

    def __init__(self, plan: Plan, workers: int, watcher: Watcher) -> None:
        self._plan, self._watcher = plan, watcher
        # A fresh interpreter per worker: nothing of this process's threads or native state is copied into it.
        context = mp.get_context("spawn")
        self._shares = context.Array("d", len(plan.jobs), lock=False)
        self._stop = context.Value("b", 0, lock=False)
        self._executor = ProcessPoolExecutor(workers, context, _start_worker, (self._shares, self._stop))
        self._outcomes: list[Outcome] = []
        self._results: dict[str, ScenarioResult] = {}
        self._pending: dict[Future[Any], Callable[[Any], None]] = {}

    def run(self) -> list[ScenarioResult]:
        """All of it; on an error or an interrupt the workers stop at their next report of progress."""
        try:
            for slot, job in enumerate(self._plan.jobs):
                self._submit(self._ran, _work, slot, job, self._plan.directory)
            while self._pending:
                done, _ = wait(self._pending, timeout=_POLL, return_when=FIRST_COMPLETED)
                self._watcher.progress(list(self._shares))
                for future in done:
                    self._pending.pop(future)(future.result())
        except BrokenProcessPool as error:
            raise CampaignError("a worker process died (out of memory?); try fewer with --jobs") from error
        finally:
            self._stop.value = 1
            self._executor.shutdown(cancel_futures=True)
        return [self._results[scenario.id] for scenario in self._plan.scenarios]

    def _submit(self, then: Callable[[Any], None], function: Callable[..., Any], *arguments: Any) -> None:
        self._pending[self._executor.submit(function, *arguments)] = then

    def _ran(self, outcome: Outcome) -> None:
        self._outcomes.append(outcome)
        self._watcher.finished(outcome)
        plan = self._plan
        scenario = next(item for item in plan.scenarios if item.id == outcome.scenario)
        mine = [item for item in self._outcomes if item.scenario == scenario.id]
        if len(mine) == len(scenario.runs):
            outcomes = _of(scenario, mine)
            self._submit(self._assessed, assess, scenario, outcomes, plan.directory, plan.profile, plan.draw)

    def _assessed(self, result: ScenarioResult) -> None:
        self._results[result.scenario.id] = result
        self._watcher.assessed(result)
