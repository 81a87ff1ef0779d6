"""One run on disk: a Parquet file with a column per signal and everything that makes the run repeatable beside it.

The figures of merit and the plots are computed from what is read back, so the file is all that a claim rests on.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stillspin import extras, tabular
from stillspin.core import Signals, Waveform


@dataclass(frozen=True)
class Record:
    """Signals of a run and what is known about it (scenario, run, profile, seed, revision, plant, outcome …)."""

    signals: Signals
    about: dict[str, Any]


def write(path: Path, signals: Mapping[str, Any], about: Mapping[str, Any], units: Mapping[str, str]) -> None:
    """Write a run.

    Args:
        path: the file; its directory exists.
        signals: equally long arrays. Floating point is stored in single precision (1e-7 of the value, far below any
            sensor here), but `time` in double.
        about: JSON values, stored in the file's metadata.
        units: unit per signal, stored with its column.
    """
    columns = {name: _stored(name, np.asarray(data)) for name, data in signals.items()}
    _parquet().write_table(tabular.arrow(columns, units, about), path, compression="zstd")


def write_waveform(path: Path, waveform: Mapping[str, Mapping[str, Any]], about: Mapping[str, Any]) -> None:
    """Write the stretch of a run that was looked into: one row, a column `table.name` for each list of values."""
    pa = extras.need("pyarrow")
    lists = {
        f"{table}.{name}": pa.array([_stored(name, np.asarray(data))])
        for table, columns in waveform.items()
        for name, data in columns.items()
    }
    stored = pa.table(lists).replace_schema_metadata({tabular.ABOUT: json.dumps(about, sort_keys=True)})
    _parquet().write_table(stored, path, compression="zstd")


def read_waveform(path: Path) -> Waveform:
    """Read what `write_waveform` wrote: table -> name -> values."""
    stored = _parquet().ParquetFile(path).read()
    waveform: Waveform = {}
    for column in stored.column_names:
        table, _, name = column.partition(".")
        waveform.setdefault(table, {})[name] = stored.column(column)[0].values.to_numpy()
    return waveform


def _parquet() -> Any:
    return extras.need("pyarrow.parquet")


def _stored(name: str, data: Any) -> Any:
    if data.dtype.kind == "f":
        return data.astype(np.float64 if name == "time" else np.float32)
    return data


def read(path: Path) -> Record:
    """Read a run written by `write`."""
    table = _parquet().ParquetFile(path).read()
    # Over DLPack: Arrow's own way loads pandas wherever that is installed.
    signals = {name: np.from_dlpack(table.column(name).combine_chunks()) for name in table.column_names}
    return Record(signals, json.loads((table.schema.metadata or {}).get(tabular.ABOUT, b"{}")))
