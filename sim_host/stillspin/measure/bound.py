"""The Cramér-Rao bound of the angle: what no estimator that is given the drive's windows can be better than.

The shaft's state is electrical angle (rad), speed (rad/s) and load acceleration (rad/s²). The torque is known, the load
a random walk. Each period the windows tell the information I about angle and speed (`told_angle`, `told_cross`,
`told_speed` of a record: conversion noise alone, true machine, see sim_host/bench/information.hpp). The bound of the
covariance, of the Bayesian kind, is then the recursion

    P⁻ = F P F' + Q,    P⁺ = P⁻ (1 + I P⁻)⁻¹

It holds for every unbiased estimator that knows the past but not the future, on average over loads that wander as Q
says. Q is what the observer itself expects of the load: `observer_load_rate` in 10 ms, at a crawl
`observer_load_quiet`. An estimator that expects less of the load than Q is better than the bound for as long as the
load obliges.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stillspin.core import Signals

Floats = npt.NDArray[np.float64]

PERIOD = 1e-4
"""s, of the PWM."""

CRAWL = 10.0
"""rpm up to which the load is expected to be quiet; from three times that speed on it is not."""

_WALK = 100.0
"""Periods in which the load changes by its rate."""


@dataclass(frozen=True)
class Expected:
    """What is expected of shaft and load.

    Attributes:
        acceleration: electrical acceleration per torque, rad/s² and N m.
        rate: change of the load in 10 ms, N m.
        quiet: the same at a crawl.
    """

    acceleration: float
    rate: float
    quiet: float

    @staticmethod
    def of(machine: Mapping[str, float], parameters: Mapping[str, float]) -> Expected:
        """From the true machine and the firmware parameters.

        Args:
            machine: with `pole_pairs` and `inertia` (kg m²).
            parameters: with `observer_load_rate` and `observer_load_quiet` (N m in 10 ms).

        Raises:
            ValueError: one of them is not known.
        """
        try:
            return Expected(
                machine["pole_pairs"] / machine["inertia"],
                parameters["observer_load_rate"],
                parameters["observer_load_quiet"],
            )
        except KeyError as missing:
            raise ValueError(f"the record does not tell {missing}") from missing

    def walk(self, speed: Floats) -> Floats:
        """Variance that the load's acceleration gains in a period, by shaft speed (rpm)."""
        crawl = 1.0 - np.clip((np.abs(speed) - CRAWL) / (2.0 * CRAWL), 0.0, 1.0)
        general, quiet = self.acceleration * self.rate, self.acceleration * min(self.quiet, self.rate)
        variance: Floats = (general**2 - crawl * (general**2 - quiet**2)) / _WALK
        return variance


def angle_bound(signals: Signals, expected: Expected) -> Floats:
    """Least standard deviation of the angle's error at each record, degrees el.

    It starts from 10°, 20 rad/s and 3 N m, which are forgotten within 0.1 s. Records further apart than a period stand
    for as many periods alike.

    Args:
        signals: with `time`, `true_speed`, `told_angle`, `told_cross`, `told_speed`.
        expected: what shaft and load are expected to do.

    Raises:
        ValueError: the record is without the windows' information.
    """
    if "told_angle" not in signals:
        raise ValueError("the record does not tell what the windows told")
    time = np.asarray(signals["time"], dtype=np.float64)
    repeat = max(1, round(float(np.median(np.diff(time))) / PERIOD)) if time.size > 1 else 1
    walk = expected.walk(np.asarray(signals["true_speed"], dtype=np.float64))
    columns = [np.asarray(signals[f"told_{name}"], dtype=np.float64).tolist() for name in ("angle", "cross", "speed")]
    state = _start(expected)
    found = np.empty(time.size)
    for row, (angle, cross, speed, gain) in enumerate(zip(*columns, walk.tolist(), strict=True)):
        for _ in range(repeat):
            state = _told(_moved(state, gain), angle, cross, speed)
        found[row] = state[0]
    degrees: Floats = np.degrees(np.sqrt(found))
    return degrees


# Covariance of angle, speed and load acceleration: aa, as, al, ss, sl, ll.
_Covariance = tuple[float, float, float, float, float, float]


def _start(expected: Expected) -> _Covariance:
    return math.radians(10.0) ** 2, 0.0, 0.0, 20.0**2, 0.0, (3.0 * expected.acceleration) ** 2


def _moved(p: _Covariance, walk: float) -> _Covariance:
    """A period later: F P F' + Q."""
    aa, as_, al, ss, sl, ll = p
    t, half = PERIOD, 0.5 * PERIOD * PERIOD
    # Rows of F P, F = [1 t t²/2; 0 1 t; 0 0 1].
    a0, a1, a2 = aa + t * as_ + half * al, as_ + t * ss + half * sl, al + t * sl + half * ll
    s1, s2 = ss + t * sl, sl + t * ll
    return a0 + t * a1 + half * a2, a1 + t * a2, a2, s1 + t * s2, s2, ll + walk


def _told(p: _Covariance, angle: float, cross: float, speed: float) -> _Covariance:
    """P (1 + I P)⁻¹ with the information I on angle and speed."""
    aa, as_, al, ss, sl, ll = p
    # M = 1 + I P over angle and speed.
    m00, m01 = 1.0 + angle * aa + cross * as_, angle * as_ + cross * ss
    m10, m11 = cross * aa + speed * as_, 1.0 + cross * as_ + speed * ss
    determinant = m00 * m11 - m01 * m10
    # I' = M⁻¹ I: what is new, so that P⁺ = P − P I' P.
    i00 = (m11 * angle - m01 * cross) / determinant
    i01 = (m11 * cross - m01 * speed) / determinant
    i11 = (m00 * speed - m10 * cross) / determinant

    def less(x: tuple[float, float], y: tuple[float, float]) -> float:
        return x[0] * (i00 * y[0] + i01 * y[1]) + x[1] * (i01 * y[0] + i11 * y[1])

    a, s, load = (aa, as_), (as_, ss), (al, sl)
    return (
        aa - less(a, a),
        as_ - less(a, s),
        al - less(a, load),
        ss - less(s, s),
        sl - less(s, load),
        ll - less(load, load),
    )
