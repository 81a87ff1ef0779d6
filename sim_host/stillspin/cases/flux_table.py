"""Tables of a machine's flux over its currents, as other programs write them, and what one says of its nameplate.

The plant reads one form alone: lines of i_d, i_q (A), psi_d, psi_q (Vs), peak values, with the magnet along +d.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin import core, extras
from stillspin.errors import InputError

Columns = npt.NDArray[np.float64]
"""Rows of i_d, i_q, psi_d, psi_q."""

_NAMES = (
    ("Id", "Iq", "Fd", "Fq"),  # SyR-e
    ("id_map", "iq_map", "psid_map", "psiq_map"),  # the measured maps of motulator's examples
    ("i_d", "i_q", "psi_d", "psi_q"),
)
_COMPLEX = ("i_s_dq", "psi_s_dq")  # motulator
_MOST = 6561
"""Points that are kept of a finer table: 81 by 81, twice as fine as what the plant interpolates."""


@dataclass(frozen=True)
class Told:
    """What a table says at zero current.

    Attributes:
        inductance_d, inductance_q: H; magnet_flux, magnet_flux_q: Vs along d and across; misfit: Vs.
    """

    inductance_d: float
    inductance_q: float
    magnet_flux: float
    magnet_flux_q: float
    misfit: float


def told(path: str, native: core.NativeCore) -> Told:
    """Read a table as the plant does.

    Raises:
        InputError: it is not there, or no machine can have it; names the line or the currents.
    """
    try:
        return Told(**native.flux_map(path))
    except ValueError as error:
        raise InputError(str(error)) from error


def stated(plant: core.Plant, file: Path) -> core.Plant:
    """A motor's plant with its table found beside its file, and what follows from it where the file does not say it."""
    machine = plant.get("machine", {})
    name = machine.get("flux_map")
    if not name:
        return plant
    path = str((file.parent / str(name)).resolve())
    found = told(path, core.load())
    follows = {key: getattr(found, key) for key in ("inductance_d", "inductance_q", "magnet_flux")}
    return {**plant, "machine": {**follows, **machine, "flux_map": path}}


def read(path: Path) -> Columns:
    """A table of another program: .mat, .npz, or text of four columns.

    Raises:
        InputError: unreadable, or without the four quantities.
    """
    try:
        if path.suffix == ".mat":
            return _columns(extras.need("scipy.io").loadmat(path), path)
        if path.suffix == ".npz":
            with np.load(path) as file:
                return _columns({name: file[name] for name in file.files}, path)
        rows = np.genfromtxt(path, delimiter=",", comments="#")
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a table ({error})") from error
    rows = rows[~np.isnan(rows).any(axis=-1)] if rows.ndim == 2 else rows
    if rows.ndim != 2 or rows.shape[1] != 4:
        raise InputError(f"{path}: must have four columns, i_d, i_q in A and psi_d, psi_q in Vs")
    return np.asarray(rows, dtype=np.float64)


def _columns(found: Mapping[str, Any], path: Path) -> Columns:
    if all(name in found for name in _COMPLEX):
        current, flux = (np.asarray(found[name]).ravel() for name in _COMPLEX)
        return _whole(np.column_stack([current.real, current.imag, flux.real, flux.imag]))
    for names in _NAMES:
        if all(name in found for name in names):
            return _whole(np.column_stack(_on_one_grid([np.asarray(found[name], dtype=float) for name in names], path)))
    wanted = "; or ".join(", ".join(names) for names in (*_NAMES, _COMPLEX))
    there = ", ".join(sorted(name for name in found if not name.startswith("__")))
    raise InputError(f"{path}: has {there or 'nothing'}; must have {wanted}")


def _on_one_grid(tables: list[npt.NDArray[np.float64]], path: Path) -> list[npt.NDArray[np.float64]]:
    """Currents may be given as two axes: i_d along the columns, i_q along the rows."""
    shape = tables[2].shape
    if tables[0].size * tables[1].size == tables[2].size and tables[0].shape != shape:
        tables[:2] = np.meshgrid(tables[0].ravel(), tables[1].ravel())
    if any(table.shape != shape for table in tables):
        raise InputError(f"{path}: the tables are of different sizes: {', '.join(str(t.shape) for t in tables)}")
    return [table.ravel() for table in tables]


def _whole(rows: Columns) -> Columns:
    """Without points that were not measured, and not finer than is of use."""
    rows = rows[np.isfinite(rows).all(axis=1)]
    return rows[:: max(1, -(-len(rows) // _MOST))] if len(rows) > _MOST else rows


def along_d(rows: Columns) -> tuple[Columns, bool]:
    """The table with the magnet along +d, and whether it had to be turned.

    Those who call the axis of the larger inductance d have the magnet along -q.
    """
    nearest = rows[np.argmin(np.hypot(rows[:, 0], rows[:, 1]))]
    if abs(nearest[3]) <= abs(nearest[2]):
        return rows, False
    sign = -1.0 if nearest[3] < 0.0 else 1.0
    i_d, i_q, psi_d, psi_q = rows.T
    return np.column_stack([sign * i_q, -sign * i_d, sign * psi_q, -sign * psi_d]), True


def write(path: Path, rows: Columns, source: str) -> None:
    """As the plant reads it, in the order of the currents."""
    ordered = rows[np.lexsort((rows[:, 1], rows[:, 0]))]
    head = f"# from {source}\ni_d,i_q,psi_d,psi_q\n"
    lines = "\n".join(",".join(f"{x:.7g}" for x in row) for row in ordered)
    path.write_text(f"{head}{lines}\n", encoding="utf-8")
