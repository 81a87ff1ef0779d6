"""The effects of a real inverter and motor (`schemes/effects.toml`), and a scenario without one or with it alone.

What an effect is, is the difference between a profile and `ideal` in some entries of the plant and in the firmware
parameters that belong to them. Entries of the plant are laid over everything else, also over those of the scenario.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from stillspin import core, resources, toml_table
from stillspin.cases.profile import Profile, merged
from stillspin.cases.scenario import Scenario
from stillspin.core import Plant
from stillspin.entry import Entry, Value
from stillspin.errors import InputError
from stillspin.runs.execute import Settings

WITHOUT, ALONE = "without", "alone"


@dataclass(frozen=True)
class Effect:
    """One effect.

    Attributes:
        mark: a word for file names; title: in a few words.
        entries: of the plant, as (section, key); needs: others that must be there for it to show.
        parameters: of the firmware that go with it.
        commission: it is measured when the drive is commissioned.
        exact: nothing but what the drive is told of the plant.
    """

    mark: str
    title: str
    entries: tuple[tuple[str, str], ...]
    needs: tuple[tuple[str, str], ...]
    parameters: tuple[str, ...]
    commission: bool
    exact: bool


@dataclass(frozen=True)
class Worlds:
    """A profile as it is, and the one without any effect, both on the same motor.

    Attributes:
        own: of the profile, before commissioning; ideal: without effects.
        schema: of the plant; known: the firmware's parameters.
    """

    own: Profile
    ideal: Profile
    schema: core.Schema
    known: Mapping[str, Entry]

    def value(self, where: Profile, entry: tuple[str, str]) -> Value:
        """What an entry of the plant is in a profile."""
        section, key = entry
        return where.plant.get(section, {}).get(key, self.schema[section][key].default)

    def parameter(self, where: Profile, name: str) -> float:
        """What a parameter is in a profile."""
        return float(where.parameters.get(name, core.at_scale(self.known, where.parameters)[name].default))

    def differs(self, effect: Effect) -> bool:
        """Whether the profile has the effect at all."""
        return effect.exact or any(self.value(self.own, e) != self.value(self.ideal, e) for e in effect.entries)

    def plant(self, where: Profile, entries: Sequence[tuple[str, str]]) -> Plant:
        """Some entries as they are in a profile."""
        result: Plant = {}
        for section, key in entries:
            result.setdefault(section, {})[key] = self.value(where, (section, key))
        return result


@dataclass(frozen=True)
class Case:
    """A scenario with or without an effect. `effect`: None for the profile, or for `ideal`, as they are."""

    kind: str
    effect: Effect | None
    settings: Settings

    @property
    def mark(self) -> str:
        """For file names."""
        return f"{self.kind}-{self.effect.mark if self.effect else 'nothing'}"

    def scenario(self, scenario: Scenario) -> Scenario:
        """The scenario under an id of its own, not drawn."""
        return replace(scenario, id=f"{scenario.id}-{self.mark}", plots=())


def case(kind: str, effect: Effect | None, settings: Settings, worlds: Worlds) -> Case:
    """The case on what `settings` knows; the drive's parameters are theirs but for those that go with the effect."""
    if effect is None:
        return Case(kind, None, settings)
    if effect.exact:
        told = {**settings.profile.parameters, **exact(worlds)}
        return Case(kind, effect, replace(settings, profile=replace(settings.profile, parameters=told)))
    source = worlds.ideal if kind == WITHOUT else worlds.own
    shown = effect.entries if kind == WITHOUT else (*effect.needs, *effect.entries)
    changes = replace(settings.changes, plant=merged(settings.changes.plant, worlds.plant(source, shown)))
    own = {name: worlds.parameter(source, name) for name in effect.parameters}
    told = {**settings.profile.parameters, **own}
    return Case(kind, effect, replace(settings, changes=changes, profile=replace(settings.profile, parameters=told)))


def exact(worlds: Worlds) -> dict[str, float]:
    """What a drive that knows the plant would be told: machine, drops, inertia, friction, match of the sensors.

    The map of saturation has no place in it: its entries are incremental and stay as they were measured.
    """

    def entry(section: str, key: str) -> float:
        return float(worlds.value(worlds.own, (section, key)))

    def true(section: str, key: str) -> float:
        return entry(section, key) * (1.0 + entry("parameter_error", key))

    def device(key: str) -> float:
        return (entry("inverter", f"switch_{key}") + entry("inverter", f"diode_{key}")) / 2.0

    return {
        "stator_resistance": true("machine", "resistance"),
        "device_drop": device("threshold"),
        "device_resistance": device("resistance"),
        "inductance_d": 1e3 * true("machine", "inductance_d"),
        "inductance_q": 1e3 * true("machine", "inductance_q"),
        "magnet_flux": true("machine", "magnet_flux"),
        "inertia": true("mechanics", "inertia"),
        "friction": entry("mechanics", "viscous_friction"),
        "sensor_mismatch": 50.0 * (entry("sensor", "gain_a") - entry("sensor", "gain_b")),
    }


def load(schema: core.Schema, known: Mapping[str, Entry]) -> list[Effect]:
    """All effects.

    Raises:
        InputError: the list is wrong.
    """
    table = toml_table.read(resources.directory("schemes") / "effects.toml")
    effects = [_effect(row, schema, known) for row in table.tables("effects")]
    table.finish()
    return effects


def _effect(table: toml_table.Table, schema: core.Schema, known: Mapping[str, Entry]) -> Effect:
    title, mark, exactly = table.text("title"), table.text("mark"), table.switch("exact")
    entries = () if exactly else _entries(table, "entries", schema)
    needs = _entries(table, "needs", schema) if table.has("needs") else ()
    parameters = tuple(table.texts("parameters")) if table.has("parameters") else ()
    for name in parameters:
        if name not in known:
            raise InputError(f"{table.where}: there is no firmware parameter '{name}'")
    commission = table.switch("commission")
    table.finish()
    return Effect(mark, title, entries, needs, parameters, commission, exactly)


def _entries(table: toml_table.Table, name: str, schema: core.Schema) -> tuple[tuple[str, str], ...]:
    result = []
    for word in table.texts(name):
        section, _, key = word.partition(".")
        core.section_known(schema, section, table.where)
        if key not in schema[section]:
            raise InputError(f"{table.where}: {name}: section '{section}' has no entry '{key}'")
        result.append((section, key))
    return tuple(result)
