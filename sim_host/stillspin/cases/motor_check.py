"""What will work with a motor's file and what will not.

Said by the drive's own rules, by physics where it has none, and by a start of the virtual drive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from stillspin import core
from stillspin.cases import motor_limits, motor_loops, motor_physics
from stillspin.cases.motor_told import Described, Finding, Motor
from stillspin.counted import counted
from stillspin.errors import InputError

_LOOKS = (
    motor_physics.saliency,
    motor_physics.ripple,
    motor_physics.polarity,
    motor_physics.speed,
    motor_physics.emf_of_a_trip,
    motor_physics.turn,
    motor_loops.current,
    motor_loops.swing,
    motor_loops.speed,
)


def findings(motor: Motor, native: core.NativeCore) -> list[Finding]:
    """Everything that was looked at; where the drive takes the parameters a start is tried, too."""
    ranges = _ranges(motor)
    held = [rules(motor.profile.parameters, native)] if all(finding.works for finding in ranges) else []
    start = [tried(motor, native)] if held and held[0].works else []
    return [*ranges, *held, *physics(motor), *start]


def physics(motor: Described) -> list[Finding]:
    """What follows from the numbers alone."""
    return [look(motor) for look in _LOOKS]


def _ranges(motor: Motor) -> list[Finding]:
    """Which values the drive's parameters cannot hold."""
    wrong = []
    for name, value in motor.profile.parameters.items():
        try:
            core.parameter(motor.known, name, value, name)
        except InputError as error:
            wrong.append(Finding("range", False, str(error)))
    total = len(motor.profile.parameters)
    return wrong or [
        Finding("range", True, f"all {counted(total, 'value')} are within the ranges of the drive's parameters")
    ]


def rules(parameters: Mapping[str, float], native: core.NativeCore) -> Finding:
    """Whether the drive takes the parameters together."""
    broken = motor_limits.conflict(native, parameters)
    if broken:
        ways = "; or ".join(
            motor_limits.ways_out(native, core.at_scale(core.parameters(native), parameters), parameters, broken)
        )
        return Finding("drive's rules", False, f"{broken}; {ways}" if ways else broken)
    return Finding("drive's rules", True, "the drive takes the parameters together")


def _target(motor: Described) -> int:
    """Speed to try, rpm: a tenth of the largest, and beyond the one to which a vector turns the shaft."""
    turned = 1.5 * motor.told("if_speed") if motor.told("start_method") == 1.0 else 0.0
    return round(max(0.1 * motor.told("speed_limit"), turned))


def tried(motor: Motor, native: core.NativeCore) -> Finding:
    """A start and a run-up of the virtual drive without load, to a tenth of `speed_limit` or what it starts with."""
    target = _target(motor)
    title = "tried"
    try:
        result = native.run(
            plant=motor.profile.plant,
            parameters=dict(motor.profile.parameters),
            commands=[(0.0, "speed_ref_rpm", float(target))],
            load=[],
            duration=2.0,
            max_start=8.0,
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
