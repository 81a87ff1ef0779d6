#!/usr/bin/env python3
"""The papers' figures as their own drives have them here, drawn as there: docs/images/papers-a.png, papers-b.png.

Usage: toolchain/papers_pictures.py RESULTS PICTURES, where `stillspin run ID --out RESULTS/ID` has written the
scenarios below, and those of METHODS once more on the low-pass to RESULTS/low-pass/ID (make pictures).
"""

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from stillspin.core import Signals
from stillspin.measure import metrics, pieces
from stillspin.report.canvas import subplots
from stillspin.report.output import RUNS
from stillspin.report.plots import thinned
from stillspin.report.style import COLOURS, RUN_COLOURS, STYLE
from stillspin.runs import records


@dataclass(frozen=True)
class Column:
    """A figure of the current-deviation paper: a run, in a window (s); of its angles a shorter one."""

    title: str
    scenario: str
    run: str
    window: tuple[float, float]
    angles: tuple[float, float]


CURRENT_DEVIATION = (
    Column("Fig. 10: 5 rpm", "A10", "creep", (0.0, 3.2), (0.0, 3.2)),
    Column("Fig. 11: 11 N m at standstill", "A11", "ramp", (0.0, 5.5), (0.0, 5.5)),
    Column("Fig. 15: transition", "A15", "there_and_back", (0.4, 2.9), (0.4, 0.8)),
    Column("Fig. 16: 600 to −600 rpm", "A16", "reversal", (0.0, 3.2), (1.0, 1.6)),
)
METHODS = (("CONV", "B14", "conv_light"), ("PP-01", "B15", "pp01_light"), ("PP-02", "B16", "pp02_light"))
LOWEST = (("", "by Fig. 5", COLOURS["true"]), ("low-pass", "on the low-pass", COLOURS["estimate"]))
INDUCTANCES = (("nominal", "as told"), ("ld_low", "$L_d$ −30 %"), ("ld_high", "$L_d$ +30 %"))
INDUCTANCES += (("lq_low", "$L_q$ −30 %"), ("lq_high", "$L_q$ +30 %"))


def read(results: Path, scenario: str, run: str, folder: str = "") -> Signals:
    """The signals of a run."""
    return records.read(results / folder / scenario / RUNS / f"{scenario}-{run}.parquet").signals


def cut(signals: Signals, window: tuple[float, float]) -> Signals:
    """The signals inside a window."""
    inside = (signals["time"] >= window[0]) & (signals["time"] <= window[1])
    return {name: values[inside] for name, values in signals.items()}


def curve(axes: Axes, signals: Signals, name: str, label: str = "", **more: object) -> None:
    """A signal over time; angles in degrees, wrapped."""
    values = pieces.as_floats(signals[name])
    if name.endswith("angle"):
        values = pieces.wrap_degrees(values)
        values = np.where(np.abs(np.diff(values, prepend=values[:1])) > 180.0, np.nan, values)
    axes.plot(*thinned(pieces.as_floats(signals["time"]), values), label=label, linewidth=0.9, **more)  # type: ignore[arg-type]


def pair(axes: Axes, signals: Signals, quantity: str) -> None:
    """What the drive thinks, and what is."""
    curve(axes, signals, f"est_{quantity}", "estimated", color=COLOURS["estimate"])
    curve(axes, signals, f"true_{quantity}", "true", color=COLOURS["true"])


def current_deviation(results: Path) -> Canvas:
    """Speeds, angles and the position error, a column for each figure."""
    canvas, grid = subplots(3, len(CURRENT_DEVIATION), figsize=(13.0, 6.6))
    for number, column in enumerate(CURRENT_DEVIATION):
        signals = read(results, column.scenario, column.run)
        part = cut(signals, column.window)
        speed, angle, error = grid[:, number]
        pair(speed, part, "speed")
        pair(angle, cut(signals, column.angles), "angle")
        error.plot(*thinned(pieces.as_floats(part["time"]), metrics.position_error(part)), color=COLOURS["true"])
        speed.set(title=column.title)
        error.set(xlabel="time (s)")
    for axes, words in zip(grid[:, 0], ("speed (rpm)", "angle (° el)", "position error (° el)"), strict=True):
        axes.set(ylabel=words)
    grid[0, 0].legend(loc="upper right")
    return canvas


def lowest_speeds(results: Path, row: Iterable[Axes]) -> None:
    """Figs. 14 to 16: by Fig. 5, and on the low-pass with drops that nobody takes off."""
    for axes, (method, scenario, run) in zip(row, METHODS, strict=True):
        for folder, words, colour in LOWEST:
            curve(axes, read(results, scenario, run, folder), "true_speed", words, color=colour)
        axes.set(title=f"Fig. {scenario[1:]}: {method}, 1 N m", xlabel="time (s)", yscale="log", ylim=(8.0, 2500.0))


def load_angles(axes: Axes, results: Path, method: str) -> None:
    """Fig. 9: what the drive makes of it, and what it is with other inductances than the drive was told."""
    for (run, words), colour in zip(INDUCTANCES, RUN_COLOURS, strict=False):
        signals = cut(read(results, "B09", f"{method.lower().replace('-', '')}_{run}"), (1.2, 2.6))
        current = np.hypot(pieces.as_floats(signals["true_i_d"]), pieces.as_floats(signals["true_i_q"]))
        order = np.argsort(current)
        order = order[current[order] > 1.0]
        for name, line in (("load_angle", "-"), ("true_load_angle", "--")):
            angle = pieces.wrap_degrees(pieces.as_floats(signals[name]))
            label = words if name == "load_angle" else ""
            axes.plot(current[order], angle[order], line, color=colour, linewidth=0.9, label=label)
    axes.set(title=f"Fig. 9: {method}; dashed: true", xlabel="current (A)", ylabel="load angle (° el)")


def stator_flux(results: Path) -> Canvas:
    """Lowest stable speeds above, load angles over the current and load steps below."""
    canvas, grid = subplots(2, 3, figsize=(13.0, 5.6))
    lowest_speeds(results, grid[0])
    for axes, method in zip(grid[1], ("CONV", "PP-02"), strict=False):
        load_angles(axes, results, method)
    pair(grid[1, 2], read(results, "B20", "pp02"), "speed")
    grid[1, 2].set(title="Fig. 20: PP-02, load steps", xlabel="time (s)", ylabel="speed (rpm)")
    grid[0, 0].set(ylabel="speed (rpm)")
    for axes in (grid[0, 0], grid[1, 0]):
        axes.legend(loc="best")
    return canvas


def main(results: Path, pictures: Path) -> None:
    """Draw both."""
    drawings: dict[str, Callable[[Path], Canvas]] = {"papers-a": current_deviation, "papers-b": stator_flux}
    for name, draw in drawings.items():
        with mpl.rc_context({**STYLE, "axes.titlesize": 10.5, "axes.titlelocation": "left"}):
            draw(results).savefig(pictures / f"{name}.png", dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
