"""The motors of a campaign as they are nominally, and what their drives are told."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path

from stillspin import core, resources
from stillspin.campaign import duty
from stillspin.campaign.draw import Unit
from stillspin.cases import profile
from stillspin.counted import counted
from stillspin.entry import Entry
from stillspin.errors import CampaignError, InputError
from stillspin.revision import revision
from stillspin.runs import commission, variant
from stillspin.runs.execute import Settings
from stillspin.runs.reporting import report
from stillspin.runs.workers import Task, Where, workers

_PROFILES, _USUAL = "motors/profiles", "bench"
"""Where motors have profiles of their own, and what the others get."""
Show = Callable[[float, str], bool]
"""Is told the share done and the phase."""
Progress = Callable[[], AbstractContextManager[Show]]
"""Opens what is told how far a commissioning is."""


@dataclass(frozen=True)
class Wish:
    """What was asked for.

    Attributes:
        motors: names or paths.
        profile: the same, None for that of the motor's name, or else the usual one.
        changes: as `--set` takes them; seed: of the commissioning's noise.
        firmware: version, board file, build and table of the drive's, for the records.
        params: a parameter file for the drive; scheme: over what it is told and finds out; None for none.
        commission: whether the nominal unit is commissioned, where the profile is for it and there is no `params`.
    """

    motors: Sequence[str]
    seed: int
    profile: str | None = None
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
        found: what the commissioning found, by motor.
        doubted: values that the drive did not believe, in words.
    """

    units: list[Unit]
    found: dict[str, commission.Result] = field(default_factory=dict)
    doubted: list[str] = field(default_factory=list)


def nominal(wish: Wish) -> list[Unit]:
    """The motors, their drives told what files say. One that its drive refuses to be set up for is one of them.

    Raises:
        InputError: something asked for does not exist or does not fit together, or all motors are refused.
    """
    if wish.params and len(wish.motors) > 1:
        raise InputError(f"--params {wish.params}: is of one motor, and --motors are {', '.join(wish.motors)}")
    units = [_unit(wish, motor) for motor in wish.motors]
    names = [unit.plate.motor for unit in units]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"--motors: two of them are called {name}, as results would be; rename a file")
    if all(unit.refusal for unit in units):
        raise InputError(units[0].refusal)
    return units


def told(wish: Wish, units: Sequence[Unit], progress: Progress, where: Where) -> Told:
    """Their drives told what they find out on the nominal unit, too, where that is wanted.

    The same parameters then serve all units of a motor: in what these differ the drive is not told.

    Raises:
        CampaignError: a worker has died.
    """
    found = Told(list(units))
    for unit in units:
        profile.say_not_stated(unit.plate)
    wanted = wish.commission and not wish.params
    todo = [number for number, unit in enumerate(units) if wanted and unit.plate.commission and not unit.refusal]
    if todo:
        with progress() as show:
            results = _commissioned([units[number] for number in todo], where, show)
        for number, result in zip(todo, results, strict=True):
            found.units[number] = _in_scheme(wish, _told(units[number], result, found))
    return found


def _known() -> dict[str, Entry]:
    return core.parameters(core.load())


def _unit(wish: Wish, motor: str) -> Unit:
    native, known = core.load(), _known()
    schema = core.plant_schema(native)
    chosen = wish.profile or (motor if motor in resources.names(_PROFILES) else _USUAL)
    plate = profile.load(chosen, schema, known, motor, checked=False)
    changes = profile.changes(wish.changes, schema, known, plate.parameters)
    settings = Settings(plate, changes, wish.seed, revision(), firmware=wish.firmware)
    unit = Unit(motor, chosen, duty.of(plate, schema, known), plate, settings, schema)
    unit = _with(unit, commission.load(wish.params, known, plate.parameters)) if wish.params else unit
    return replace(_in_scheme(wish, unit), refusal=_refusal(unit, native, known))


def _refusal(unit: Unit, native: core.NativeCore, known: Mapping[str, Entry]) -> str:
    """Why the drive cannot be set up for a motor: a value out of its range, or values that do not fit together."""
    try:
        profile.load(unit.profile, unit.schema, known, unit.motor)
        native.check_parameters({**unit.settings.profile.parameters, **unit.settings.changes.parameters})
    except InputError as error:
        return str(error)
    except ValueError as error:
        return f"motor {unit.motor}: {error}"
    return ""


def _in_scheme(wish: Wish, unit: Unit) -> Unit:
    """The unit whose drive runs in the scheme that is wanted, if one is: over what it was told, or has found out."""
    if not wish.scheme:
        return unit
    return _with(unit, variant.scheme(wish.scheme).told(unit.settings.profile, _known()).parameters)


def _with(unit: Unit, parameters: dict[str, float]) -> Unit:
    now = unit.settings.profile
    changed = replace(now, parameters={**now.parameters, **parameters})
    return replace(unit, settings=replace(unit.settings, profile=changed))


def _commissioned(units: Sequence[Unit], where: Where, show: Show) -> list[commission.Result | str]:
    """What each finds out on the plain unit, as its scheme is no business of that; or why it broke off."""
    if len(units) == 1:
        return [_commission(units[0], show)]

    def watch(shares: Sequence[float]) -> None:
        show(sum(shares) / len(units), counted(len(units), "motor"))

    found: dict[int, commission.Result | str] = {}
    with workers(where, len(units), watch) as crew:
        tasks = deque(Task(_reported, (unit, number), number) for number, unit in enumerate(units))
        for task, result in crew.finished(tasks):
            found[task.tag] = result
    return [found[number] for number in range(len(units))]


def _reported(unit: Unit, slot: int) -> commission.Result | str:
    return _commission(unit, lambda share, _: report(slot, share))


def _commission(unit: Unit, show: Show) -> commission.Result | str:
    settings = unit.settings
    try:
        return commission.run(core.load(), unit.plate, settings.changes, settings.seed, show)
    except CampaignError as error:
        return str(error)


def _told(unit: Unit, result: commission.Result | str, found: Told) -> Unit:
    if isinstance(result, str):
        return replace(unit, refusal=result)
    found.found[unit.motor] = result
    found.doubted += [f"motor {unit.motor}: {value.name} keeps its value: {value.words}" for value in result.refused]
    return _with(unit, {**unit.plate.parameters, **result.told})
