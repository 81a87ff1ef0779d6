"""Motors (`motors/*.toml`), plant profiles (`profiles/*.toml`), and the changes that `--set` makes to both.

A motor says what the machine's nameplate and the board made for it say: inductances, link voltage, measuring ranges. A
profile says what a real inverter and machine add to that: drops, noise, shares by which the true machine differs. Both
have the plant's sections and keys in the plant's units, and a section `parameters` of firmware parameters, such as the
nameplate or the dead time that the gate drivers need. The profile is laid over the motor; what neither mentions stays
at the plant's own default.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from stillspin import core, json_schema, resources, toml_table
from stillspin.cases import file_schema, flux_table, nameplate, similarity, sized_effects
from stillspin.entry import Entry, Value
from stillspin.errors import InputError, did_you_mean
from stillspin.scales import SCALES

_BY_SCALES = ("adc", "machine", "mechanics", "parameters")


@dataclass(frozen=True)
class Profile:
    """A named plant with its motor. It holds only the entries and firmware parameters that the two state.

    Attributes:
        commission: the machine differs from its nameplate, so that a campaign lets the drive measure it first.
        motor: its name.
        not_stated: what its file leaves out, and what the drive keeps instead.
        by_rule: parameters that are another machine's by default, and this one's by its size.
    """

    name: str
    description: str
    plant: core.Plant
    parameters: dict[str, float] = field(default_factory=dict)
    commission: bool = False
    motor: str = resources.DEFAULT_MOTOR
    not_stated: tuple[str, ...] = ()
    by_rule: tuple[str, ...] = ()


@dataclass
class Changes:
    """What `--set` changes: entries of the plant, firmware parameters, and the words as they were given."""

    plant: core.Plant = field(default_factory=dict)
    parameters: dict[str, float] = field(default_factory=dict)
    words: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class _File:
    """What a file of a plant says: a profile, or a motor."""

    name: str
    description: str
    plant: core.Plant
    assumed: core.Plant
    parameters: dict[str, float]
    commission: bool
    sized: bool


def load(
    name_or_path: str,
    schema: core.Schema,
    known: Mapping[str, Entry],
    motor: str = resources.DEFAULT_MOTOR,
    *,
    checked: bool = True,
) -> Profile:
    """Read and check a profile, and lay it over a motor.

    Args:
        name_or_path: "bench", "ideal" or the path of a TOML file.
        schema: what the plant can be told.
        known: the firmware's parameters.
        motor: "A" or another motor that ships, or the path of a TOML file.
        checked: what follows from the motor's file is within the ranges of the drive's parameters.

    Raises:
        InputError: not found, not TOML, unknown entry, wrong type or out of range.
    """
    scales = _scales(motor, name_or_path)
    known = core.at_scale(known, scales)
    machine = _read("motor", motor, schema, known)
    effects = _read("profile", name_or_path, schema, known)
    added = sized_effects.of_size(effects.plant, machine.plant, scales, schema) if effects.sized else effects.plant
    follows = nameplate.following(machine.plant, machine.parameters)
    sized = similarity.follow(machine.plant, {**follows, **machine.parameters}, known)
    follows |= sized
    for name, value in follows.items() if checked else ():
        if name in known:
            core.parameter(known, name, value, f"motor {machine.name}: {name}, which follows from its file")
    return Profile(
        effects.name,
        effects.description,
        merged(machine.plant, added),
        {**follows, **machine.parameters, **effects.parameters},
        effects.commission,
        machine.name,
        (
            *nameplate.not_stated(machine.plant, machine.parameters, known),
            *nameplate.without_size(machine.plant, {**follows, **machine.parameters, **effects.parameters}, known),
            *nameplate.by_rule(machine.assumed, schema),
        ),
        tuple(name for name in sized if name not in effects.parameters),
    )


def say_not_stated(chosen: Profile) -> None:
    """What the motor's file leaves out, for the terminal."""
    for words in chosen.not_stated:
        print(f"stillspin: motor {chosen.motor}: {words}", file=sys.stderr)


