"""How fast a motor's control loops may be: against their periods, against each other, against what swings by itself."""

from __future__ import annotations

import cmath
import math

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
    told = motor.told("current_bandwidth")
    delay = (3.0 + motor.told("current_divider")) / 2.0 * PERIOD  # control/current_controller.h
    limit = motor.told("current_limit")
    knee = 2.0 * motor.plant("machine", "rated_peak_current") if motor.plant("machine", "saturation") else math.inf
    real = told * (1.0 + (limit / knee) ** 2)  # the plant's Lqq is Lq / (1 + (iq / 2 rated)^2)
    pole = motor.plant("machine", "resistance") / motor.plant("machine", "inductance_d")
    corner = pole if motor.told("current_corner") == _MACHINE_CORNER else max(told / 4.0, pole)
    corner = min(corner, _CORNER_MOST / (PERIOD * motor.told("current_divider")))
    turned = math.atan(corner / real) - math.atan(pole / real)
    margin = 90.0 - math.degrees(real * delay + turned)
    words = (
        f"current_bandwidth {told:.0f} rad/s is {real:.0f} rad/s at {limit:.3g} A; the voltage acts"
        f" {1e6 * delay:.0f} µs behind the sample: {margin:.0f}° of phase are left, {_MARGIN_LEAST:.0f}° are needed"
    )
    if margin >= _MARGIN_LEAST:
        return Finding("current loop", True, words)
    most = math.radians(90.0 - _MARGIN_LEAST - math.degrees(turned)) / delay
    slower = told * most / real
    remedy = f"lower current_bandwidth to {slower:.0f} rad/s"
    if slower < _SWING_LEAST * _own_swing(motor) and most > told:
        remedy = (
            f"lower current_limit to {limit * math.sqrt((most - told) / (real - told)):.3g} A; a current_bandwidth of"
            f" {slower:.0f} rad/s is too slow for what swings by itself"
        )
    return Finding("current loop", False, f"{words}: {remedy}")


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
