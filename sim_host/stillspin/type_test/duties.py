"""What is asked of a motor in its type test, in its own torque, speed and time.

Every duty is one run or more on the virtual drive. Loads come within the time that the rated torque takes to bring the
shaft to its rated speed, and one electrical time constant more: both are the motor's own.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from stillspin.campaign.duty import whole_periods
from stillspin.cases.scenario import Reached, Run
from stillspin.core import LoadPoint, Plant
from stillspin.type_test.ratings import Ratings

START, SLOW, LOAD = "start", "slow", "load"
REVERSAL, WEAKENING, FLYING, REST = "reversal", "weakening", "flying start", "rest"
DUTIES = (START, SLOW, LOAD, REVERSAL, WEAKENING, FLYING, REST)
"""Kinds of duties, in their order."""
ANGLES, FEW = 24, 6
_SLOW = (0.005, 0.05)  # of the rated speed, under the rated torque
_LOADED = (0.0, 0.1, 0.5, 1.0)
_TURNING = (-1.0, -0.5, -0.2, -0.05, 0.05, 0.2, 0.5, 1.0)
_WEAKENED = 1.5  # of the rated speed, where the drive may weaken so far; less than 1.1 is none
_STARTED = 0.1  # of the rated speed: what a start has to reach
_BAND, _BAND_LEAST = 0.1, 0.005  # of the speed, but no narrower than so much of the rated one
_BEGIN, _HELD, _SETTLE = 0.1, 0.3, 0.4  # s
_HOLD_TIME = 100.0  # ms, beside a brake that opens
_STICKS = 1.5  # of the cogging, which alone would turn a free shaft
_REST = 30.0  # s
_RECORD = 10  # PWM periods: 1 ms


@dataclass(frozen=True)
class Duty:
    """One run. kind: of DUTIES; of: which of its kind, for people; load: share of the rated torque that comes."""

    kind: str
    of: str
    run: Run
    load: float | None = None


def duties(rated: Ratings, angles: int = ANGLES) -> Iterator[Duty]:
    """All that can be asked of a motor: without saliency nothing below `slowest`, where it knows no angle."""
    yield from _starts(rated, angles)
    for share in _SLOW:
        if rated.speed * share >= rated.slowest:
            yield _held(rated, SLOW, share)
    for share in _LOADED:
        if rated.speed * share >= rated.slowest:
            yield _held(rated, LOAD, share)
    yield _through_zero(rated)
    top = min(_WEAKENED * rated.speed, rated.fastest)
    if top > 1.1 * rated.speed:
        yield Duty(WEAKENING, f"{top / rated.speed:.0%}", _to(rated, "weakening", top))
    for share in _TURNING:
        if abs(share) * rated.speed >= rated.slowest:
            yield _caught(rated, share)
    if rated.slowest == 0.0:
        yield Duty(REST, f"{_REST:.0f} s", _standing(rated))


def _starts(rated: Ratings, angles: int) -> Iterator[Duty]:
    """A shaft that is free, and one whose brake opens when the start is over and leaves it to a load.

    A current vector turns the shaft the way that it is commanded when it starts.
    """
    command = max(_STARTED * rated.speed, 1.5 * rated.slowest)
    half = 0.5 * rated.load_at(0.0)
    ways = (-half, 0.0, half) if rated.saturates and not rated.slowest else (0.0,)
    for turn, sign, load in itertools.product(range(angles), (1.0, -1.0), ways):
        angle = 360.0 * turn / angles
        words = f"{angle:g}°, {'forward' if sign > 0 else 'backward'}"
        words += f", {load / rated.torque:+.0%} load" if load else ""
        yield Duty(START, words, _start(rated, angle, sign * command, load))


def _start(rated: Ratings, angle: float, command: float, load: float) -> Run:
    sticks = _STICKS * rated.cogging
    shaft: Plant = {"mechanics": {"brake_until_run": True} if load else _dry(sticks)}
    return _run(
        "start",
        _up(rated, command),
        ((0.0 if rated.slowest else _BEGIN, command),),
        load=((0.0, load), (1.0, load)) if load else (),
        plant={"initial": {"angle": math.radians(angle)}, **shaft},
        parameters={"hold_time": _HOLD_TIME} if load else {},
        reached=(_within(rated, command, _up(rated, command)),),
    )


def _dry(sticks: float) -> dict[str, float | bool | str]:
    return {"coulomb_friction": sticks, "stiction": sticks}


def _held(rated: Ratings, kind: str, share: float) -> Duty:
    """The rated torque, or what the drive says that it can bear there, comes at a speed, stays, and goes."""
    torque = rated.load_at(share * rated.speed)
    speed, rise = share * rated.speed, max(rated.run_up + rated.electrical, 0.005)
    at = _up(rated, speed) - _HELD
    gone = at + rise + _SETTLE + _HELD
    load = ((at, 0.0), (at + rise, torque), (gone, torque), (gone + rise, 0.0))
    end = gone + rise + _SETTLE + _HELD
    loaded = Reached((whole_periods(at + rise + _SETTLE), whole_periods(gone)), _band(rated, speed))
    run = _run(
        f"{kind}_{share:g}",
        end,
        ((_BEGIN, speed),),
        load=tuple((whole_periods(when), round(pull, 9)) for when, pull in load),
        reached=(loaded, _within(rated, speed, end)),
    )
    return Duty(kind, f"{100.0 * share:g} %", run, torque / rated.torque)


def _through_zero(rated: Ratings) -> Duty:
    back = _up(rated, rated.speed)
    end = back + 2.0 * rated.speed / rated.ramp + rated.turn + _SETTLE + _HELD
    there = Reached((whole_periods(back - _HELD), whole_periods(back - 0.01)), _band(rated, rated.speed))
    commands = ((_BEGIN, rated.speed), (back, -rated.speed))
    reached = (there, _within(rated, -rated.speed, end))
    return Duty(REVERSAL, "rated speed", _run(REVERSAL, end, commands, reached=reached))


def _to(rated: Ratings, name: str, speed: float) -> Run:
    end = _up(rated, speed)
    return _run(name, end, ((_BEGIN, speed),), reached=(_within(rated, speed, end),))


def _caught(rated: Ratings, share: float) -> Duty:
    speed = share * rated.speed
    end = _SETTLE + _HELD
    plant: Plant = {"initial": {"speed": speed * math.pi / 30.0}}
    run = _run("flying", end, ((0.0, speed),), plant=plant, reached=(_within(rated, speed, end),))
    return Duty(FLYING, f"{100.0 * share:+g} %", run)


def _standing(rated: Ratings) -> Run:
    stands = Reached((_SETTLE, _REST), _band(rated, 0.0), 0.0)
    return _run(REST, _REST, ((_BEGIN, 0.0),), reached=(stands,))


def _up(rated: Ratings, speed: float) -> float:
    return whole_periods(_BEGIN + abs(speed) / rated.ramp + rated.turn + _SETTLE + _HELD)


def _within(rated: Ratings, speed: float, end: float) -> Reached:
    return Reached((whole_periods(end - _HELD), whole_periods(end)), _band(rated, speed), speed)


def _band(rated: Ratings, speed: float) -> float:
    return max(_BAND * abs(speed), _BAND_LEAST * rated.speed)


def _run(
    name: str,
    duration: float,
    commands: tuple[tuple[float, float], ...],
    *,
    load: tuple[LoadPoint, ...] = (),
    plant: Plant | None = None,
    parameters: dict[str, float | str] | None = None,
    reached: tuple[Reached, ...] = (),
) -> Run:
    return Run(
        name=name,
        title="",
        duration=whole_periods(duration),
        max_start=5.0,
        commands=tuple((whole_periods(at), "speed_ref_rpm", round(speed, 6)) for at, speed in commands),
        load=load,
        parameters=parameters or {},
        plant={"solver": {"method": "rk4"}, **(plant or {})},
        reached=reached,
        record_every=_RECORD,
    )
