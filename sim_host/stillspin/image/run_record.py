"""What a run on an image gives: true values of every period, and what the drive says of itself.

The image streams eight signals of one control interrupt every `RASTER`. True values are the plant's own, at the start
of that interrupt's period. Which period it was follows from the drive's time in the sample, and from when its last
octet came: the drive cannot have sent it earlier.
"""

from __future__ import annotations

import math
import struct
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin.counted import counted
from stillspin.drive.protocol import CONTROL_PERIOD
from stillspin.drive.table import Signal

RASTER = 50
"""Periods between two samples: eight signals are on the line at 115200 bit/s for 38 of them."""
_BEHIND = 40
"""Periods from the start of a sample's period to its last octet, at least; for 38 of them it is on the line."""

_TRUE = {
    **{"true_angle": "electrical_angle", "true_speed": "speed", "torque": "torque", "load_torque": "load_torque"},
    **{"i_a": "i_a", "i_b": "i_b", "i_c": "i_c", "true_i_d": "i_d", "true_i_q": "i_q", "v_dc": "link_voltage"},
    "true_load_angle": "load_angle",
}
"""Columns of a record, and what the board calls them."""
_TURN = 2.0 * math.pi
_STREAMED = {
    **{"state": ("state", 1.0), "est_angle": ("angle", _TURN), "est_speed": ("speed", 1.0)},
    **{"speed_ref": ("speed_reference", 1.0), "i_d_ref": ("current_d_reference", 1.0)},
    **{"i_q_ref": ("current_q_reference", 1.0), "deviation_q": ("deviation_q", 1.0)},
    "load_angle": ("load_angle", _TURN),
}
"""Columns, the drive's signals and the column's units in each of theirs."""


@dataclass
class Played:
    """As NativeResult, and `notes`: what differs from a native run, in words."""

    signals: Mapping[str, npt.NDArray[Any]]
    completed: bool
    reason: str
    faults: Sequence[tuple[float, str]] = ()
    waveform: Mapping[str, Mapping[str, npt.NDArray[Any]]] = field(default_factory=lambda: {"raster": {"time": _NONE}})
    stats: Mapping[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    sent: list[tuple[float, str]] = field(default_factory=list)
    """Seconds after power-on, and octets in hexadecimal digits."""


_NONE: npt.NDArray[Any] = np.empty(0)


@dataclass(frozen=True)
class _Sample:
    period: int  # in which its last octet came
    time_ms: int  # of the drive
    values: tuple[float, ...]


class RunRecord:
    """Fills as the run goes on."""

    def __init__(self) -> None:
        self.signals: list[Signal] = []
        """That are streamed, in their order."""
        self._truth: dict[str, array[float]] = {name: array("d") for name in _TRUE}
        self._samples: list[_Sample] = []

    def choose(self, there: Iterable[Signal]) -> list[str]:
        """What is streamed of the drive's signals; the names of those that it has not."""
        by_name = {signal.name: signal for signal in there}
        wanted = [by_name[name] for name, _ in _STREAMED.values() if name in by_name]
        missing = [name for name, _ in _STREAMED.values() if name not in by_name]
        # As many as there can be: how long a sample is on the line says when it was taken.
        self.signals = wanted + [wanted[0]] * len(missing)
        return missing

    def pass_period(self, truth: Mapping[str, float]) -> None:
        """A period has passed, at whose start this was true of the plant."""
        for name, column in self._truth.items():
            column.append(truth[_TRUE[name]])

    def take(self, body: bytes, period: int) -> None:
        """A sample whose last octet came in a period; what is none is left out."""
        form = f"<I{len(self.signals)}iB"
        if len(body) != struct.calcsize(form) or not self.signals:
            return
        time_ms, *raw, known = struct.unpack(form, body)
        pairs = zip(self.signals, raw, strict=True)
        self._samples.append(_Sample(period, time_ms, tuple(signal.to_user(value, known) for signal, value in pairs)))

    @property
    def state(self) -> int:
        """The drive's, of the last sample; 0 before there is one."""
        return int(self._samples[-1].values[0]) if self._samples else 0

    def rows(self, origin: int, end: int, *, has_drive: bool) -> tuple[dict[str, npt.NDArray[Any]], list[str]]:
        """Columns from a period on, and how well the instants of the samples are known, in words."""
        truth = {name: np.frombuffer(column, dtype=np.float64) for name, column in self._truth.items()}
        if not has_drive:
            at = np.arange(origin, end, RASTER)
            return {"time": (at - origin) * CONTROL_PERIOD, **{k: v[at - 1] for k, v in truth.items()}}, []
        arrived = np.array([sample.period for sample in self._samples])
        drive = np.array([sample.time_ms for sample in self._samples]) * 10
        offset = int(np.min(arrived - drive)) - _BEHIND
        at = drive + offset
        kept = at >= origin
        late = (arrived - at - _BEHIND)[kept]
        streamed = np.array([sample.values for sample in self._samples])[kept]
        at = at[kept]
        rows = {"time": (at - origin) * CONTROL_PERIOD, **{k: v[at - 1] for k, v in truth.items()}}
        places = {signal.name: place for place, signal in enumerate(self.signals)}
        for column, (name, scale) in _STREAMED.items():
            if name in places:
                rows[column] = streamed[:, places[name]] * scale
        return rows, _said_of_instants(late)


def _said_of_instants(late: npt.NDArray[Any]) -> list[str]:
    if not late.size or not late.any():
        return []
    return [
        f"{counted(int(np.count_nonzero(late)), 'sample', late.size)} of the drive can be dated only to within "
        f"{int(late.max())} periods of 100 µs: its background was late or its port busy"
    ]
