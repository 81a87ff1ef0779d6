"""The part of a run that a figure of merit looks at: the records of a window, and what was commanded there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin.cases.scenario import Run, Window
from stillspin.core import Signals, Waveform
from stillspin.measure import waveforms

Floats = npt.NDArray[np.float64]

LAST_SECOND = 1.0


@dataclass(frozen=True)
class Extras:
    """What is known of a run beside its records.

    Attributes:
        waveform: the stretch that was looked into, empty where there was none.
        machine: true data of machine and devices, see deviation_sweep.py and bound.py.
        observer: firmware parameters of the observer, see bound.py.
    """

    waveform: Waveform = field(default_factory=dict)
    machine: Mapping[str, float] = field(default_factory=dict)
    observer: Mapping[str, float] = field(default_factory=dict)


NOTHING_ELSE = Extras()


@dataclass(frozen=True)
class Piece:
    """What a metric sees: the records of one window, and what was commanded in it.

    Attributes:
        signals: equally long arrays; `time` in s.
        command: commanded speed (rpm) at each record.
        initial: commanded speed (rpm) just before the window: where a step comes from.
        target: commanded speed (rpm) at the end of the window: where it goes to.
        extras: what else is known of the run; its waveform is cut to the window.
    """

    signals: Signals
    command: Floats
    initial: float
    target: float
    extras: Extras = NOTHING_ELSE

    @property
    def time(self) -> Floats:
        """Times of the records (s)."""
        return as_floats(self.signals["time"])

    @property
    def speed(self) -> Floats:
        """True shaft speed (rpm)."""
        return as_floats(self.signals["true_speed"])

    def last(self, seconds: float = LAST_SECOND) -> Piece:
        """The last part of the piece."""
        return self._part(self.time >= self.time[-1] - seconds)

    def _part(self, mask: npt.NDArray[np.bool_]) -> Piece:
        return replace(
            self, signals={name: data[mask] for name, data in self.signals.items()}, command=self.command[mask]
        )


def as_floats(data: npt.NDArray[Any]) -> Floats:
    """The array in double precision."""
    return np.asarray(data, dtype=np.float64)


def cut(signals: Signals, run: Run, window: Window, extras: Extras = NOTHING_ELSE) -> Piece:
    """The part of a run in a window.

    Args:
        signals: recorded signals of the run.
        run: for its commands.
        window: first and last time (s); a record at the first belongs to it, one at the last does not (there the next
            command begins).
        extras: what else is known of the run.

    Raises:
        ValueError: the record does not cover the window.
    """
    time = as_floats(signals["time"])
    first, last = window
    step = float(np.median(np.diff(time))) if time.size > 1 else 0.0
    # The records may start and end up to one record away from the window's corners.
    if time.size < 2 or time[0] > first + 1.5 * step or time[-1] < last - 1.5 * step:
        raise ValueError(f"the record does not cover the window {first:g} … {last:g} s")
    mask = (time > first - 0.25 * step) & (time < last - 0.25 * step)
    inside = {name: data[mask] for name, data in signals.items()}
    before = run.speed_command(np.array([np.nextafter(first, -np.inf)]))[0]
    command = run.speed_command(time[mask])
    looked = replace(extras, waveform=waveforms.cut(extras.waveform, window))
    return Piece(inside, command, float(before), float(command[-1]), looked)


def wrap_degrees(radians: Floats) -> Floats:
    """Angles in degrees, wrapped to −180 … 180."""
    wrapped: Floats = np.degrees(np.remainder(radians + np.pi, 2.0 * np.pi) - np.pi)
    return wrapped
