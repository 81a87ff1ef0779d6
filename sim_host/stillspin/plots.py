"""Drawings of runs for the report: static SVG, one look, small enough to embed.

Long records are thinned to the extremes of as many slices as the page has columns, so no peak is lost.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import matplotlib as mpl

mpl.use("Agg")  # before pyplot: no display is needed

import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from stillspin import metrics
from stillspin.core import Signals
from stillspin.metrics import Floats
from stillspin.panels import PANELS, Panel
from stillspin.scenario import Plot, Scenario, Window

WIDTH = 9.2
PANEL_HEIGHT = 1.85
COLUMNS = 1100
"""Slices a line is thinned to; each keeps its smallest and its largest value."""

# Distinguishable with the common colour blindnesses (after Okabe and Ito).
COLOURS = {
    "true": "#0b5fa5",
    "estimate": "#e07b00",
    "reference": "#3a3a3a",
    "setpoint": "#9aa3ad",
    "error": "#b3243b",
    "q": "#0b5fa5",
    "d": "#1b8a5a",
    "a": "#0b5fa5",
    "b": "#e07b00",
    "c": "#1b8a5a",
}
RUN_COLOURS = ["#0b5fa5", "#e07b00", "#1b8a5a", "#b3243b", "#7a4fb0", "#8a6d1b", "#1aa3b8", "#5c5c5c"]

# An estimate lies as a pale band under the true line, so that both are seen where they agree.
ROLES: dict[str, Any] = {
    "true": {"zorder": 3},
    "reference": {"zorder": 4, "linestyle": (0, (4, 2)), "linewidth": 1.0},
    "setpoint": {"zorder": 1.5, "linewidth": 2.2},
    "estimate": {"zorder": 2, "linewidth": 2.6, "alpha": 0.6},
}

STYLE: Any = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same drawing on every machine
    "font.size": 10.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#888888",
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "axes.labelcolor": "#333333",
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "lines.linewidth": 1.1,
    "svg.fonttype": "path",
    "svg.hashsalt": "stillspin",  # the same run gives the same bytes
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
}


def draw(plot: Plot, scenario: Scenario, recorded: Mapping[str, Signals]) -> str:
    """A plot as SVG text.

    Args:
        plot: what to show.
        scenario: to which the plot belongs.
        recorded: signals by run; runs of the plot that have none in its window are left out.
    """
    parts = {name: _visible(recorded[name], plot.window) for name in plot.runs if name in recorded}
    shown = {name: part for name, part in parts.items() if part["time"].size > 1}
    with mpl.rc_context(STYLE):
        square = "trajectory" in plot.panels
        canvas = _trajectories(shown, scenario) if square else _stack(plot, scenario, shown)
        text = io.StringIO()
        canvas.savefig(text, format="svg", metadata={"Date": None, "Creator": "stillspin"})
        plt.close(canvas)
    return text.getvalue()


def _stack(plot: Plot, scenario: Scenario, shown: Mapping[str, Signals]) -> Canvas:
    canvas, grid = plt.subplots(
        len(plot.panels),
        1,
        sharex=True,
        squeeze=False,
        figsize=(WIDTH, 0.6 + PANEL_HEIGHT * len(plot.panels)),
        layout="constrained",
    )
    for name, axes in zip(plot.panels, grid[:, 0], strict=True):
        _panel(axes, PANELS[name], plot, scenario, shown)
    grid[-1, 0].set_xlabel("time since the end of the start procedure (s)")
    canvas.align_ylabels()
    return canvas


def _panel(axes: Axes, panel: Panel, plot: Plot, scenario: Scenario, shown: Mapping[str, Signals]) -> None:
    for number, (name, part) in enumerate(shown.items()):
        time = metrics.as_floats(part["time"])
        run = scenario.run(name)
        if len(shown) == 1:
            for line in panel.lines:
                _line(axes, panel, (time, line.compute(part, run)), _Look(line.label, COLOURS[line.role], line.role))
        else:
            first = panel.lines[0]
            look = _Look(run.title or name, RUN_COLOURS[number % len(RUN_COLOURS)], first.role)
            _line(axes, panel, (time, first.compute(part, run)), look)
    if len(shown) > 1:
        _shared(axes, panel, scenario, shown)
    axes.set_ylabel(panel.label)
    axes.margins(x=0.0)
    if panel.symmetric:
        axes.axhline(0.0, color="#888888", linewidth=0.8, zorder=1)
    if panel.wraps:
        axes.set_ylim(-190, 190)
        axes.set_yticks([-180, -90, 0, 90, 180])
    # Runs have the same colours in all panels: the first one names them.
    if len(shown) <= 1 or panel is PANELS[plot.panels[0]]:
        _legend(axes)


def _legend(axes: Axes) -> None:
    """In a row above the axes, where it covers nothing."""
    handles, labels = axes.get_legend_handles_labels()
    if len(labels) < 2:
        return
    many = len(labels) > 5
    axes.legend(
        handles,
        labels,
        loc="lower right",
        bbox_to_anchor=(1.0, 0.98),
        ncols=len(labels),
        fontsize=8.0 if many else 9.5,
        handlelength=0.9 if many else 1.3,
        columnspacing=0.9 if many else 1.2,
        borderaxespad=0.0,
    )


def _shared(axes: Axes, panel: Panel, scenario: Scenario, shown: Mapping[str, Signals]) -> None:
    """The reference of a panel that overlays runs, once when it is the same in all of them."""
    name, part = next(iter(shown.items()))
    commands = {scenario.run(other).commands for other in shown}
    reference = next((line for line in panel.lines if line.role == "reference"), None)
    if reference is None or len(commands) > 1:
        return
    points = metrics.as_floats(part["time"]), reference.compute(part, scenario.run(name))
    _line(axes, panel, points, _Look(reference.label, COLOURS["reference"], "reference"))


@dataclass(frozen=True)
class _Look:
    """Word in the legend, colour and role of a line."""

    label: str
    colour: str
    role: str


def _line(axes: Axes, panel: Panel, points: tuple[Floats, Floats], look: _Look) -> None:
    time, values = thinned(*(_broken(*points) if panel.wraps else points))
    axes.plot(time, values, label=look.label, color=look.colour, **ROLES.get(look.role, {}))


def _visible(signals: Signals, window: Window | None) -> Signals:
    time = signals["time"]
    first, last = window or (0.0, float("inf"))
    mask = (time >= first) & (time <= last)
    return {name: data[mask] for name, data in signals.items()}


def _broken(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Gaps (NaN) where a wrapped angle jumps."""
    jumps = np.flatnonzero(np.abs(np.diff(values)) > 180.0) + 1
    return np.insert(time, jumps, time[jumps]), np.insert(values, jumps, np.nan)


