"""Position error by speed: what it is while the speed reference stays where it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stillspin.core import Signals

Floats = npt.NDArray[np.float64]

SETTLE = 0.3
"""s after the reference has stopped moving that are left out."""

SHORTEST = 0.4
"""s that a stretch must last beyond that."""


@dataclass(frozen=True)
class Hold:
    """A stretch of constant reference (rpm): mean true speed (rpm), peak and rms of the position error (° el.)."""

    reference: float
    speed: float
    peak: float
    rms: float

    @property
    def followed(self) -> bool:
        """Whether the shaft turned as it was told: in the mean within 3 rpm, above 120 rpm within 2.5 %."""
        return abs(self.speed - self.reference) <= max(3.0, 0.025 * abs(self.reference))


def holds(signals: Signals, error: Floats) -> list[Hold]:
    """The stretches, in their order; of a run that broke off those that it finished.

    Args:
        signals: with `time`, `true_speed` and `speed_ref`.
        error: position error of every record, degrees el.
    """
    time = np.asarray(signals["time"], dtype=np.float64)
    reference = np.asarray(signals["speed_ref"], dtype=np.float64)
    speed = np.asarray(signals["true_speed"], dtype=np.float64)
    corners = np.flatnonzero(np.diff(reference) != 0.0) + 1
    found = []
    for first, last in zip([0, *corners.tolist()], [*corners.tolist(), time.size], strict=True):
        inside = np.flatnonzero(time[first:last] >= time[first] + SETTLE) + first
        if not inside.size or time[inside[-1]] - time[inside[0]] < SHORTEST:
            continue
        part = error[inside]
        peak, rms = float(np.max(np.abs(part))), float(np.sqrt(np.mean(np.square(part))))
        found.append(Hold(float(reference[inside[-1]]), float(np.mean(speed[inside])), peak, rms))
    return found
