"""Figures of the stator-flux sources: load angle, currents fed back, magnet flux, lowest stable speed.

`beside` means the method that looks on while the encoder has the shaft (`flux_beside`), whose angle is recorded as that
of the high-speed estimator.
"""

from __future__ import annotations

import itertools

import numpy as np

from stillspin.measure import speed_profile
from stillspin.measure.pieces import Floats, Piece, as_floats

LOST = 45.0
"""° el.: beyond it a position is none; the torque of a current has lost a third, and soon changes its sign."""


def _wrapped(radians: Floats) -> Floats:
    wrapped: Floats = np.remainder(radians + np.pi, 2.0 * np.pi) - np.pi
    return wrapped


def _signal(piece: Piece, name: str) -> Floats:
    return as_floats(piece.signals[name])


def _angle_error(piece: Piece, name: str) -> Floats:
    """True minus estimated electrical angle, rad."""
    return _wrapped(_signal(piece, "true_angle") - _signal(piece, name))


def _peak(values: Floats) -> float:
    return float(np.max(np.abs(values)))


def load_angle_error_peak(piece: Piece) -> float:
    """Largest error of the load angle (stator flux before the d-axis), degrees el."""
    return float(np.degrees(_peak(_wrapped(_signal(piece, "true_load_angle") - _signal(piece, "load_angle")))))


def beside_position_error_peak(piece: Piece) -> float:
    """Largest position error of the method beside, degrees el."""
    return float(np.degrees(_peak(_angle_error(piece, "angle_avv"))))


def _current_error(piece: Piece, name: str) -> tuple[Floats, Floats]:
    """What an angle makes of the true current, less the true current: d and q (A)."""
    error = _angle_error(piece, name)
    d, q = _signal(piece, "true_i_d"), _signal(piece, "true_i_q")
    return d * (np.cos(error) - 1.0) - q * np.sin(error), q * (np.cos(error) - 1.0) + d * np.sin(error)


def current_d_error_peak(piece: Piece) -> float:
    """Largest error of the d-axis current fed back, by the angle in use, A."""
    return _peak(_current_error(piece, "est_angle")[0])


def current_q_error_peak(piece: Piece) -> float:
    """Largest error of the q-axis current fed back, by the angle in use, A."""
    return _peak(_current_error(piece, "est_angle")[1])


def beside_current_d_error_peak(piece: Piece) -> float:
    """Largest error of the d-axis current by the angle of the method beside, A."""
    return _peak(_current_error(piece, "angle_avv")[0])


def beside_current_q_error_peak(piece: Piece) -> float:
    """Largest error of the q-axis current by the angle of the method beside, A."""
    return _peak(_current_error(piece, "angle_avv")[1])


def _stable(piece: Piece) -> list[speed_profile.Hold]:
    """The speeds held in turn, up to where the shaft no longer follows or the position is lost (45°)."""
    error = np.degrees(_angle_error(piece, "est_angle"))
    held = speed_profile.holds(piece.signals, error)
    return list(itertools.takewhile(lambda hold: hold.followed and hold.peak <= LOST, held))


def lowest_stable_speed(piece: Piece) -> float:
    """Lowest speed held, up to where the shaft no longer follows or the position is lost (45°), rpm."""
    return min((abs(hold.reference) for hold in _stable(piece)), default=float("inf"))


def stable_position_error_peak(piece: Piece) -> float:
    """Largest position error at the speeds held before the shaft no longer follows or is lost, degrees el."""
    return max((hold.peak for hold in _stable(piece)), default=float("inf"))


def magnet_detection_error(piece: Piece) -> float:
    """Magnet flux as learnt, mean of the last 0.1 s, against the true one, percent of the nameplate's."""
    learnt = float(np.mean(_signal(piece.last(0.1), "magnet_flux")))
    machine = piece.extras.machine
    return 100.0 * abs(learnt - machine["magnet_flux"]) / machine["nameplate_magnet_flux"]


def limit_flux(piece: Piece) -> tuple[Floats, Floats, Floats]:
    """Current (A) of every record, its stator flux by (33) and the limit of (23) for the root of (27), in Vs.

    Currents are the firmware's references; without any they are left out.
    """
    machine = piece.extras.machine
    ld, lq, magnet = (machine[f"nameplate_{key}"] for key in ("inductance_d", "inductance_q", "magnet_flux"))
    d, q = _signal(piece, "i_d_ref"), _signal(piece, "i_q_ref")
    current = np.hypot(d, q)
    flux = np.hypot(magnet + ld * d, lq * q)
    limit = np.hypot(lq * magnet / np.sqrt(lq**2 - ld**2), lq * current)
    return current, flux, limit


def flux_limit_share(piece: Piece) -> float:
    """Stator flux of the reference currents over the largest that (27) has a root for, percent."""
    _, flux, limit = limit_flux(piece)
    return 100.0 * float(np.max(flux / limit))


FUNCTIONS = (
    load_angle_error_peak,
    beside_position_error_peak,
    current_d_error_peak,
    current_q_error_peak,
    beside_current_d_error_peak,
    beside_current_q_error_peak,
    lowest_stable_speed,
    stable_position_error_peak,
    magnet_detection_error,
    flux_limit_share,
)
