#!/usr/bin/env python3
"""The pictures of docs/tuning.md: the same run with a parameter changed, one over the other.

Usage: toolchain/tuning_pictures.py [NAME]...     (make pictures; some ten seconds each)

The drive runs on the parameters that the recorded commissioning found (docs/figures/bench.json).
"""

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")  # before pyplot: no display is needed

import matplotlib.pyplot as plt

from stillspin.measure import metrics, pieces
from stillspin.report.plots import thinned
from stillspin.report.style import RUN_COLOURS, STYLE
from stillspin.runs import records

ROOT = Path(__file__).resolve().parent.parent
STILLSPIN = ROOT / ".venv/bin/stillspin"
ERROR = "position error (° el)"
LABELS = {"true_speed": "speed (rpm)", "i_q": "torque current (A)"}


@dataclass(frozen=True)
class Picture:
    """A run of a scenario with each of some changes, in a window (s); `changes` in words and as `--set` takes them."""

    name: str
    run: str
    changes: dict[str, str]
    panels: tuple[str, ...]
    window: tuple[float, float]


PICTURES = (
    Picture(
        "overshoot",
        "A18a-predictive",
        {"inertia half of what it is": "inertia=0.00275", "right": "", "twice": "inertia=0.011"},
        ("true_speed", "i_q"),
        (0.0, 0.8),
    ),
    Picture(
        "load-step",
        "A18b-predictive",
        {"as it is": "", "observer_load_rate 0.1 Nm": "observer_load_rate=0.1", "speed_law 1 (PI)": "speed_law=1"},
        ("true_speed", "i_q"),
        (0.95, 1.25),
    ),
    Picture(
        "noise",
        "A10-creep",
        {f"observer_noise {value} mA": f"observer_noise={value}" for value in (30, 100, 400)},
        ("i_q", ERROR),
        (1.0, 2.0),
    ),
    Picture(
        "ramp",
        "A16-reversal",
        {f"speed_ramp {value} rpm/s": f"speed_ramp={value}" for value in (1500, 3000, 9000)},
        ("true_speed", "i_q"),
        (0.0, 3.2),
    ),
)


def record(picture: Picture, change: str, params: Path, work: Path) -> records.Record:
    """The picture's run with a change."""
    scenario = picture.run.split("-", maxsplit=1)[0]
    options = [option for one in change.split() for option in ("--set", one)]
    if "inertia=" in change:
        options += ["--set", "inertia_adapt=0"]  # else the drive learns it in the very run
    command = [STILLSPIN, "run", scenario, "--no-plots", "--params", params, "--out", work, *options]
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return records.read(work / "runs" / f"{picture.run}.parquet")


def draw(picture: Picture, params: Path) -> None:
    """Run and draw a picture."""
    with mpl.rc_context(STYLE):
        canvas, grid = plt.subplots(len(picture.panels), 1, sharex=True, figsize=(9.2, 4.6), layout="constrained")
        for (words, change), colour in zip(picture.changes.items(), RUN_COLOURS, strict=False):
            with tempfile.TemporaryDirectory() as work:
                signals = record(picture, change, params, Path(work) / "out").signals
            time = pieces.as_floats(signals["time"])
            inside = (time >= picture.window[0]) & (time <= picture.window[1])
            for panel, axes in zip(picture.panels, grid, strict=True):
                values = metrics.position_error(signals) if panel == ERROR else pieces.as_floats(signals[panel])
                axes.plot(*thinned(time[inside], values[inside]), color=colour, label=words)
                axes.set_ylabel(LABELS.get(panel, panel))
                axes.margins(x=0.0)
        canvas.legend(*grid[0].get_legend_handles_labels(), loc="outside upper right", ncols=3)
        grid[-1].set_xlabel("time (s)")
        canvas.align_ylabels()
        canvas.savefig(ROOT / f"docs/images/tuning-{picture.name}.png", dpi=100, metadata={"Software": None})
        plt.close(canvas)


def main() -> None:
    """Draw the pictures named, or all."""
    found = json.loads((ROOT / "docs/figures/bench.json").read_text(encoding="utf-8"))["figures"]["params"][
        "parameters"
    ]
    with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as params:
        params.write("[parameters]\n" + "".join(f"{name} = {value!r}\n" for name, value in found.items()))
        params.flush()
        for picture in PICTURES:
            if not sys.argv[1:] or picture.name in sys.argv[1:]:
                draw(picture, Path(params.name))
                print(f"docs/images/tuning-{picture.name}.png", flush=True)


if __name__ == "__main__":
    main()
