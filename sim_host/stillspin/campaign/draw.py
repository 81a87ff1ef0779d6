"""A case of a campaign: what was drawn for its number, and the scenario that it makes of a motor."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from stillspin import core
from stillspin.campaign.duty import NOMINAL_LOAD, Duty
from stillspin.campaign.faults import Fault, Faults
from stillspin.campaign.spread import Departure, Spread
from stillspin.cases.profile import Profile, merged
from stillspin.cases.scenario import Figure, Goal, Scenario
from stillspin.core import Plant
from stillspin.entry import Value
from stillspin.runs.execute import Settings

PLAIN_NOISE = 1
"""Seed of the noise where a case has none of its own: that of `stillspin run`."""
_FAULT, _NOISE = "its fault", "its noise"
"""Parts of a case that are no departures; no departure can be called so."""
LOST = 60.0
"""Degrees electrical between the true angle and the one in use from which on the rotor is lost: as for starts."""


@dataclass(frozen=True)
class Case:
    """What was drawn for a number, the same for every motor.

    Attributes:
        number: from 1 on.
        drawn: the departures that are not nominal, by name.
        noise: seed of the sensors' noise.
        fault: what is injected, None for nothing; at: when, as a share of the run.
    """

    number: int
    drawn: Mapping[str, float]
    noise: int = PLAIN_NOISE
    fault: str | None = None
    at: float = 0.0

    @property
    def parts(self) -> tuple[str, ...]:
        """What can be taken away from it, see `only`."""
        found = [_FAULT] if self.fault else []
        return (*found, *([_NOISE] if self.noise != PLAIN_NOISE else []), *self.drawn)

    def only(self, parts: Collection[str]) -> Case:
        """The case with these parts alone, the others nominal."""
        with_fault = _FAULT in parts
        return Case(
            self.number,
            {name: number for name, number in self.drawn.items() if name in parts},
            self.noise if _NOISE in parts else PLAIN_NOISE,
            self.fault if with_fault else None,
            self.at if with_fault else 0.0,
        )


@dataclass(frozen=True)
class Drawer:
    """What cases are drawn from."""

    spread: Spread
    faults: Faults
    seed: int
    _departures: dict[str, Departure] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_departures", {row.name: row for row in self.spread.departures})

    def case(self, number: int) -> Case:
        """The case of a number: of it and the seed alone."""
        drawn = {row.name: row.draw(self.seed, number) for row in self.spread.departures}
        source = np.random.default_rng([self.seed, number])
        noise, has, which, at = int(source.integers(2**32)), *map(float, source.uniform(size=3))
        fault = self.faults.drawn(has, which)
        return Case(number, drawn, noise, fault, round(self.faults.at(at), 4) if fault else 0.0)

    @property
    def mark(self) -> str:
        """The same for the same spread and faults, whatever their files are called."""
        return _digest(self.spread.departures, self.faults.share, self.faults.window, self.faults.faults)

    def departure(self, name: str) -> Departure:
        """That of a name."""
        return self._departures[name]

    def words(self, case: Case) -> str:
        """What differs from nominal, for people."""
        parts = [self.departure(name).words(number) for name, number in case.drawn.items()]
        parts += [f"{case.fault} at {100.0 * case.at:.0f} % of the run"] if case.fault else []
        parts += [f"noise of seed {case.noise}"] if case.noise != PLAIN_NOISE else []
        return ", ".join(parts) or "nothing: it is the nominal case"


@dataclass(frozen=True)
class Unit:
    """A motor of a campaign.

    Attributes:
        motor, profile: as they were asked for, names or paths.
        duty: what is asked of it.
        plate: what its files say; settings: with what the drive was told beyond that.
        schema: of the plant.
        refusal: why the drive runs none of its cases, in words; empty where it does.
    """

    motor: str
    profile: str
    duty: Duty
    plate: Profile
    settings: Settings
    schema: core.Schema = field(repr=False)
    refusal: str = ""

    @property
    def told(self) -> dict[str, float]:
        """Parameters of the drive beyond those of the files."""
        plain = self.plate.parameters
        return {name: value for name, value in self.settings.profile.parameters.items() if plain.get(name) != value}

    @property
    def mark(self) -> str:
        """The same for the same plant and drive, whatever their files are called."""
        settings = self.settings
        changed = (settings.changes.plant, settings.changes.parameters)
        return _digest(self.plate.plant, settings.profile.parameters, *changed)

    def at_noise(self, seed: int) -> Settings:
        """Its settings with another seed of the noise."""
        return replace(self.settings, seed=seed)

    def scenario(self, case: Case, drawer: Drawer, name: str = "") -> Scenario:
        """The case as a scenario of one run.

        Raises:
            InputError: what was drawn is out of the range of an entry.
        """
        departures = [(drawer.departure(key), number) for key, number in case.drawn.items()]
        load = NOMINAL_LOAD + sum(row.load * number for row, number in departures)
        fault = self._fault(drawer.faults.named(case.fault), case.at) if case.fault else {}
        run = self.duty.run("case", load)
        run = replace(
            run,
            plant=merged(run.plant, self._added(departures), fault),
            factors=_factors(departures),
        )
        watched = Figure(
            "position_error_peak", "position_error_peak", "deg el", ("case",), ((0.0, run.duration),), None, Goal(LOST)
        )
        return Scenario(
            name or f"case-{case.number}",
            f"Case {case.number} of a campaign",
            self.settings.profile.motor,
            f"Departs from nominal by {drawer.words(case)}.",
            "",
            "",
            (run,),
            (watched,),
            (),
        )

    def _added(self, departures: list[tuple[Departure, float]]) -> Plant:
        plant: Plant = {}
        span = float(self._nominal("adc", "current_range"))
        for row, number in departures:
            for pulls, unit in ((row.add, 1.0), (row.add_of_range, span)):
                for section, keys in pulls.items():
                    for key, per in keys.items():
                        before = plant.get(section, {}).get(key, self._nominal(section, key))
                        plant.setdefault(section, {})[key] = float(before) + per * number * unit
        return plant

    def _nominal(self, section: str, key: str) -> Value:
        stated = merged(self.settings.profile.plant, self.settings.changes.plant)
        return stated.get(section, {}).get(key, self.schema[section][key].default)

    def _fault(self, fault: Fault, at: float) -> Plant:
        return {"fault": {**fault.entries, fault.at: round(at * self.duty.duration, 4)}}


def _factors(departures: list[tuple[Departure, float]]) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = {}
    for row, number in departures:
        for section, keys in row.factor.items():
            for key, per in keys.items():
                before = found.setdefault(section, {}).get(key, 1.0)
                found[section][key] = before * (1.0 + per * number)
    return {
        section: {key: value for key, value in keys.items() if not math.isclose(value, 1.0, abs_tol=0.0)}
        for section, keys in found.items()
    }


def _digest(*of: object) -> str:
    return hashlib.sha256(repr(of).encode()).hexdigest()[:16]
