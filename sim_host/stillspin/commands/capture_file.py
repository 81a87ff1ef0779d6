"""Captures as files: Parquet, CSV, MF4, and a drawing; the ending of the name says which."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stillspin import csv_table, extras, mdf
from stillspin.drive.scope import Capture
from stillspin.errors import InputError
from stillspin.report.style import PANEL_HEIGHT, RUN_COLOURS, STYLE, WIDTH
from stillspin.runs import records

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DRAWINGS = {".svg": "Description", ".png": "Description", ".pdf": "Subject"}
"""What a drawing's format calls the words about it."""


def check(path: Path) -> None:
    """Complain about a name or a place before the capture is made rather than after it.

    Raises:
        InputError: an ending that means nothing here, or whose package is not installed, or no such directory.
    """
    suffix = path.suffix.lower()
    if suffix not in WRITERS:
        raise InputError(f"{path}: the ending must be one of {', '.join(WRITERS)}")
    package = _package(suffix)
    if package:
        extras.need(package)
    if path.is_dir() or not path.absolute().parent.is_dir():
        raise InputError(f"{path}: cannot be written (no such directory)")


def usual(stem: str) -> list[Path]:
    """What is written where no file is named: a table and a drawing; CSV where the packages for both are missing."""
    endings = [ending for ending in (".parquet", ".svg") if extras.has(_package(ending))]
    return [Path(stem + ending) for ending in endings or [".csv"]]


def _package(suffix: str) -> str:
    """What has to be installed for an ending; empty where nothing has."""
    return "matplotlib" if suffix in _DRAWINGS else "pyarrow" if suffix == ".parquet" else ""


def write(path: Path, capture: Capture) -> None:
    """Write a capture; the file appears whole or not at all.

    Raises:
        InputError: see `check`; or it cannot be written.
    """
    check(path)
    suffix = path.suffix.lower()
    try:
        with tempfile.TemporaryDirectory(prefix=f".{path.stem}-", dir=path.absolute().parent) as beside:
            partial = Path(beside) / f"capture{suffix}"
            WRITERS[suffix](partial, capture)
            partial.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error


def _parquet(path: Path, capture: Capture) -> None:
    records.write(path, {"time": capture.time, **capture.signals}, capture.about, {"time": "s", **capture.units})


def _csv(path: Path, capture: Capture) -> None:
    """Units are in the headings; time in s from the trigger."""
    names = [csv_table.heading(name, unit) for name, unit in {"time": "s", **capture.units}.items()]
    rows = (
        [f"{time:.6f}", *(f"{values[index]:.7g}" for values in capture.signals.values())]
        for index, time in enumerate(capture.time)
    )
    csv_table.write(path, capture.about, names, rows)


def _mf4(path: Path, capture: Capture) -> None:
    comment = f"stillspin, firmware {capture.version}; time 0 is the trigger"
    mdf.write(path, capture.time, capture.signals, capture.units, comment)


def draw(capture: Capture) -> Figure:
    """One panel for each unit, the trigger as a line through all."""
    mpl, figures = extras.need("matplotlib"), extras.need("matplotlib.figure")
    units = list(dict.fromkeys(capture.units.values()))
    with mpl.rc_context(STYLE):
        figure: Figure = figures.Figure(figsize=(WIDTH, PANEL_HEIGHT * max(2, len(units)) + 0.5), layout="constrained")
        panels = figure.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0]
        for panel, unit in zip(panels, units, strict=True):
            names = [name for name in capture.signals if capture.units[name] == unit]
            for name in names:
                colour = RUN_COLOURS[list(capture.signals).index(name)]
                panel.plot(capture.time * 1e3, capture.signals[name], color=colour, label=name)
            panel.axvline(0, color="#9aa3ad", linewidth=0.8, zorder=1)
            panel.set_ylabel(unit)
            panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=len(names))
        panels[-1].set_xlabel("time from the trigger, ms")
    return figure


def _drawing(path: Path, capture: Capture) -> None:
    figure = draw(capture)
    with extras.need("matplotlib").rc_context(STYLE):
        figure.savefig(path, dpi=110, metadata={_DRAWINGS[path.suffix]: f"firmware {capture.version}"})


WRITERS: dict[str, Callable[[Path, Capture], None]] = {
    ".parquet": _parquet,
    ".csv": _csv,
    ".mf4": _mf4,
    **dict.fromkeys(_DRAWINGS, _drawing),
}
"""What there is for which ending."""