def thinned(time: Floats, values: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """The line with at most two points per column: the smallest and the largest value of each, in their order.

    Args:
        time: rising.
        values: same length; NaN marks a gap and is kept.
        columns: slices of the whole.
    """
    if time.size <= 4 * columns:
        return time, values
    edges = np.linspace(0, time.size, columns + 1).astype(int)
    keep: list[int] = []
    for first, last in pairwise(edges.tolist()):
        part = values[first:last]
        if np.isnan(part).all():
            keep.append(first)
            continue
        ends = {int(np.nanargmin(part)), int(np.nanargmax(part)), *np.flatnonzero(np.isnan(part)).tolist()}
        keep.extend(first + place for place in sorted(ends))
    index: npt.NDArray[np.int64] = np.array(keep, dtype=np.int64)
    return time[index], values[index]


def _trajectories(shown: Mapping[str, Signals], scenario: Scenario) -> Canvas:
    """The current vector's path in the stationary frame, one square per run, all to the same scale."""
    count = max(1, len(shown))
    canvas, grid = plt.subplots(1, count, squeeze=False, figsize=(WIDTH, WIDTH / 2.3), layout="constrained")
    paths = {name: metrics.current_vector(signals) for name, signals in shown.items()}
    limit = 1.08 * max((float(np.max(np.hypot(*path))) for path in paths.values()), default=1.0)
    for axes, (name, (alpha, beta)) in zip(_flat(grid), paths.items(), strict=False):
        axes.plot(alpha, beta, color=COLOURS["true"], linewidth=0.6)
        mean = float(np.mean(np.hypot(alpha, beta)))
        turn = np.linspace(0.0, 2.0 * np.pi, 200)
        axes.plot(
            mean * np.cos(turn), mean * np.sin(turn), color=COLOURS["reference"], linestyle=(0, (4, 2)), linewidth=0.9
        )
        axes.set(xlabel="$i_α$ (A)", ylabel="$i_β$ (A)", title=scenario.run(name).title or name, aspect="equal")
        axes.set_xlim(-limit, limit)
        axes.set_ylim(-limit, limit)
    return canvas


def _flat(grid: Any) -> Sequence[Axes]:
    return list(grid.ravel())
