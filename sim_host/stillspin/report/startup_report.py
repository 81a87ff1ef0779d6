"""What became of the start-up matrix: a table, a drawing, and every case in a CSV file."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stillspin import csv_table, extras
from stillspin.drive.own import firmware
from stillspin.report import output
from stillspin.report.style import COLOURS, STYLE, WIDTH
from stillspin.revision import revision
from stillspin.runs.startup import BACKWARD_LIMIT, WAYS, Case, Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLUMNS = (
    *("way", "angle_deg", "direction", "load_nm", "error", "seed", "speed_rpm"),
    *("problem", "backward_deg", "sigma", "angle_error_deg", "start_s"),
)
_TITLES = {"brake": "held by a brake until RUN", "free": "free shaft", "flying": "turning shaft"}


def _condition(case: Case) -> str:
    return f"{case.speed:+.0f} rpm" if case.way == "flying" else f"{case.load:+.2f} Nm"


def _groups(outcomes: Iterable[Outcome]) -> dict[tuple[str, str, str], list[Outcome]]:
    groups: dict[tuple[str, str, str], list[Outcome]] = {}
    for outcome in outcomes:
        case = outcome.case
        groups.setdefault((case.way, case.error, _condition(case)), []).append(outcome)
    return groups


def rows(outcomes: Iterable[Outcome]) -> list[tuple[str, ...]]:
    """Per way, parameter error and load or speed: numbers of starts and failures, and the worst of each figure."""
    result: list[tuple[str, ...]] = []
    for (way, error, condition), group in _groups(outcomes).items():
        failed = [item for item in group if item.problem]
        first = f"{failed[0].case.angle:g}°, seed {failed[0].case.seed}: {failed[0].problem}" if failed else ""
        result.append(
            (
                way,
                error,
                condition,
                str(len(group)),
                str(len(failed)),
                f"{max(item.backward for item in group):.2f}°",
                f"{max(abs(item.angle_error) for item in group):.1f}°",
                f"{min(item.sigma for item in group):.1f}",
                first,
            )
        )
    return result


def _cells(outcome: Outcome) -> tuple[object, ...]:
    case = outcome.case
    about = (case.way, case.angle, case.direction, case.load, case.error, case.seed, case.speed)
    found = (outcome.backward, outcome.sigma, outcome.angle_error, outcome.start)
    return (*about, outcome.problem or "", *(f"{value:.4f}" for value in found))


def write(directory: Path, outcomes: Sequence[Outcome], profile: str) -> None:
    """Writes `startup.csv` (all cases), `startup.svg` and `metrics.json` into an existing directory."""
    about = {"profile": profile, "revision": revision(), "firmware": firmware()}
    csv_table.write(directory / "startup.csv", about, _COLUMNS, map(_cells, outcomes))
    metrics = {
        **about,
        "starts": len(outcomes),
        "failed": sum(1 for item in outcomes if item.problem),
        "ways": {way: _figures([item for item in outcomes if item.case.way == way]) for way in WAYS},
    }
    (directory / output.MARK).write_text(json.dumps(metrics, indent=2) + "\n", encoding="utf-8")
    _draw(directory / "startup.svg", outcomes)


def _figures(group: Sequence[Outcome]) -> dict[str, float | int]:
    if not group:
        return {"starts": 0, "failed": 0}
    return {
        "starts": len(group),
        "failed": sum(1 for item in group if item.problem),
        "backward_max": max(item.backward for item in group),
        "angle_error_max": max(abs(item.angle_error) for item in group),
        "sigma_min": min(item.sigma for item in group),
        "start_max": max(item.start for item in group),
    }


def _draw(path: Path, outcomes: Sequence[Outcome]) -> None:
    """Motion backwards and angle error over the initial angle, a column for each way that was run."""
    ways = [way for way in WAYS if any(item.case.way == way for item in outcomes)]
    mpl = extras.need("matplotlib")
    from stillspin.report.canvas import subplots  # noqa: PLC0415 - needs it as well

    with mpl.rc_context(STYLE):
        canvas, grid = subplots(2, len(ways), figsize=(WIDTH, 5.0), layout=None, sharex=True, squeeze=False)
        for column, way in enumerate(ways):
            group = [item for item in outcomes if item.case.way == way]
            grid[0][column].set_title(_TITLES[way])
            _scatter(grid[0][column], group, [item.backward for item in group], "error")
            grid[0][column].axhline(BACKWARD_LIMIT, color=COLOURS["reference"], linestyle=(0, (4, 2)))
            _scatter(grid[1][column], group, [item.angle_error for item in group], "true")
            grid[1][column].set_xlabel("initial angle, ° el.")
        grid[0][0].set_ylabel("backwards, ° mech.")
        grid[1][0].set_ylabel("angle error at RUN, ° el.")
        canvas.tight_layout()
        canvas.savefig(path, metadata={"Date": None})


def _scatter(axes: Axes, group: Sequence[Outcome], values: Sequence[float], colour: str) -> None:
    axes.scatter([item.case.angle for item in group], values, s=7, color=COLOURS[colour], alpha=0.5, linewidths=0)
