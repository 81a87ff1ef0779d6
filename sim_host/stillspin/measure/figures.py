"""From recorded runs to figures of merit with the paper's number, the goal and whether it is met."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from stillspin.cases.scenario import Figure, Reached, Run, Scenario
from stillspin.cases.vocabulary import KINDS
from stillspin.core import Signals
from stillspin.counted import counted
from stillspin.measure import metrics, pieces
from stillspin.measure.pieces import Extras


@dataclass(frozen=True)
class Result:
    """A figure of merit. `value` is None when a run broke off or the quantity does not exist; `note` says which."""

    name: str
    value: float | None
    unit: str
    paper: float | None
    goal: float | None
    met: bool | None
    where: str = ""
    note: str = ""

    def as_json(self) -> dict[str, object]:
        """The entry of `metrics.json`."""
        return {"value": self.value, "unit": self.unit, "paper": self.paper, "goal": self.goal, "met": self.met}


def shaft_problem(signals: Signals, run: Run) -> str | None:
    """Why the true shaft did not do what was commanded, or None when it did."""
    for check in run.reached:
        problem = _window_problem(signals, run, check)
        if problem:
            return problem
    return None


def _window_problem(signals: Signals, run: Run, check: Reached) -> str | None:
    first, last = check.window
    try:
        piece = pieces.cut(signals, run, check.window)
    except ValueError as error:
        return str(error)
    wanted = piece.command if check.speed is None else np.full(piece.time.shape, check.speed)
    off = np.abs(piece.speed - wanted)
    # Written so that a speed that is not a number counts as missed.
    if np.all(off <= check.band):
        return None
    worst = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
    return (
        f"the shaft turned at {piece.speed[worst]:.1f} rpm at {piece.time[worst]:.3f} s instead of"
        f" {wanted[worst]:.1f} ± {check.band:g} rpm within {first:g} … {last:g} s"
    )


def evaluate(
    scenario: Scenario,
    recorded: Mapping[str, Signals],
    profile: str,
    extras: Mapping[str, Extras] | None = None,
    lost: Mapping[str, Signals] | None = None,
) -> list[Result]:
    """All figures of a scenario.

    Args:
        scenario: what to measure.
        recorded: signals of every run that counts; a figure that needs another one has no value.
        profile: for the goals.
        extras: what else is known of the runs.
        lost: runs that do not count; some kinds of figures are about how far they got.
    """
    known = extras or {}
    results: dict[str, Result] = {}
    for figure in scenario.figures:
        value, note = (
            _ratio(figure, results) if figure.of else _of_figure(figure, scenario, recorded, lost or {}, known)
        )
        results[figure.name] = _result(figure, value, note, profile, len(scenario.runs))
    return list(results.values())


def _of_figure(
    figure: Figure,
    scenario: Scenario,
    recorded: Mapping[str, Signals],
    lost: Mapping[str, Signals],
    extras: Mapping[str, Extras],
) -> tuple[float | None, str]:
    if not KINDS[figure.kind].of_lost or not any(name in lost for name in figure.runs):
        return _largest(figure, scenario, recorded, extras)
    ends = [_last_corner(lost[name]) for name in figure.runs if name in lost]
    windows = tuple((first, min(last, *ends)) for first, last in figure.windows)
    if any(first >= last for first, last in windows):
        return None, "lost at once"
    return _largest(replace(figure, windows=windows), scenario, {**recorded, **lost}, extras)


def _last_corner(signals: Signals) -> float:
    """When the speed reference last changed: what was held from then on was not held to its end."""
    moved = np.flatnonzero(np.diff(signals["speed_ref"]) != 0.0)
    return float(signals["time"][moved[-1] + 1]) if moved.size else 0.0


def _largest(
    figure: Figure, scenario: Scenario, recorded: Mapping[str, Signals], extras: Mapping[str, Extras]
) -> tuple[float | None, str]:
    """The largest value over runs and windows, and a word on why there is none."""
    missing = [name for name in figure.runs if name not in recorded]
    if missing:
        return None, f"run {', '.join(missing)} broke off"
    function = metrics.FUNCTIONS[figure.kind]
    values: list[float] = []
    for name in figure.runs:
        for window in figure.windows:
            try:
                piece = pieces.cut(recorded[name], scenario.run(name), window, extras.get(name, pieces.NOTHING_ELSE))
                values.append(function(piece))
            except ValueError as error:
                return None, f"run {name}: {error}"
    largest = max(values) if all(map(math.isfinite, values)) else math.inf
    return (largest, "") if math.isfinite(largest) else (None, "not within the window")


def _ratio(figure: Figure, results: Mapping[str, Result]) -> tuple[float | None, str]:
    assert figure.of is not None
    over, under = (results[name].value for name in figure.of)
    if over is None or not under:
        return None, "one of the two has no value"
    return over / under, ""


def _result(figure: Figure, value: float | None, note: str, profile: str, runs: int) -> Result:
    goal = figure.goal.of(profile)
    rounded = None if value is None else float(f"{value:.6g}")
    met = None if goal is None else rounded is not None and abs(rounded) <= goal
    return Result(
        name=figure.name,
        value=rounded,
        unit=figure.unit,
        paper=figure.paper,
        goal=goal,
        met=met,
        where=_where(figure, runs),
        note=note or figure.note,
    )


def _where(figure: Figure, runs: int) -> str:
    """The runs and windows in words; `runs` is how many the scenario has."""
    if figure.of:
        return f"{figure.of[0]} / {figure.of[1]}"
    windows = ", ".join(f"{first:g} … {last:g} s".replace(" ", "\N{NO-BREAK SPACE}") for first, last in figure.windows)
    names = f"all {counted(runs, 'run')}" if len(figure.runs) == runs > 3 else ", ".join(figure.runs)
    return f"{names}: {windows}"
