"""Ripple of the currents and of the torque: known lines on a turning current vector."""

import numpy as np
import numpy.typing as npt
import pytest

from stillspin.core import Signals
from stillspin.measure import ripple

Floats = npt.NDArray[np.float64]

MACHINE = {
    "pole_pairs": 4.0,
    "flux_linkage": 0.155,
    "inductance_d": 0.0049,
    "inductance_q": 0.0081,
}
TURN = 2.0 * np.pi * 20.0
TIME: Floats = np.asarray(np.arange(50_000) * 1e-6, np.float64)


def raster(d: Floats, q: Floats) -> Signals:
    """Phase currents of a current vector in the rotor frame, which turns at 20 Hz."""
    angle = TURN * TIME
    vector = (d + 1j * q) * np.exp(1j * angle)
    phases = {name: np.real(vector * np.exp(-2j * np.pi * k / 3)) for k, name in enumerate(ripple.PHASES)}
    return {"time": TIME, "angle": np.mod(angle, 2.0 * np.pi), **phases}


def line(frequency: float, peak: float) -> Floats:
    """A sine."""
    return np.asarray(peak * np.sin(2.0 * np.pi * frequency * TIME), np.float64)


def test_torque_of_a_line_along_q_is_that_of_the_flux():
    seen = ripple.torque(raster(0.0 * TIME, 3.0 + line(5000.0, 0.8)), MACHINE)
    assert seen == pytest.approx(1.5 * 4.0 * 0.155 * 0.8 / np.sqrt(2.0), rel=1e-3)


def test_torque_of_a_line_along_d_is_that_of_the_saliency():
    seen = ripple.torque(raster(line(5000.0, 0.8), 3.0 + 0.0 * TIME), MACHINE)
    assert seen == pytest.approx(1.5 * 4.0 * 0.0032 * 3.0 * 0.8 / np.sqrt(2.0), rel=1e-3)


def test_what_is_slower_than_a_kilohertz_is_no_ripple():
    slow = raster(0.0 * TIME, 3.0 + line(400.0, 2.0))
    assert ripple.torque(slow, MACHINE) < 1e-3
    assert ripple.rms(slow, ripple.LOWEST, ripple.HIGHEST) < 2e-3


def test_rms_of_a_line_is_the_phases_mean():
    seen = ripple.rms(raster(0.0 * TIME, line(5000.0, 0.8)), ripple.LOWEST, ripple.AUDIBLE)
    assert seen == pytest.approx(0.8 / 2.0, rel=1e-2)  # a vector of 0.8 / sqrt 2 rms is 1 / sqrt 2 of that in a phase


def test_a_short_stretch_is_refused():
    short = {name: values[:5000] for name, values in raster(0.0 * TIME, 3.0 + line(5000.0, 0.8)).items()}
    with pytest.raises(ValueError, match="20 ms"):
        ripple.torque(short, MACHINE)
