"""The duties of a motor on workers, each judged on the true shaft."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from stillspin import core
from stillspin.campaign.draw import Unit
from stillspin.campaign.judge import End, Verdict, judged
from stillspin.cases.motor_told import Motor
from stillspin.cases.scenario import Scenario
from stillspin.runs import execute
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers
from stillspin.type_test import duties, ratings
from stillspin.type_test.duties import Duty

_MEAN = 0.05
"""s that the speed is averaged over: its ripple is not what keeps or loses a speed."""


@dataclass(frozen=True)
class Row:
    """A duty of a motor, and what became of it."""

    motor: str
    duty: Duty
    verdict: Verdict


def asked(unit: Unit, angles: int) -> list[Duty]:
    """The duties of a motor; none where its drive refuses it altogether."""
    if unit.refusal:
        return []
    told = unit.settings.profile
    known = core.at_scale(core.parameters(core.load()), told.parameters)
    rated = ratings.of(Motor(told, unit.schema, known), mapped="flux_map" in told.plant["machine"])
    return list(duties.duties(rated, angles))


def verdict(unit: Unit, duty: Duty) -> Verdict:
    """Run a duty and judge it."""
    native, run = core.load(), duty.run
    scenario = Scenario("type-test", duty.kind, unit.settings.profile.motor, "", "", "", (run,), (), ())
    (job,) = execute.prepare(scenario, unit.settings, native)
    try:
        return judged(execute.play(native, job, lambda share: report(0, share)), run, _MEAN)
    except (RuntimeError, ArithmeticError) as error:
        return Verdict(End.FAILED, " ".join(str(error).split()) or type(error).__name__)


def run(todo: Sequence[tuple[Unit, Duty]], where: Where, done: Callable[[Row], None]) -> list[Row]:
    """All duties, in their order; `done` is told of each as it ends.

    Raises:
        CampaignError: a worker has died.
    """
    found: dict[int, Row] = {}
    with workers(where) as crew:
        tasks = deque(Task(verdict, (unit, duty), k) for k, (unit, duty) in enumerate(todo))
        for task, what in crew.finished(tasks):
            unit, duty = todo[task.tag]
            found[task.tag] = Row(unit.motor, duty, what)
            done(found[task.tag])
    return [found[k] for k in range(len(todo))]
