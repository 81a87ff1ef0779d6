"""Position error by speed: what the error is while the command stays where it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stillspin import metrics
from stillspin.core import Signals
from stillspin.scenario import Run

SETTLE = 0.2
"""s after a change of the command that are left out."""


@dataclass(frozen=True)
class Hold:
    """A stretch of constant command: mean true speed (rpm), peak and rms of the position error (degrees el.)."""

    speed: float
    peak: float
    rms: float


def holds(signals: Signals, run: Run) -> list[Hold]:
    """The stretches, in their order; of a run that broke off those that it finished."""
    time = metrics.as_floats(signals["time"])
    speed = metrics.as_floats(signals["true_speed"])
    error = metrics.position_error(signals)
    corners = [at for at, what, _ in run.commands if what == "speed_ref_rpm"] + [run.duration]
    found = []
    for first, last in zip(corners[:-1], corners[1:], strict=True):
        inside = (time >= first + SETTLE) & (time < last)
        if last > time[-1] + 0.01 or not np.any(inside):
            continue
        part = error[inside]
        found.append(
            Hold(float(np.mean(speed[inside])), float(np.max(np.abs(part))), float(np.sqrt(np.mean(np.square(part)))))
        )
    return found
