"""The progress bar of a campaign, drawn with rich on stderr."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from stillspin.counted import counted
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.campaign import Watcher
from stillspin.runs.execute import Outcome

_ASSESSING = 0.1  # evaluating and drawing a scenario, in units of one run


def _columns() -> tuple[ProgressColumn, ...]:
    return (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:3.0f} %"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )


class _Drawn:
    """A rich bar that is drawn from entering to leaving, and only where somebody looks: not in a log file."""

    def __init__(self, console: Console, *columns: ProgressColumn) -> None:
        self._progress = Progress(*columns, console=console, transient=True, disable=not console.is_terminal)

    def __enter__(self) -> Self:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()


class Counter(_Drawn):
    """A bar over so many equal things."""

    def __init__(self, console: Console, total: int) -> None:
        super().__init__(console, *_columns())
        self._task = self._progress.add_task("", total=total)
        self._total, self._done = total, 0

    def one_more(self, _: object) -> None:
        """One of them is done."""
        self._done += 1
        self._progress.update(
            self._task, completed=self._done, description=f"{counted(self._done, 'run', self._total)}"
        )


class Bar(_Drawn, Watcher):
    """One bar over everything: runs by their share done, then figures and plots; `told` is told of each scenario."""

    def __init__(self, console: Console, told: Callable[[ScenarioResult], None] = lambda _: None) -> None:
        super().__init__(console, *_columns())
        self._told = told
        self._task: TaskID | None = None
        self._runs = self._done = self._drawn = 0
        self._shares = 0.0

    def total(self, runs: int, scenarios: int) -> None:
        """How much there is to do."""
        self._runs = runs
        self._task = self._progress.add_task("", total=runs + _ASSESSING * scenarios)
        self._show()

    def progress(self, shares: Sequence[float]) -> None:
        """Share done of every run."""
        self._shares = sum(min(max(share, 0.0), 1.0) for share in shares)
        self._show()

    def finished(self, outcome: Outcome) -> None:
        """A run ended."""
        self._done += 1
        self._show()

    def assessed(self, result: ScenarioResult) -> None:
        """A scenario's figures and plots are ready."""
        self._drawn += 1
        self._told(result)
        self._show()

    def _show(self) -> None:
        if self._task is None:
            return
        done = max(self._shares, float(self._done)) + _ASSESSING * self._drawn
        self._progress.update(self._task, completed=done, description=f"{counted(self._done, 'run', self._runs)}")


class PhaseBar(_Drawn):
    """One bar over one piece of work that says which phase it is in."""

    def __init__(self, console: Console) -> None:
        super().__init__(console, *_columns()[:-1])  # phases are too unequal to say how long the rest takes
        self._task = self._progress.add_task("", total=1.0)

    def show(self, share: float, phase: str) -> bool:
        """How far it is; always true, which means: go on."""
        self._progress.update(self._task, completed=share, description=phase)
        return True
