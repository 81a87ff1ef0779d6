"""One run, from settings to a Parquet file and an outcome. Runs in a worker process or in this one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from stillspin import core
from stillspin.cases import factors
from stillspin.cases.profile import Changes, Profile, merged
from stillspin.cases.scenario import COMMANDS, Run, Scenario
from stillspin.core import NativeCore, NativeResult, Plant
from stillspin.core_loop import NativeStepLoop
from stillspin.entry import Entry
from stillspin.errors import InputError
from stillspin.image import closed_loop
from stillspin.image.opened import Image
from stillspin.measure import figures
from stillspin.runs import records

_OBSERVER = ("observer_load_rate", "observer_load_quiet")
"""Parameters that a record tells whether or not they were changed: what the observer expects of the load."""


@dataclass(frozen=True)
class Settings:
    """What all runs of a campaign have in common.

    Attributes:
        parameters_from: where the firmware's parameters come from.
        firmware: version, board file, build and table.
        image: what runs in the place of the firmware that is compiled for this computer; None for that.
    """

    profile: Profile
    changes: Changes
    seed: int
    revision: str
    parameters_from: str = "the nameplate"
    firmware: str = ""
    image: Image | None = None


@dataclass(frozen=True)
class Job:
    """One run with everything resolved and checked, ready for another process."""

    scenario: str
    run: Run
    plant: Plant
    parameters: dict[str, float]
    seed: int
    file: str
    about: dict[str, Any]
    units: dict[str, str]
    image: Image | None = None


@dataclass(frozen=True)
class Outcome:
    """How a run ended.

    Attributes:
        broken: why it does not count, None when it does.
        file: None when nothing was recorded.
        waveform: the file of the stretch that was looked into.
        notes: what it leaves open, in words.
    """

    scenario: str
    run: str
    broken: str | None
    file: str | None
    waveform: str | None = None
    stats: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def speed_ratio(self) -> float:
        """Simulated seconds per second of computing, 0 when unknown."""
        wall = self.stats.get("wall_seconds", 0.0)
        return self.stats.get("simulated_seconds", 0.0) / wall if wall > 0.0 else 0.0


def prepare(scenario: Scenario, settings: Settings, native: NativeCore) -> list[Job]:
    """The runs of a scenario: the profile, the scenario's own settings and the user's changes laid over one another.

    Raises:
        InputError: the scenario asks for an entry, parameter or value that does not exist.
    """
    known = _Known(
        core.plant_schema(native),
        core.parameters(native),
        {str(row["name"]): str(row.get("unit", "")) for row in native.signals()},
    )
    jobs = [_job(scenario, run, settings, known) for run in scenario.runs]
    for job in jobs:
        try:
            native.check_parameters(job.parameters)
        except ValueError as error:
            raise InputError(f"scenario {scenario.id}, run {job.run.name}: {error}") from error
    return jobs


@dataclass(frozen=True)
class _Known:
    """What the native module knows by name."""

    schema: core.Schema
    parameters: Mapping[str, Entry]
    units: dict[str, str]


def _job(scenario: Scenario, run: Run, settings: Settings, known: _Known) -> Job:
    where = f"scenario {scenario.id}, run {run.name}"
    own_plant: Plant = {
        section: {key: core.plant_entry(known.schema, section, key, value, where) for key, value in keys.items()}
        for section, keys in run.plant.items()
    }
    told: dict[str, float | str] = {**settings.profile.parameters, **run.parameters, **settings.changes.parameters}
    entries = core.at_scale(known.parameters, told)
    own = {name: core.parameter(entries, name, value, f"{where}: {name}") for name, value in run.parameters.items()}
    _check_commands(run, entries, where)
    given = factors.read(run.factors, known.schema, where)
    grown = factors.multiplied(merged(settings.profile.plant, own_plant), given, known.schema, where)
    plant = merged(grown, settings.changes.plant)
    parameters = {**settings.profile.parameters, **own, **settings.changes.parameters}
    about = {
        "scenario": scenario.id,
        "run": run.name,
        "profile": settings.profile.name,
        "seed": settings.seed,
        "revision": settings.revision,
        "firmware": settings.firmware,
        "changes": settings.changes.words,
        "parameters_from": settings.parameters_from,
        "motor": scenario.motor,
        "plant": plant,
        "machine": _machine(plant, known.schema),
        "observer": {name: parameters.get(name, entries[name].default) for name in _OBSERVER},
        "parameters": parameters,
        "not_stated": list(settings.profile.not_stated),
        "load": run.load,
        "duration": run.duration,
    }
    if settings.image:
        about["image"] = settings.image.file.name
    file = f"{scenario.id}-{run.name}.parquet"
    return Job(scenario.id, run, plant, parameters, settings.seed, file, about, known.units, settings.image)


def _machine(plant: Plant, schema: core.Schema) -> dict[str, float]:
    """The true machine that a plant describes, in SI units; the resistance includes that of one device."""

    def entry(section: str, key: str) -> float:
        return float(plant.get(section, {}).get(key, schema[section][key].default))

    def true(key: str) -> float:
        return entry("machine", key) * (1.0 + entry("parameter_error", key))

    def device(key: str) -> float:
        return (entry("inverter", f"switch_{key}") + entry("inverter", f"diode_{key}")) / 2.0

    saturates = bool(entry("machine", "saturation"))
    cross = entry("machine", "cross_inductance") * (1.0 + entry("parameter_error", "inductance_q"))
    return {
        "pole_pairs": entry("machine", "pole_pairs"),
        "inertia": entry("mechanics", "inertia") * (1.0 + entry("parameter_error", "inertia")),
        "resistance": true("resistance") + device("resistance"),
        "device_drop": device("threshold"),
        "flux_linkage": true("magnet_flux"),
        "inductance_d": true("inductance_d"),
        "inductance_q": true("inductance_q"),
        "magnet_flux": true("magnet_flux"),
        **{f"nameplate_{key}": entry("machine", key) for key in ("inductance_d", "inductance_q", "magnet_flux")},
        "cross_saturation": cross / entry("machine", "rated_peak_current") if saturates else 0.0,
        "knee": 2.0 * entry("machine", "rated_peak_current") if saturates else 0.0,
    }


def _check_commands(run: Run, known: Mapping[str, Entry], where: str) -> None:
    for _, what, value in run.commands:
        if what not in COMMANDS:
            core.parameter(known, what.removeprefix("set:"), value, f"{where}: {what}")


def play(
    native: NativeCore, job: Job, progress: core.Progress | None, recording: NativeStepLoop | None = None
) -> NativeResult:
    """The run itself; `recording` gets every period of it."""
    run = job.run
    return native.run(
        plant=job.plant,
        parameters=job.parameters,
        commands=list(run.commands),
        load=list(run.load),
        duration=run.duration,
        max_start=run.max_start,
        record_every=run.record_every,
        waveform=run.waveform or (0.0, 0.0, 1),
        seed=job.seed,
        progress=progress,
        recording=recording,
    )


def execute(job: Job, directory: Path, progress: Callable[[float], bool] | None) -> Outcome:
    """Run it and write its record into `directory`. Never raises for what happens inside the run.

    Args:
        job: the run.
        directory: where the Parquet file goes.
        progress: gets the share done (0 … 1); false breaks the run off.
    """
    native = core.load()
    run = job.run
    try:
        result, notes = _played(native, job, progress)
    except (RuntimeError, ValueError, ArithmeticError) as error:
        return Outcome(job.scenario, run.name, _one_line(error), None)
    broken = _broken(result, run)
    about = {**job.about, "broken": broken, "faults": [list(fault) for fault in result.faults], "notes": list(notes)}
    records.write(directory / job.file, result.signals, about, job.units)
    looked = _write_waveform(directory, job, result)
    stats = {name: float(value) for name, value in result.stats.items()}
    return Outcome(job.scenario, run.name, broken, job.file, looked, stats, notes)


def _played(native: NativeCore, job: Job, progress: core.Progress | None) -> tuple[NativeResult, tuple[str, ...]]:
    if job.image is None:
        return play(native, job, progress), ()
    played = closed_loop.play(native, job, job.image, progress)
    return played, tuple(played.notes)


def _write_waveform(directory: Path, job: Job, result: NativeResult) -> str | None:
    """The name of the file, None when there was nothing to look into."""
    if job.run.waveform is None or not result.waveform["raster"]["time"].size:
        return None
    name = job.file.replace(".parquet", ".waveform.parquet")
    records.write_waveform(directory / name, result.waveform, job.about)
    return name


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


def _broken(result: NativeResult, run: Run) -> str | None:
    """Why the run does not count."""
    if not result.completed:
        return result.reason or "broken off without a reason"
    if result.faults:
        at, words = result.faults[0]
        return f"fault at {at:.3f} s: {words}"
    if np.asarray(result.signals["time"]).size < 2:
        return "nothing was recorded"
    return figures.shaft_problem(dict(result.signals), run)
