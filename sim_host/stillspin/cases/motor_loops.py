"""How fast a motor's control loops may be: against their periods, against each other, against what swings by itself."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable

import numpy as np

from stillspin.cases.motor_told import PERIOD, Described, Finding

_SPEED_PERIOD = 1e-3  # s
_MARGIN_LEAST = 30.0  # degrees
_SWING_LEAST = 2.0  # times the frequency at which EMF, inductance and inertia swing
_APART_LEAST = 5.0  # times the speed loop's crossing
_CORNER_MOST = 0.5  # of a step
_PI, _MACHINE_CORNER = 1, 1  # speed_law, current_corner


def current(motor: Described) -> Finding:
    """The current loop against its period, with the inductance that is left at the limit of the current."""
    told, limit = motor.told("current_bandwidth"), motor.told("current_limit")
    margin = _current_margin(motor, told, limit)
    words = (
        f"current_bandwidth {told:.0f} rad/s is {_fastest(motor, told, limit):.0f} rad/s at {limit:.3g} A; the voltage"
        f" acts {1e6 * _delay(motor):.0f} µs behind the sample: {margin:.0f}° of phase are left, {_MARGIN_LEAST:.0f}°"
        " are needed"
    )
    if margin >= _MARGIN_LEAST:
        return Finding("current loop", True, words)
    slower = _most(told, lambda bandwidth: _current_margin(motor, bandwidth, limit))
    lower = _most(limit, lambda amperes: _current_margin(motor, told, amperes))
    remedy = f"lower current_bandwidth to {math.floor(slower)} rad/s"
    if slower < _SWING_LEAST * _own_swing(motor) and lower > 0.0:
        remedy = (
            f"lower current_limit to {math.floor(10.0 * lower) / 10.0:g} A; a current_bandwidth of {slower:.0f} rad/s"
            " is too slow for what swings by itself"
        )
    return Finding("current loop", False, f"{words}: {remedy}")


def _delay(motor: Described) -> float:
    return (3.0 + motor.told("current_divider")) / 2.0 * PERIOD  # s, control/current_controller.h


def _fastest(motor: Described, bandwidth: float, amperes: float) -> float:
    """The bandwidth at that current, rad/s: the plant's Lqq is Lq / (1 + (iq / 2 rated)^2)."""
    knee = 2.0 * motor.plant("machine", "rated_peak_current") if motor.plant("machine", "saturation") else math.inf
    return bandwidth * (1.0 + (amperes / knee) ** 2)


def _current_margin(motor: Described, bandwidth: float, amperes: float) -> float:
    """Phase that is left, degrees."""
    real = _fastest(motor, bandwidth, amperes)
    pole = motor.plant("machine", "resistance") / motor.plant("machine", "inductance_d")
    corner = pole if motor.told("current_corner") == _MACHINE_CORNER else max(bandwidth / 4.0, pole)
    corner = min(corner, _CORNER_MOST / (PERIOD * motor.told("current_divider")))
    return 90.0 - math.degrees(real * _delay(motor) + math.atan(corner / real) - math.atan(pole / real))


def _most(value: float, margin: Callable[[float], float]) -> float:
    """What leaves the phase that is needed, to a thousandth; less than that of the value where nothing does."""
    shares = (k / 1000.0 for k in range(1000, 0, -1))
    return next((value * share for share in shares if margin(value * share) >= _MARGIN_LEAST), 0.0)


def _own_swing(motor: Described) -> float:
    """Of the machine on a stiff voltage, rad/s: EMF, inductance and inertia make a spring."""
    flux = motor.plant("machine", "pole_pairs") * motor.plant("machine", "magnet_flux")
    inertia, inductance = motor.plant("mechanics", "inertia"), motor.plant("machine", "inductance_q")
    return flux * math.sqrt(1.5 / (inertia * inductance))


def swing(motor: Described) -> Finding:
    """The current loop against what swings by itself."""
    own = _own_swing(motor)
    loop = motor.told("current_bandwidth")
    words = f"EMF, inductance and inertia swing at {own:.0f} rad/s; current_bandwidth is {loop:.0f} rad/s"
    if loop < _SWING_LEAST * own:
        least = f"at least {_SWING_LEAST * own:.0f} rad/s are needed"
        return Finding("swing", False, f"{words}, {least}: raise it, or add inertia or a choke before the motor")
    return Finding("swing", True, f"{words}, {loop / own:.1f} times as fast; {_SWING_LEAST:.0f} times are needed")


def speed(motor: Described) -> Finding:
    """The speed loop against its period and the current loop; without the lag of the position's estimator."""
    crossing, margin = _crossing(motor)
    loop = motor.told("current_bandwidth")
    words = (
        f"the speed loop crosses at {crossing:.0f} rad/s, in steps of 1 ms, with {margin:.0f}° of phase left"
        f" ({_MARGIN_LEAST:.0f}° are needed); the current loop is {loop / crossing:.1f} times as fast"
        f" ({_APART_LEAST:.0f} times are needed)"
    )
    if margin >= _MARGIN_LEAST and loop >= _APART_LEAST * crossing:
        return Finding("speed loop", True, words)
    slower = (
        "lower speed_pi_bandwidth, raise speed_pi_damping"
        if motor.told("speed_law") == _PI
        else "lengthen speed_trajectory"
    )
    return Finding("speed loop", False, f"{words}: {slower}, tell the right inertia, or raise current_bandwidth")


def _crossing(motor: Described) -> tuple[float, float]:
    """Where the open loop's gain is one (rad/s), and the phase that is left there (degrees)."""
    frequency = np.geomspace(0.01, math.pi / _SPEED_PERIOD, 4000)
    gain = np.array([_open_loop(motor, item) for item in frequency])
    last = int(np.flatnonzero(np.abs(gain) >= 1.0)[-1]) if np.any(np.abs(gain) >= 1.0) else 0
    return float(frequency[last]), math.remainder(180.0 + math.degrees(cmath.phase(gain[last])), 360.0)


def _open_loop(motor: Described, frequency: float) -> complex:
    """Speed over speed error (control/speed_controller.h), the current loop as a lag of first order."""
    flux = 1.5 * motor.plant("machine", "pole_pairs") * motor.plant("machine", "magnet_flux")
    true = flux * _SPEED_PERIOD / motor.plant("mechanics", "inertia")
    told = 1.5 * motor.told("pole_pairs") * motor.told("magnet_flux") * _SPEED_PERIOD / motor.told("inertia")
    back = cmath.exp(-1j * frequency * _SPEED_PERIOD)  # by one step
    lag = 1.0 + 1j * frequency / motor.told("current_bandwidth")
    return true * back / (1.0 - back) / lag * _controller(motor, told, back)


def _controller(motor: Described, told: float, back: complex) -> complex:
    """A for each rad/s of error; `told` is the speed that an ampere adds in a step."""
    if motor.told("speed_law") == _PI:
        step = motor.told("speed_pi_bandwidth") * _SPEED_PERIOD
        return (2.0 * motor.told("speed_pi_damping") * step + step**2 / (1.0 - back)) / told
    weight = motor.told("speed_alpha") * told**2
    share = weight / (1.0 + weight)
    approach = 1.0 - math.exp(-1e3 * _SPEED_PERIOD / motor.told("speed_trajectory"))
    return share * approach / told / (1.0 - (1.0 - share) * back)
