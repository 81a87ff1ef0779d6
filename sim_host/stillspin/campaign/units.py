"""The motors of a campaign as they are nominally, and what their drives are told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path

from stillspin import core
from stillspin.campaign import duty
from stillspin.campaign.draw import Unit
from stillspin.cases import profile, variant
from stillspin.entry import Entry
from stillspin.errors import CampaignError, InputError
from stillspin.revision import revision
from stillspin.runs import commission
from stillspin.runs.execute import Settings

Show = Callable[[float, str], bool]
"""Is told the share done and the phase."""
Progress = Callable[[], AbstractContextManager[Show]]
"""Opens what is told how far a commissioning is."""


@dataclass(frozen=True)
class Wish:
    """What was asked for.

    Attributes:
        motors: names or paths; profile: the same; changes: as `--set` takes them; seed: of the commissioning's noise.
        firmware: version, board file, build and table of the drive's, for the records.
        params: a parameter file for the drive; scheme: over what it is told and finds out; None for none.
        commission: whether the nominal unit is commissioned, where the profile is for it and there is no `params`.
    """

    motors: Sequence[str]
    profile: str
    seed: int
    firmware: str = ""
    changes: Sequence[str] = ()
    params: Path | None = None
    scheme: str | None = None
    commission: bool = True


@dataclass
class Told:
    """Motors with their drives.

    Attributes:
        units: in their order, also those that are refused.
        refused: why a motor cannot be run at all, by its name.
        found: what the commissioning found, by motor.
        doubted: values that the drive did not believe, in words.
    """

    units: list[Unit]
    found: dict[str, commission.Result] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    doubted: list[str] = field(default_factory=list)


def nominal(wish: Wish) -> list[Unit]:
    """The motors, their drives told what files say.

    Raises:
        InputError: something asked for does not exist or does not fit together.
    """
    if wish.params and len(wish.motors) > 1:
        raise InputError(f"--params {wish.params}: is of one motor, and --motors are {', '.join(wish.motors)}")
    units = [_unit(wish, motor) for motor in wish.motors]
    names = [unit.plate.motor for unit in units]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"--motors: two of them are called {name}, as results would be; rename a file")
    return [_in_scheme(wish, unit) for unit in units]


def told(wish: Wish, units: Sequence[Unit], progress: Progress) -> Told:
    """Their drives told what they find out on the nominal unit, too, where that is wanted.

    The same parameters then serve all units of a motor: in what these differ the drive is not told.
    """
    found = Told(list(units))
    for number, unit in enumerate(units):
        profile.say_not_stated(unit.plate)
        if wish.commission and not wish.params and unit.plate.commission:
            found.units[number] = _in_scheme(wish, _commissioned(unit, found, progress))
    return found


def _known() -> dict[str, Entry]:
    return core.parameters(core.load())


def _unit(wish: Wish, motor: str) -> Unit:
    schema, known = core.plant_schema(core.load()), _known()
    plate = profile.load(wish.profile, schema, known, motor)
    changes = profile.changes(wish.changes, schema, known)
    settings = Settings(plate, changes, wish.seed, revision(), firmware=wish.firmware)
    unit = Unit(motor, wish.profile, duty.of(plate, schema, known), plate, settings, schema)
    return _with(unit, commission.load(wish.params, known)) if wish.params else unit


def _in_scheme(wish: Wish, unit: Unit) -> Unit:
    """The unit whose drive runs in the scheme that is wanted, if one is: over what it was told, or has found out."""
    if not wish.scheme:
        return unit
    return _with(unit, variant.scheme(wish.scheme).told(unit.settings.profile, _known()).parameters)


def _with(unit: Unit, parameters: dict[str, float]) -> Unit:
    now = unit.settings.profile
    changed = replace(now, parameters={**now.parameters, **parameters})
    return replace(unit, settings=replace(unit.settings, profile=changed))


def _commissioned(unit: Unit, found: Told, progress: Progress) -> Unit:
    """On the plain unit, as its scheme is no business of the commissioning."""
    settings = unit.settings
    try:
        with progress() as show:
            result = commission.run(core.load(), unit.plate, settings.changes, settings.seed, show)
    except CampaignError as error:
        found.refused[unit.motor] = str(error)
        return unit
    found.found[unit.motor] = result
    found.doubted += [f"motor {unit.motor}: {value.name} keeps its value: {value.words}" for value in result.refused]
    return _with(unit, {**unit.plate.parameters, **result.told})
