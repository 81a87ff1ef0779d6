"""One nameplate: a motor's file states each quantity once, and what the drive is told of it follows from that.

The file states the machine in SI units; the drive's parameters have their own units. What `[parameters]` states goes
before what follows. What is stated nowhere is said: the drive keeps its default then, which is motor A's.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from stillspin import core
from stillspin import scales as boards
from stillspin.cases import observer_noise, open_loop, similarity
from stillspin.entry import Entry


@dataclass(frozen=True)
class Following:
    """A firmware parameter that follows from an entry of the plant: so many of its units to one of the plant's."""

    parameter: str
    section: str
    key: str
    factor: float = 1.0
    needed: bool = True
    """Whether it is said where it is not stated; what is the board's has a default that is right."""
    digits: int = 9


FOLLOWING = (
    Following("pole_pairs", "machine", "pole_pairs"),
    Following("stator_resistance", "machine", "resistance"),
    Following("inductance_d", "machine", "inductance_d", 1e3),
    Following("inductance_q", "machine", "inductance_q", 1e3),
    Following("magnet_flux", "machine", "magnet_flux"),
    Following("inertia", "mechanics", "inertia"),
    Following("friction", "mechanics", "viscous_friction"),
    Following("rated_current", "machine", "rated_peak_current", digits=2),
    Following("current_full_scale", "adc", "current_range", needed=False),
    Following("trip_current", "adc", "current_range", 0.9, needed=False),
    Following("observer_noise", "adc", "current_range", 1e3 * observer_noise.PER_AMPERE, needed=False),  # mA
    Following("link_full_scale", "adc", "voltage_range", needed=False),
    Following("link_minimum", "link", "source_voltage", 0.5),
    Following("link_regulation", "link", "source_voltage", 1.35, needed=False),
    Following("link_maximum", "link", "source_voltage", 1.4, needed=False),
)
_SCALES = (
    (boards.CURRENT, "current_range", 20.0, 40.0),
    (boards.VOLTAGE, "voltage_range", 225.0, 450.0),
)
"""Parameters that follow from the board's range: at 0 it is within the two."""
_LIGHTEST = 1.304e-5
"""kg m² for each pole pair, at both scales 0: a lighter rotor's acceleration is beyond its format."""
_LIGHTER = 1.3
"""So much lighter than its nameplate a rotor may turn out."""
_STEPS = 2
"""That a scale may be below its board's range, whose values then go up to a quarter of their formats."""
_LINK = 1000.0
"""V at the voltage's scale 0: a link's voltage that its format, which goes up to 1500 V, holds with what brakes it."""
STATED = ("current_limit", "speed_limit")
"""Parameters that follow from nothing: the motor's file has them."""


def scales(plant: core.Plant) -> dict[str, float]:
    """The powers of two, nearest to none, that bring the sensors' ranges to where the formats expect them.

    A torque has both in its unit: a rotor that is too light for the formats has lower ones, the voltage's first. One
    that the lowest do not hold keeps those of its board: it is its inertia then that is out of range.
    """
    found = {}
    for name, key, least, most in _SCALES:
        value = float(plant.get("adc", {}).get(key, least))
        found[name] = max(0, math.ceil(math.log2(value / most))) + min(0, math.floor(math.log2(value / least)))
    inertia = float(plant.get("mechanics", {}).get("inertia", 0.0))
    pairs = float(plant.get("machine", {}).get("pole_pairs", 1.0))
    link = float(plant.get("link", {}).get("source_voltage", 0.0))
    lower = dict(found)
    for name in (boards.VOLTAGE, boards.CURRENT) * _STEPS:
        held = name == boards.CURRENT or link <= _LINK * 2.0 ** (lower[name] - 1)
        if held and 0.0 < inertia / pairs < _least(lower):
            lower[name] -= 1
    kept = lower if inertia / pairs >= _least(lower) else found
    return {name: float(scale) for name, scale in kept.items() if scale}


def _least(scales: Mapping[str, int]) -> float:
    """The lightest rotor that these scales hold, in kg m² for each pole pair."""
    return _LIGHTER * _LIGHTEST * 2.0 ** sum(scales.values())


def following(plant: core.Plant, stated: Mapping[str, float]) -> dict[str, float]:
    """The parameters that follow from what a motor's file states of the plant, and that it does not state itself."""
    found = {name: value for name, value in scales(plant).items() if name not in stated}
    for row in FOLLOWING:
        value = plant.get(row.section, {}).get(row.key)
        if value is not None and row.parameter not in stated:
            found[row.parameter] = round(float(value) * row.factor, row.digits)
    found |= open_loop.one_inductance(found)
    if "observer_noise" in found:
        found["observer_noise"] *= observer_noise.times(plant)
    limit = stated.get("current_limit")
    if limit is not None and "map_current" not in stated:
        found["map_current"] = limit
    if limit is not None and "weakening_limit" not in stated:
        found["weakening_limit"] = round(0.8 * limit, 9)
    vector = open_loop.following({**found, **stated}, float(plant.get("link", {}).get("source_voltage", 0.0)))
    return found | {name: value for name, value in vector.items() if name not in stated}


def not_stated(plant: core.Plant, stated: Mapping[str, float], known: Mapping[str, Entry]) -> tuple[str, ...]:
    """What a motor's file leaves out, and what the drive keeps instead, in words."""
    open_ = [
        (f"{row.section}.{row.key}", row.parameter)
        for row in FOLLOWING
        if row.needed and row.key not in plant.get(row.section, {}) and row.parameter not in stated
    ] + [(f"parameters.{name}", name) for name in STATED if name not in stated]
    return tuple(
        f"{where} is not stated; the drive keeps {name} = {known[name].default:g} {known[name].unit}".rstrip()
        for where, name in open_
        if name in known
    )


def without_size(plant: core.Plant, told: Collection[str], known: Mapping[str, Entry]) -> tuple[str, ...]:
    """What no rule says because the machine's size is not known, and the defaults that the drive keeps, in words."""
    missing = similarity.missing(plant)
    kept = [known[name] for name in similarity.RULES if name in known and name not in told]
    values = ", ".join(f"{entry.name} {entry.default:g} {entry.unit}".rstrip() for entry in kept)
    if not (missing and values):
        return ()
    return (f"no rule says what goes by the machine's size without {', '.join(missing)}; the drive keeps {values}",)


def by_rule(assumed: core.Plant, schema: core.Schema) -> tuple[str, ...]:
    """What a motor's file leaves out and a rule has instead, in words."""
    return tuple(
        f"{section}.{key} is not stated; by rule it is {value:g} {schema[section][key].unit}"
        for section, keys in assumed.items()
        for key, value in keys.items()
    )
