"""The cases of a campaign on workers, and what fails of them shrunk."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from stillspin import core
from stillspin.campaign.draw import Case, Drawer, Unit
from stillspin.campaign.judge import End, Verdict, judged
from stillspin.campaign.results import Row
from stillspin.campaign.shrink import Shrunk, shrink
from stillspin.errors import InputError
from stillspin.runs import execute
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers


@dataclass(frozen=True)
class Small:
    """A failure and what is left of it. again: what becomes of that."""

    row: Row
    shrunk: Shrunk
    again: Verdict


def verdict(unit: Unit, drawer: Drawer, case: Case) -> Verdict:
    """Run a case and judge it.

    Raises:
        InputError: what was drawn is out of the range of an entry.
    """
    native = core.load()
    (job,) = execute.prepare(unit.scenario(case, drawer), unit.at_noise(case.noise), native)
    try:
        return judged(execute.play(native, job, lambda share: report(0, share)), job.run)
    except (RuntimeError, ArithmeticError) as error:
        return Verdict(End.FAILED, " ".join(str(error).split()) or type(error).__name__)


def smallest(unit: Unit, drawer: Drawer, row: Row) -> Small:
    """The smallest departure from nominal that still fails."""
    last: dict[bool, Verdict] = {True: row.verdict}

    def fails(case: Case) -> bool:
        found = verdict(unit, drawer, case)
        last[found.failed] = found
        return found.failed

    shrunk = shrink(row.case, fails)
    return Small(row, shrunk, last[True])


def check(units: Sequence[Unit], drawer: Drawer) -> None:
    """Complain about a departure that leads out of the plant's ranges before anything runs.

    Raises:
        InputError: it does, at an end of what may be drawn.
    """
    native = core.load()
    for unit in (each for each in units if not each.refusal):
        for row in drawer.spread.departures:
            for end in (row.low, row.high):
                case = Case(0, {row.name: end})
                try:
                    execute.prepare(unit.scenario(case, drawer), unit.settings, native)
                except InputError as error:
                    words = f"motor {unit.motor}, {row.words(end)}, an end of what may be drawn, moves {row.moves}"
                    raise InputError(f"spread {drawer.spread.name}: {words}: {error}") from error


def run(todo: Sequence[tuple[Unit, Case]], drawer: Drawer, where: Where, done: Callable[[Row], None]) -> None:
    """All cases; `done` is told of each as it ends.

    Raises:
        CampaignError: a worker has died.
        InputError: what was drawn for a case is out of the range of an entry.
    """
    with workers(where) as crew:
        tasks = deque(Task(verdict, (unit, drawer, case), (unit.motor, case)) for unit, case in todo)
        for task, found in crew.finished(tasks):
            motor, case = task.tag
            done(Row(motor, case, found))


def shrink_all(
    todo: Sequence[tuple[Unit, Row]], drawer: Drawer, where: Where, done: Callable[[Small], None]
) -> list[Small]:
    """Failures shrunk, in their order; `done` is told of each."""
    found: dict[int, Small] = {}
    with workers(where) as crew:
        tasks = deque(Task(smallest, (unit, drawer, row), k) for k, (unit, row) in enumerate(todo))
        for task, small in crew.finished(tasks):
            found[task.tag] = small
            done(small)
    return [found[k] for k in range(len(todo))]
