"""The start-up matrix: every initial angle, both directions, loads, parameter errors, seeds; judged on the true shaft.

Three ways to start: `brake`, where a holding brake opens at the end of the start procedure and a load falls on the
shaft; `free`, an unloaded shaft with a little dry friction, without which cogging alone would turn it; `flying`, a
shaft that turns already. The drive knows the machine's nominal data and the map of its saturation as commissioning
would find it; the errors of a case change the plant behind its back.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from stillspin import core
from stillspin.cases import profile
from stillspin.core import NativeResult, Plant, Schema
from stillspin.errors import InputError, did_you_mean
from stillspin.measure.pieces import Floats
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

WAYS = ("brake", "free", "flying")
RATED_TORQUE = 11.0  # N m
BACKWARD_LIMIT = 2.0  # degrees mechanical
ANGLE_LIMIT = 60.0  # degrees electrical
ANGLES = 24
COMMAND = 300.0  # rpm
FLYING = (-3000.0, -2000.0, -1000.0, -300.0, -100.0, -60.0, -30.0, 30.0, 60.0, 100.0, 300.0, 1000.0, 2000.0, 3000.0)
_DRY_FRICTION = 0.15  # N m, half as much again as the cogging torque
_HOLD = 100.0  # ms
_COMMAND_AT = 0.1  # s after the start procedure
_DURATION = 0.45
_NAMES = ("resistance", "inductance_d", "inductance_q", "magnet_flux", "inertia")
_GROUPS: dict[str, tuple[str, ...]] = {
    "R": ("resistance",),
    "L": ("inductance_d", "inductance_q"),
    "flux": ("magnet_flux",),
    "J": ("inertia",),
    "all": _NAMES,
}
ERRORS: dict[str, dict[str, float]] = {
    "none": {},
    **{f"{name} {sign:+.0%}": dict.fromkeys(keys, sign) for name, keys in _GROUPS.items() for sign in (-0.3, 0.3)},
}


@dataclass(frozen=True)
class Case:
    """One start. `direction`: of the command; `load`: N m; `speed`: rpm at power-on."""

    way: str
    angle: float  # degrees electrical
    direction: int
    load: float
    error: str
    seed: int
    speed: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """What the true shaft did. `problem`: None when the start is a good one; `broken`: it did not come to its end."""

    case: Case
    problem: str | None
    backward: float = 0.0  # degrees mechanical against the direction commanded
    sigma: float = 0.0  # confidence in the polarity, standard errors
    angle_error: float = 0.0  # degrees electrical at the end of the start procedure
    start: float = 0.0  # s from the request to the end of the procedure
    broken: bool = False


@dataclass(frozen=True)
class Bench:
    """What all cases have in common."""

    plant: Plant
    parameters: dict[str, float]


def cases(seeds: int, quick: bool, linear: bool) -> Iterator[Case]:
    """All cases; `quick`: a representative few; `linear`: without those in which only saturation can tell."""
    angles = [360.0 * k / ANGLES for k in range(0, ANGLES, 5 if quick else 1)]
    errors = ["none", "flux -30%", "J -30%"] if quick else list(ERRORS)
    noise = range(1, 1 + (1 if quick else seeds))
    loads = [share * RATED_TORQUE for share in ((-0.5, 0.5) if quick else (-0.5, -0.25, 0.0, 0.25, 0.5))]
    both = (1, -1)
    if not linear:
        for angle, way, load, error, seed in itertools.product(angles, both, loads, errors, noise):
            yield Case("brake", angle, way, load, error, seed)
    for angle, way, error, seed in itertools.product(angles, both, errors, noise):
        yield Case("free", angle, way, 0.0, error, seed)
    speeds = [-3000.0, -60.0, 300.0] if quick else FLYING
    for angle, speed, error, seed in itertools.product(angles[:: 2 if quick else 3], speeds, errors, noise):
        yield Case("flying", angle, 1 if speed > 0 else -1, 0.0, error, seed, speed)


def chosen(items: Iterator[Case], ways: Sequence[str]) -> list[Case]:
    """The cases of some ways, or all.

    Raises:
        InputError: no such way, or none of its cases can be run on this profile.
    """
    for way in ways:
        if way not in WAYS:
            raise InputError(f"--way '{way}': there is no such way to start{did_you_mean(way, WAYS)}")
    kept = [case for case in items if not ways or case.way in ways]
    if not kept:
        raise InputError("--way brake: needs a profile with saturation, which alone tells the polarity of a held shaft")
    return kept


def bench(name: str) -> tuple[Bench, bool]:
    """Plant and parameters of a profile, the fast integrator, and whether the machine is linear."""
    native = core.load()
    schema = core.plant_schema(native)
    chosen = profile.load(name, schema, core.parameters(native))
    plant = profile.merged(chosen.plant, {"solver": {"method": "rk4"}})
    known = saturation_map(plant, schema)
    return Bench(plant, {**chosen.parameters, **known}), not known


def saturation_map(plant: Plant, schema: Schema) -> dict[str, float]:
    """The firmware's map parameters for the nominal machine of a plant; empty for a linear one."""

    def entry(key: str) -> float:
        return float(plant.get("machine", {}).get(key, schema["machine"][key].default))

    if not entry("saturation"):
        return {}
    rated, last = entry("rated_peak_current"), 14.0
    known = {"map_current": last}
    for k in range(1, 5):
        current = last * k / 4
        known[f"lqq_{k}"] = 100.0 / (1.0 + (current / (2.0 * rated)) ** 2)
        known[f"ldq_{k}"] = 1e3 * entry("cross_inductance") * current / rated
    return known


