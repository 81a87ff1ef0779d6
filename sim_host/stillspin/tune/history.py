"""What was plotted since the server was started, kept for export as a file."""

from __future__ import annotations

import tempfile
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin import csv_table
from stillspin.errors import InputError
from stillspin.runs import records

_MOST = 1_500_000
"""Samples kept, more than 8 h at 50 a second; the oldest go first."""

Column = npt.NDArray[Any]


@dataclass
class Part:
    """A stretch with the same signals and the same clock."""

    units: dict[str, str]
    blocks: list[Column] = field(default_factory=list)
    """Rows of time and values."""


class History:
    """Any thread."""

    def __init__(self) -> None:
        self._parts: list[Part] = []
        self._count = 0
        self._lock = threading.Lock()

    def begin(self, units: dict[str, str]) -> None:
        """Other signals, or a drive that has begun anew; `units` by name."""
        with self._lock:
            self._parts.append(Part(units))

    def add(self, times: list[float], columns: list[list[float]]) -> None:
        """Samples of the stretch that was begun last; times in seconds of the drive."""
        with self._lock:
            self._parts[-1].blocks.append(np.array([times, *columns]).T)
            self._count += len(times)
            while self._count > _MOST:
                self._drop()

    def _drop(self) -> None:
        oldest = next(part for part in self._parts if part.blocks)
        self._count -= len(oldest.blocks.pop(0))

    def file(self, ending: str, version: str) -> bytes:
        """A file of it: `parquet` with units in the columns' metadata, `csv` with units in the headings.

        Both say of which firmware they are. `time` is the drive's, s; `part` counts the stretches. What was not plotted
        is empty (CSV) or NaN.

        Raises:
            InputError: nothing was plotted yet.
        """
        columns, units = self._columns()
        about = {"firmware": version}
        return _parquet(columns, units, about) if ending == "parquet" else _csv(columns, units, about)

    def _columns(self) -> tuple[dict[str, Column], dict[str, str]]:
        with self._lock:
            parts = [(part.units, np.concatenate(part.blocks)) for part in self._parts if part.blocks]
        if not parts:
            raise InputError("nothing was plotted yet")
        units = {name: unit for own, _ in parts for name, unit in own.items()}
        columns: dict[str, Column] = {
            "time": np.concatenate([rows[:, 0] for _, rows in parts]),
            "part": np.concatenate([np.full(len(rows), at, np.int32) for at, (_, rows) in enumerate(parts, 1)]),
        }
        for name in units:
            pieces = [
                rows[:, 1 + list(own).index(name)] if name in own else np.full(len(rows), np.nan) for own, rows in parts
            ]
            columns[name] = np.concatenate(pieces)
        return columns, {"time": "s", "part": "", **units}


def _parquet(columns: dict[str, Column], units: dict[str, str], about: dict[str, str]) -> bytes:
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "history.parquet"
        records.write(path, columns, about, units)
        return path.read_bytes()


def _csv(columns: dict[str, Column], units: dict[str, str], about: dict[str, str]) -> bytes:
    names = [csv_table.heading(name, units[name]) for name in columns]
    rows = (
        [f"{row[0]:.3f}", int(row[1]), *("" if np.isnan(value) else f"{value:.7g}" for value in row[2:])]
        for row in zip(*columns.values(), strict=True)
    )
    return csv_table.text(about, names, rows).encode()
