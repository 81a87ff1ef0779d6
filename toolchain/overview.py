#!/usr/bin/env python3
"""The README's picture: speed or load, and position error, in four scenarios.

Usage: toolchain/overview.py RESULTS PICTURE, where `stillspin reproduce` has written the scenarios below to RESULTS
(make pictures).
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")  # before pyplot: no display is needed

import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from stillspin.core import Signals
from stillspin.measure import metrics, pieces
from stillspin.report.output import RUNS
from stillspin.report.plots import thinned
from stillspin.report.style import RUN_COLOURS, STYLE
from stillspin.runs import records

UNITS = {"true_speed": "true speed (rpm)", "load_torque": "load (N m)"}


@dataclass(frozen=True)
class Cell:
    """Runs of a scenario with their words, in a window (s): a signal above, the position error below."""

    scenario: str
    title: str
    signal: str
    runs: Mapping[str, str]
    window: tuple[float, float]


CELLS = (
    Cell("A10", "5 rpm without load", "true_speed", {"creep": ""}, (0.05, 3.2)),
    Cell("A11", "0 → 11 N m → 0 at standstill", "load_torque", {"ramp": ""}, (0.0, 5.5)),
    Cell("A16", "reversal, 600 to −600 rpm", "true_speed", {"reversal": ""}, (0.0, 3.2)),
    Cell("A18b", "2 N m step at 600 rpm", "true_speed", {"predictive": "predictive", "pi": "PI"}, (0.9, 1.5)),
)


def seen(record: records.Record, window: tuple[float, float]) -> Signals:
    """The signals inside a window."""
    time = record.signals["time"]
    inside = (time >= window[0]) & (time <= window[1])
    return {name: values[inside] for name, values in record.signals.items()}


def draw(cell: Cell, results: Path, upper: Axes, lower: Axes) -> str:
    """Draw a scenario; returns how it was run."""
    how = ""
    for (run, words), colour in zip(cell.runs.items(), RUN_COLOURS, strict=False):
        record = records.read(results / RUNS / f"{cell.scenario}-{run}.parquet")
        part = seen(record, cell.window)
        time = pieces.as_floats(part["time"])
        upper.plot(*thinned(time, pieces.as_floats(part[cell.signal])), color=colour, label=words)
        lower.plot(*thinned(time, metrics.position_error(part)), color=colour)
        how = f"profile {record.about['profile']}, {record.about['parameters_from']}, seed {record.about['seed']}"
    upper.set(title=f"{cell.scenario}: {cell.title}", ylabel=UNITS[cell.signal])
    lower.set(xlabel="time (s)", ylabel="position error (° el)")
    if len(cell.runs) > 1:
        upper.legend(loc="lower right")
    for axes in (upper, lower):
        axes.margins(x=0.0)
    return how


def main(results: Path, picture: Path) -> None:
    """Draw all of them."""
    with mpl.rc_context({**STYLE, "axes.titlesize": 10.5, "axes.titlelocation": "left"}):
        canvas, grid = plt.subplots(4, 2, figsize=(12.0, 7.3), layout="constrained", height_ratios=(6, 5, 6, 5))
        how = ""
        for number, cell in enumerate(CELLS):
            row, column = divmod(number, 2)
            upper, lower = grid[2 * row, column], grid[2 * row + 1, column]
            how = draw(cell, results, upper, lower)
            upper.sharex(lower)
            upper.tick_params(labelbottom=False)
        canvas.align_ylabels()
        canvas.suptitle(f"Sensorless, {how}", x=0.005, ha="left", fontsize=11.5)
        canvas.savefig(picture, dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