def sustained(common: Bench, case: Case) -> float:
    """The speed (rpm) that the machine of a case can hold without load: its EMF, weakened as far as the drive may."""
    native = core.load()
    schema, known = core.plant_schema(native), core.at_scale(core.parameters(native), common.parameters)

    def nominal(section: str, key: str) -> float:
        return float(common.plant.get(section, {}).get(key, schema[section][key].default))

    def true(key: str) -> float:
        return nominal("machine", key) * (1.0 + ERRORS[case.error].get(key, 0.0))

    def told(name: str) -> float:
        return float(common.parameters.get(name, known[name].default))

    voltage = nominal("link", "source_voltage") / math.sqrt(3.0) * told("voltage_use") / 100.0
    flux = true("magnet_flux") - true("inductance_d") * told("weakening_limit")
    fastest = voltage / max(flux, 1e-3) / nominal("machine", "pole_pairs")
    return fastest * 30.0 / math.pi


def run(common: Bench, case: Case) -> Outcome:
    """One start, judged."""
    held = case.way == "brake"
    own: Plant = {
        "initial": {"angle": math.radians(case.angle), "speed": case.speed * math.pi / 30.0},
        "mechanics": {"brake_until_run": held},
    }
    if case.way == "free":
        own["mechanics"] |= {"coulomb_friction": _DRY_FRICTION, "stiction": _DRY_FRICTION}
    if case.error != "none":
        own["parameter_error"] = {**dict.fromkeys(_NAMES, 0.0), **ERRORS[case.error]}
    fastest = sustained(common, case)
    target = (
        math.copysign(min(abs(case.speed), fastest), case.speed) if case.way == "flying" else case.direction * COMMAND
    )
    at = 0.0 if case.way == "flying" else _COMMAND_AT
    result = core.load().run(
        plant=profile.merged(common.plant, own),
        parameters={**common.parameters, "hold_time": _HOLD if held else 0.0},
        commands=[(at, "speed_ref_rpm", target)],
        load=[(0.0, case.load), (1.0, case.load)] if case.load else [],
        duration=_DURATION,
        max_start=2.0,
        record_every=1,
        waveform=(0.0, 0.0, 1),
        seed=case.seed,
        progress=lambda share: report(0, share),
    )
    return _judge(case, result, target)


def _judge(case: Case, result: NativeResult, target: float) -> Outcome:
    signals = {name: np.asarray(values) for name, values in result.signals.items()}
    if not result.completed or signals["time"].size < 2:
        return Outcome(case, result.reason or "broken off", broken=True)
    speed: Floats = signals["true_speed"]
    off = math.remainder(float(signals["true_angle"][0] - signals["est_angle"][0]), 2.0 * math.pi)
    backward = _backward(case, signals["time"], speed, dict(result.stats))
    late = abs(float(speed[-1]) - target)
    problem = None
    if abs(math.degrees(off)) > ANGLE_LIMIT:
        problem = f"wrong angle: {math.degrees(off):.0f} degrees off"
    elif late > 0.1 * abs(target) + 20.0:
        problem = f"lost: {speed[-1]:.0f} rpm instead of {target:.0f}"
    elif backward > BACKWARD_LIMIT:
        problem = f"{backward:.1f} degrees backwards"
    return Outcome(
        case,
        problem,
        backward,
        float(signals["polarity_sigma"][-1]),
        math.degrees(off),
        result.stats["start_seconds"] - 0.05,
    )


def _backward(case: Case, time: Floats, speed: Floats, stats: dict[str, float]) -> float:
    """Largest motion against the direction of the command, degrees mechanical: in the start procedure or after it."""
    turned = np.cumsum(speed) * 6.0 * float(time[1] - time[0])
    after = max(0.0, float(np.max(-case.direction * turned)))
    before = stats["start_travel_backward"] if case.direction > 0 else stats["start_travel_forward"]
    return max(after, before)


def run_all(common: Bench, todo: Sequence[Case], where: Where, done: Callable[[Outcome], None]) -> list[Outcome]:
    """All cases on workers, in their order; `done` is told of each."""
    outcomes: list[Outcome] = []
    early: dict[int, Outcome] = {}
    with workers(where) as crew:
        for task, outcome in crew.finished(deque(Task(run, (common, case), k) for k, case in enumerate(todo))):
            early[task.tag] = outcome
            while len(outcomes) in early:
                outcomes.append(early.pop(len(outcomes)))
                done(outcomes[-1])
    return outcomes
