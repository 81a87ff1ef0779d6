"""Columns with units as tables of other tools: of Arrow and of pandas."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from stillspin import extras

ABOUT = b"stillspin"
"""Key of a schema's metadata; its value is JSON."""


def arrow(columns: Mapping[str, Any], units: Mapping[str, str], about: Mapping[str, Any]) -> Any:
    """A pyarrow.Table.

    Args:
        columns: equally long arrays by name.
        units: by name; stored as `unit` in the metadata of the column's field.
        about: JSON values, stored under `stillspin` in the schema's metadata.

    Raises:
        InputError: pyarrow is not installed.
    """
    import numpy as np  # noqa: PLC0415 - takes long to load, and not all need it

    pa = extras.need("pyarrow")
    arrays = {name: np.asarray(data) for name, data in columns.items()}
    fields = [
        pa.field(name, pa.from_numpy_dtype(data.dtype), metadata={"unit": units.get(name, "")})
        for name, data in arrays.items()
    ]
    schema = pa.schema(fields, metadata={ABOUT: json.dumps(about, sort_keys=True)})
    return pa.table([_column(pa, data) for data in arrays.values()], schema=schema)


def _column(pa: Any, data: Any) -> Any:
    """Numbers go without `pa.array`, which loads pandas wherever that is installed; bits and other orders need it."""
    if data.dtype.kind not in "fiu" or not data.dtype.isnative or data.ndim != 1:
        return pa.array(data)
    buffer = pa.py_buffer(data if data.flags.c_contiguous else data.copy())
    return pa.Array.from_buffers(pa.from_numpy_dtype(data.dtype), data.size, [None, buffer])


def frame(columns: Mapping[str, Any], units: Mapping[str, str], about: Mapping[str, Any]) -> Any:
    """A pandas.DataFrame whose `attrs` have `units` by column and `about`.

    Raises:
        InputError: pandas is not installed.
    """
    made = extras.need("pandas").DataFrame(dict(columns))
    made.attrs = {"units": dict(units), "about": dict(about)}
    return made
