"""Drawings of runs for the report: static SVG, one look, small enough to embed.

Long records are thinned to the extremes of as many slices as the page has columns, so no peak is lost.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from stillspin.cases.scenario import Plot, Scenario, Window
from stillspin.core import Signals
from stillspin.measure import pieces
from stillspin.measure.pieces import Extras, Floats
from stillspin.report.canvas import subplots
from stillspin.report.panels import PANELS, Panel
from stillspin.report.special_plots import SPECIAL, Shown
from stillspin.report.style import COLOURS, COLUMNS, PANEL_HEIGHT, ROLES, RUN_COLOURS, STYLE, WIDTH


def draw(
    plot: Plot, scenario: Scenario, recorded: Mapping[str, Signals], extras: Mapping[str, Extras] | None = None
) -> str:
    """A plot as SVG text.

    Args:
        plot: what to show.
        scenario: to which the plot belongs.
        recorded: signals by run; runs of the plot that have none in its window are left out.
        extras: what else is known of the runs.
    """
    parts = {name: _visible(recorded[name], plot.window) for name in plot.runs if name in recorded}
    shown = {name: part for name, part in parts.items() if part["time"].size > 1}
    with mpl.rc_context(STYLE):
        special = SPECIAL.get(plot.panels[0])
        canvas = special(Shown(scenario, shown, extras or {})) if special else _stack(plot, scenario, shown)
        text = io.StringIO()
        canvas.savefig(text, format="svg", metadata={"Date": None, "Creator": "stillspin"})
    return text.getvalue()


def _stack(plot: Plot, scenario: Scenario, shown: Mapping[str, Signals]) -> Canvas:
    height = 0.6 + PANEL_HEIGHT * len(plot.panels)
    canvas, grid = subplots(len(plot.panels), sharex=True, squeeze=False, figsize=(WIDTH, height))
    for name, axes in zip(plot.panels, grid[:, 0], strict=True):
        _panel(axes, PANELS[name], plot, scenario, shown)
    grid[-1, 0].set_xlabel("time since the end of the start procedure (s)")
    canvas.align_ylabels()
    return canvas


def _panel(axes: Axes, panel: Panel, plot: Plot, scenario: Scenario, shown: Mapping[str, Signals]) -> None:
    for number, (name, part) in enumerate(shown.items()):
        time = pieces.as_floats(part["time"])
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
    points = pieces.as_floats(part["time"]), reference.compute(part, scenario.run(name))
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
    column = np.repeat(np.arange(columns), np.diff(edges))
    gaps = np.isnan(values)
    # Sorted within each column, NaN last: the smallest is the first, the largest the first of the other way round.
    lowest = np.lexsort((values, column))[edges[:-1]]
    highest = np.lexsort((-values, column))[edges[:-1]]
    keep = gaps & ~gaps[lowest][column]  # of a column of gaps alone one is enough
    keep[lowest] = keep[highest] = True
    return time[keep], values[keep]
