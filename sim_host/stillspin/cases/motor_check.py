"""What will work with a motor's file and what will not.

Said by the drive's own rules, by physics where it has none, and by a start of the virtual drive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from stillspin import core
from stillspin.cases.profile import Profile
from stillspin.entry import Entry
from stillspin.errors import InputError

_PERIOD = 1e-4  # s, of the control interrupt
_TURN_LEAST = 12.0  # control interrupts per electrical turn
_SALIENCY_LEAST = 0.02


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at; `words` are for people."""

    title: str
    works: bool
    words: str


class Described(Protocol):
    """A machine with its board, and what the drive is told of it."""

    def plant(self, section: str, key: str) -> float:
        """What the machine and its board are, in SI units."""
        ...

    def told(self, name: str) -> float:
        """A parameter of the drive, in its own unit."""
        ...


@dataclass(frozen=True)
class Motor:
    """A motor with what the drive is told of it, in SI units where the plant has them."""

    profile: Profile
    schema: core.Schema
    known: Mapping[str, Entry]

    def plant(self, section: str, key: str) -> float:
        """An entry of the plant."""
        return float(self.profile.plant.get(section, {}).get(key, self.schema[section][key].default))

    def told(self, name: str) -> float:
        """A parameter of the drive, in its own unit."""
        return float(self.profile.parameters.get(name, self.known[name].default))


def findings(motor: Motor, native: core.NativeCore) -> list[Finding]:
    """Everything that was looked at; where the drive takes the parameters a start is tried, too."""
    ranges = _ranges(motor)
    held = [rules(motor.profile.parameters, native)] if all(finding.works for finding in ranges) else []
    start = [tried(motor.profile, motor.told("speed_limit"), native)] if held and held[0].works else []
    return [*ranges, *held, *physics(motor), *start]


def physics(motor: Described) -> list[Finding]:
    """What follows from the numbers alone."""
    return [look(motor) for look in (_saliency, _ripple, _polarity, _speed, _emf_of_a_trip, _turn)]


def _ranges(motor: Motor) -> list[Finding]:
    """Which values the drive's parameters cannot hold."""
    wrong = []
    for name, value in motor.profile.parameters.items():
        try:
            core.parameter(motor.known, name, value, name)
        except InputError as error:
            wrong.append(Finding("range", False, str(error)))
    total = len(motor.profile.parameters)
    return wrong or [Finding("range", True, f"all {total} values are within the ranges of the drive's parameters")]


def rules(parameters: Mapping[str, float], native: core.NativeCore) -> Finding:
    """Whether the drive takes the parameters together."""
    try:
        native.check_parameters(dict(parameters))
    except ValueError as error:
        return Finding("drive's rules", False, str(error).removeprefix("firmware parameters: "))
    return Finding("drive's rules", True, "the drive takes the parameters together")


def _saliency(motor: Described) -> Finding:
    d, q = motor.plant("machine", "inductance_d"), motor.plant("machine", "inductance_q")
    share = (q - d) / (q + d)
    if share < _SALIENCY_LEAST:
        words = f"Lq and Ld differ by {share:.1%} of their sum: no start from standstill by saliency"
        return Finding("start at rest", False, f"{words}; start_method = 1 turns the shaft by a current first")
    limit = motor.told("current_limit")
    words = f"(Lq − Ld)/(Lq + Ld) is {share:.1%} without current"
    if not motor.plant("machine", "saturation"):
        return Finding("start at rest", True, words)
    # The plant's Lqq is Lq / (1 + (iq / 2 rated)^2).
    end = 2.0 * motor.plant("machine", "rated_peak_current") * math.sqrt(q / d - 1.0)
    if end < limit:
        words += f", and gone from {end:.3g} A on; current_limit is {limit:.3g} A"
        return Finding("start at rest", False, f"{words}: choose current_limit below {0.9 * end:.3g} A")
    return Finding("start at rest", True, f"{words}, and there up to {end:.3g} A; current_limit is {limit:.3g} A")


def _ripple(motor: Described) -> Finding:
    """A pulse of a vector, 2/3 of the link at the motor, over the smaller inductance."""
    volts = 2.0 / 3.0 * motor.plant("link", "source_voltage")
    ripple = volts * motor.told("pulse_time") * 1e-6 / motor.plant("machine", "inductance_d")
    trip, peak = motor.told("trip_current"), motor.told("current_limit") + ripple / 2.0
    pulse = f"a pulse of {motor.told('pulse_time'):g} µs changes the current by {ripple:.3g} A"
    words = f"{pulse}, up to {peak:.3g} A at current_limit; trip_current is {trip:.3g} A"
    if peak > trip:
        return Finding(
            "ripple", False, f"{words}: lower current_limit, shorten pulse_time, or put a choke before the motor"
        )
    return Finding("ripple", True, words)


