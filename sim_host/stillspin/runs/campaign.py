"""Many runs at a time on workers, and the evaluation of each scenario as soon as its runs are done."""

from __future__ import annotations

import tempfile
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stillspin.cases.scenario import Scenario
from stillspin.runs.assess import Draw, ScenarioResult, assess
from stillspin.runs.execute import Job, Outcome, execute
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

Files = dict[str, bytes]


@dataclass(frozen=True)
class Plan:
    """What is to be done.

    Attributes:
        scenarios: in the order of the report; jobs: all their runs.
        directory: existing, for the records.
        profile: name, for the goals.
        draw: what draws, None for no drawings; a worker must find it by its name.
    """

    scenarios: Sequence[Scenario]
    jobs: Sequence[Job]
    directory: Path
    profile: str
    draw: Draw | None = None


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


def run_all(plan: Plan, where: Where, watcher: Watcher) -> list[ScenarioResult]:
    """Carry out a plan.

    Args:
        plan: what to do.
        where: by whom.
        watcher: is told what happens.

    Raises:
        CampaignError: a worker died.
    """
    watcher.total(len(plan.jobs), len(plan.scenarios))
    scenarios = {scenario.id: scenario for scenario in plan.scenarios}
    outcomes: dict[str, dict[str, Outcome]] = {name: {} for name in scenarios}
    results: dict[str, ScenarioResult] = {}
    waiting = deque(Task(_run, (slot, job)) for slot, job in enumerate(plan.jobs))
    with workers(where, len(plan.jobs), watcher.progress) as crew:
        for task, done in crew.finished(waiting):
            if task.function is assess:
                results[done.scenario.id] = done
                watcher.assessed(done)
                continue
            outcome = _kept(plan, *done)
            watcher.finished(outcome)
            scenario, mine = scenarios[outcome.scenario], outcomes[outcome.scenario]
            mine[outcome.run] = outcome
            if len(mine) == len(scenario.runs):
                ended = [mine[run.name] for run in scenario.runs]
                arguments = (scenario, ended, plan.directory, plan.profile, plan.draw)
                waiting.appendleft(Task(assess, arguments, near=True))
    return [results[name] for name in scenarios]


def _run(slot: int, job: Job) -> tuple[Outcome, Files]:
    """In a worker: the run, and its files."""
    with tempfile.TemporaryDirectory() as directory:
        outcome = execute(job, Path(directory), lambda share: report(slot, share))
        return outcome, {path.name: path.read_bytes() for path in Path(directory).iterdir()}


def _kept(plan: Plan, outcome: Outcome, files: Files) -> Outcome:
    for name, octets in files.items():
        (plan.directory / name).write_bytes(octets)
    return outcome
