"""The q-axis current deviation over a deliberate angle error (Fig. 9 of the paper), against what the machine gives.

At rest and with i_q = 0, eqs (20) to (24) give D = Kq ½ sin 2θ̃ with Kq = R (Ld − Lq) i_d* / (Ld Lq), θ̃ the true minus
the used angle. Two more things act in a real drive. The devices' drops act on the motor during a zero vector like R i
does; the drive takes off what they do in the q-axis near zero error, and the rest is taken off here, with the true
drops. And that part of i_d* which lies in the true q-axis saturates: this is in the derived curve (plant/machine.hpp
has the map).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin.core import Signals

Floats = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

BIN = 5.0
"""Width of the bins over which D is averaged, degrees el."""

REACH = 90.0
"""The sweep goes so far to both sides, degrees el."""


@dataclass(frozen=True)
class Sweep:
    """Mean deviation by angle error.

    Attributes:
        error: mean error in each bin, degrees el.
        raw: mean D in it as the drive has it, A/s; deviation: the same with the drops taken off.
        derived: what the true machine gives there without drops, A/s; empty without its data.
        sine: the part of the deviation that goes with sin 2θ̃, A/s.
    """

    error: Floats
    raw: Floats
    deviation: Floats
    derived: Floats
    sine: Floats

    @property
    def gain(self) -> float:
        """Fitted over derived gain: the factor by which the derived curve fits the deviation best."""
        return float(self.deviation @ self.derived / (self.derived @ self.derived))


def sweep(error: Floats, signals: Signals, machine: Mapping[str, float]) -> Sweep:
    """Averages and fits.

    Args:
        error: position error of every record, degrees el.
        signals: with `deviation_q`, `i_d_ref` and `est_angle`.
        machine: true data, see `derived`; may be empty.

    Raises:
        ValueError: the sweep does not cover ±90°.
    """
    edges = np.arange(-REACH, REACH + BIN / 2.0, BIN)
    place = np.digitize(error, edges) - 1
    inside = (place >= 0) & (place < edges.size - 1)
    count = np.bincount(place[inside], minlength=edges.size - 1)
    if np.any(count == 0):
        raise ValueError(f"the angle error does not sweep ±{REACH:g}°")

    def mean(values: npt.NDArray[Any]) -> Floats:
        total = np.bincount(place[inside], np.asarray(values, np.float64)[inside], edges.size - 1)
        means: Floats = total / count
        return means

    middle, raw = mean(error), mean(signals["deviation_q"])
    deviation, known = raw, np.zeros(0)
    if machine:
        known = mean(derived(np.radians(error), signals, {**machine, "device_drop": 0.0}))
        deviation = raw - mean(derived(np.radians(error), signals, machine)) + known
    twice = np.sin(np.radians(2.0 * middle))
    return Sweep(middle, raw, deviation, known, float(deviation @ twice / (twice @ twice)) * twice)


def derived(error: Floats, signals: Signals, machine: Mapping[str, float]) -> Floats:
    """D of the true machine at rest with i_q = 0, A/s.

    Args:
        error: true minus used angle, rad.
        signals: with `i_d_ref` and `est_angle`.
        machine: `resistance` (ohm, with one device), `device_drop` (V), `inductance_d` and `inductance_q` (H),
            `cross_saturation` (H/A), `knee` (A, 0 where nothing saturates).
    """
    current = np.asarray(signals["i_d_ref"], dtype=np.float64)
    used = np.asarray(signals["est_angle"], dtype=np.float64)
    # The drops follow the signs of the phase currents: a vector of 4/3 of one drop in the middle of the 60° in which
    # the current lies.
    direction = used + np.where(current < 0.0, np.pi, 0.0)
    sector = np.round(direction / (np.pi / 3.0)) * (np.pi / 3.0)
    drop = 4.0 / 3.0 * machine["device_drop"] * np.exp(1j * (sector - used))
    volts: Complex = -(machine["resistance"] * current + drop)
    turn: Complex = np.exp(-1j * error)
    slope = _slope(current * turn, volts * turn, machine) / turn
    found: Floats = slope.imag - volts.imag / machine["inductance_q"]
    return found


def _slope(current: Complex, volts: Complex, machine: Mapping[str, float]) -> Complex:
    """di/dt in the rotor frame: inverse of the incremental inductances times the voltage."""
    knee = machine["knee"]
    lqq = machine["inductance_q"] / (1.0 + (np.square(current.imag / knee) if knee > 0.0 else 0.0))
    lqq = lqq + machine["cross_saturation"] * current.real
    ldd, ldq = machine["inductance_d"], machine["cross_saturation"] * current.imag
    determinant = ldd * lqq - np.square(ldq)
    d = (lqq * volts.real - ldq * volts.imag) / determinant
    q = (ldd * volts.imag - ldq * volts.real) / determinant
    found: Complex = d + 1j * q
    return found


def gain(current: float, machine: Mapping[str, float]) -> float:
    """Kq (24) of the true machine, A/s per rad."""
    ld, lq = machine["inductance_d"], machine["inductance_q"]
    return machine["resistance"] * current * (ld - lq) / (ld * lq)