def _polarity(motor: Described) -> Finding:
    """Whether the link drives the test's current through the winding at all, and in what time."""
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0)
    resistance, inductance = motor.plant("machine", "resistance"), motor.plant("machine", "inductance_d")
    wanted, possible = min(motor.told("start_current"), motor.told("current_limit")), volts / resistance
    words = f"the polarity test asks for {wanted:.3g} A; the link drives up to {possible:.3g} A"
    if possible < wanted:
        return Finding("polarity", False, f"{words}: lower start_current, or raise the link's voltage")
    rise = -inductance / resistance * math.log1p(-wanted / possible) if wanted < possible else math.inf
    return Finding("polarity", True, f"{words} and is there after {1e3 * rise:.2g} ms")


def _speed(motor: Described) -> Finding:
    """The speed that the link and field weakening allow without load."""
    volts = motor.plant("link", "source_voltage") / math.sqrt(3.0) * motor.told("voltage_use") / 100.0
    flux = motor.plant("machine", "magnet_flux")
    weakened = max(flux - motor.plant("machine", "inductance_d") * motor.told("weakening_limit"), 1e-9)
    pairs, limit = motor.plant("machine", "pole_pairs"), motor.told("speed_limit")
    base, fastest = (volts / linked / pairs * 30.0 / math.pi for linked in (max(flux, 1e-9), weakened))
    words = f"the EMF takes the link's voltage at {base:.0f} rpm, with weakening_limit at {fastest:.0f} rpm"
    if fastest < limit:
        return Finding("top speed", False, f"{words}; speed_limit is {limit:.0f} rpm")
    return Finding("top speed", True, f"{words}; speed_limit is {limit:.0f} rpm")


def _emf_of_a_trip(motor: Described) -> Finding:
    """What the diodes charge the link to when the gates go off at the speed limit."""
    speed = motor.told("speed_limit") * math.pi / 30.0
    volts = math.sqrt(3.0) * motor.plant("machine", "magnet_flux") * motor.plant("machine", "pole_pairs") * speed
    most = motor.told("link_maximum")
    words = (
        f"with the gates off at speed_limit the motor charges the link to {volts:.0f} V; link_maximum is {most:.0f} V"
    )
    return Finding("gates off", volts <= most, words)


def _turn(motor: Described) -> Finding:
    limit, pairs = motor.told("speed_limit"), motor.plant("machine", "pole_pairs")
    steps = 60.0 / (limit * pairs * _PERIOD)
    words = f"an electrical turn at speed_limit has {steps:.0f} control interrupts"
    if steps < _TURN_LEAST:
        most = 60.0 / (_TURN_LEAST * pairs * _PERIOD)
        return Finding(
            "periods per turn", False, f"{words}; {_TURN_LEAST:.0f} are needed: speed_limit up to {most:.0f} rpm"
        )
    return Finding("periods per turn", True, words)


def tried(chosen: Profile, speed_limit: float, native: core.NativeCore) -> Finding:
    """A start and a run-up of the virtual drive without load, to a tenth of `speed_limit`, rpm."""
    target = round(0.1 * speed_limit)
    title = "tried"
    try:
        result = native.run(
            plant=chosen.plant,
            parameters=dict(chosen.parameters),
            commands=[(0.2, "speed_ref_rpm", float(target))],
            load=[],
            duration=2.0,
            max_start=5.0,
            record_every=10,
            waveform=(0.0, 0.0, 1),
            seed=1,
            progress=None,
        )
    except (RuntimeError, ValueError) as error:
        return Finding(title, False, f"the virtual drive does not run with it: {' '.join(str(error).split())}")
    if not result.completed or result.faults:
        reason = result.faults[0][1] if result.faults else result.reason
        return Finding(title, False, f"a start of the virtual drive: {reason}")
    speed = float(result.signals["true_speed"][-1])
    off = math.remainder(float(result.signals["true_angle"][-1] - result.signals["est_angle"][-1]), 2.0 * math.pi)
    words = f"started, {speed:.0f} rpm of {target} rpm after 2 s, the angle off by {abs(math.degrees(off)):.1f}°"
    return Finding(title, abs(off) < math.radians(45.0) and abs(speed - target) < 0.1 * target + 20.0, words)