def _scales(motor: str, profile_name: str) -> dict[str, float]:
    """What the board's sensors and the rotor ask for, or the files state: by which all else in them is read."""
    found: dict[str, float] = {}
    for kind, name in (("motors", motor), ("profiles", profile_name)):
        data = toml_table.read(resources.find(kind, name)).items()
        tables = {key: table if isinstance(table := data.get(key), dict) else {} for key in _BY_SCALES}
        stated = tables.pop("parameters")
        sizes: core.Plant = {
            section: {key: each for key, each in table.items() if isinstance(each, int | float) and each > 0}
            for section, table in tables.items()
        }
        said = {**nameplate.scales(sizes), **stated} if kind == "motors" else stated
        found |= {key: value for key in SCALES if isinstance(value := said.get(key), int | float)}
    return found


def _read(kind: str, name: str, schema: core.Schema, known: Mapping[str, Entry]) -> _File:
    path = resources.find(f"{kind}s", name)
    data = toml_table.read(path).items()
    json_schema.check(data, file_schema.plant(kind, schema, known), str(path))
    plant = {
        section: {key: entries[key].value(value) for key, value in data[section].items()}
        for section, entries in schema.items()
        if section in data
    }
    plant = flux_table.stated(plant, path)
    assumed = similarity.assumed(plant) if kind == "motor" else {}
    parameters = {name: float(known[name].value(value)) for name, value in data.get("parameters", {}).items()}
    description, commission, sized = (
        data.get("description", ""),
        data.get("commission", False),
        data.get("sized", False),
    )
    return _File(path.stem, description.strip(), merged(plant, assumed), assumed, parameters, commission, sized)


def merged(*plants: Mapping[str, Mapping[str, Value]]) -> core.Plant:
    """Plants laid over one another; later ones win entry by entry."""
    result: core.Plant = {}
    for plant in plants:
        for section, keys in plant.items():
            result.setdefault(section, {}).update(keys)
    return result


def split_assignment(word: str) -> tuple[str, str]:
    """Name and value text of `name=value`.

    Raises:
        InputError: there is no "=", or nothing on one side of it.
    """
    name, equals, value = (part.strip() for part in word.partition("="))
    if not equals or not name or not value:
        raise InputError(f"--set '{word}': must be section.entry=value or parameter=value, such as adc.noise=0.5")
    return name, value


def _stated_scales(words: Iterable[str], known: Mapping[str, Entry]) -> dict[str, float]:
    pairs = [split_assignment(word) for word in words]
    return {name: float(known[name].read(text, f"--set {name}")) for name, text in pairs if name in SCALES}


def changes(
    words: Iterable[str],
    schema: core.Schema,
    known: Mapping[str, Entry],
    told: Mapping[str, float] | None = None,
) -> Changes:
    """Sort the words of `--set` into plant entries and firmware parameters, checked.

    Args:
        words: as they were given.
        schema: what the plant can be told.
        known: the firmware's parameters.
        told: what the drive is told before, of which its scales count.

    Raises:
        InputError: malformed, unknown, wrong type, another unit, or out of range.
    """
    result = Changes()
    words = list(words)
    known = core.at_scale(known, {**(told or {}), **_stated_scales(words, known)})
    for word in words:
        name, text = split_assignment(word)
        where = f"--set {name}"
        section, dot, key = name.partition(".")
        if dot and name not in known:
            checked = core.entry_known(schema, section, key, where).read(text, where)
            result.plant.setdefault(section, {})[key] = checked
        else:
            if name not in known:
                near = [*known, *(f"{part}.{item}" for part, keys in schema.items() for item in keys)]
                raise InputError(f"--set '{word}': there is no parameter '{name}'{did_you_mean(name, near)}")
            result.parameters[name] = float(known[name].read(text, where))
        result.words.append(f"{name}={text}")
    return result
