"""A campaign from its options to its results: commissioning, runs, variants beside them, report."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from rich.console import Console

from stillspin import __version__, core
from stillspin.cases import profile
from stillspin.cases.scenario import Plot, Scenario
from stillspin.core import NativeCore, Signals
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.extras import need
from stillspin.image.opened import Image
from stillspin.measure import pieces
from stillspin.report import output
from stillspin.report import page as report
from stillspin.report.progress import Bar, PhaseBar
from stillspin.revision import revision
from stillspin.runs import campaign, commission, execute, variant
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.execute import Settings
from stillspin.runs.variant import Beside, Scheme, Variant
from stillspin.runs.workers import Where

PARAMS = "params.toml"
"""What a campaign's commissioning found, beside its results; with the motor's name where there are several."""


@dataclass(frozen=True)
class Options:
    """What is wanted.

    Attributes:
        profile: a name or a path; changes: as `--set` takes them; out: the directory of the results.
        where: by whom; draw: whether to draw.
        params: a parameter file for the drive; None for none.
        scheme: a name or a path, over both what the drive is told and what it finds out; None for its own.
        commission: whether the drive measures itself first, where the profile is for it and there is no `params`.
        paper_scheme, nameplate: the variants beside; others: and some more.
        image: what runs in the place of the firmware for this computer, which then runs beside; None for that alone.
        told: is told of every scenario, also of those beside, as soon as it is measured.
    """

    profile: str
    seed: int
    out: Path
    changes: list[str] = field(default_factory=list)
    where: Where = field(default_factory=Where)
    draw: bool = True
    params: Path | None = None
    scheme: str | None = None
    commission: bool = False
    paper_scheme: bool = False
    nameplate: bool = False
    others: Sequence[Variant] = ()
    image: Image | None = None
    told: Callable[[ScenarioResult], None] = lambda _: None


@dataclass(frozen=True)
class Reproduction:
    """What came of it. `refused`: in words, what the commissioning did not believe."""

    results: list[ScenarioResult]
    beside: list[Beside]
    refused: list[str]


def carry_out(scenarios: Sequence[Scenario], options: Options) -> Reproduction:
    """Run scenarios and write their results; these appear whole or not at all.

    Raises:
        InputError: something asked for does not exist or does not fit together.
        CampaignError: the commissioning broke off, or a worker died.
    """
    native = core.load()
    motors = list(dict.fromkeys(scenario.motor for scenario in scenarios))
    own = {motor: _own(native, options, motor) for motor in motors}
    for each in own.values():
        profile.say_not_stated(each.profile)
    settings = _told(native, own, options)
    chosen = variant.scheme(options.scheme) if options.scheme else None
    screen = Console(stderr=True)
    # What is wrong with the scenarios is said before the drive spends half a minute on measuring itself.
    for scenario in scenarios:
        execute.prepare(scenario, _in_scheme(native, settings[scenario.motor], chosen), native)
    with output.fresh_directory(options.out) as directory:
        refused: list[str] = []
        for motor in motors:
            if options.commission and not options.params and own[motor].profile.commission:
                file = directory / (PARAMS if len(motors) == 1 else f"params-{own[motor].profile.motor}.toml")
                settings[motor], words = _commissioned(native, settings[motor], file, screen)
                refused += words
        own = {motor: _in_scheme(native, each, chosen) for motor, each in own.items()}
        settings = {motor: _in_scheme(native, each, chosen) for motor, each in settings.items()}
        settings = {motor: replace(each, image=options.image) for motor, each in settings.items()}
        variants = [variant.native()] if options.image else _variants(own, settings, options)
        todo = [(scenario, settings[scenario.motor]) for scenario in scenarios]
        todo += [(v.scenario(s), v.settings(settings[s.motor])) for v in variants for s in scenarios if v.applies(s)]
        jobs = [job for scenario, each in todo for job in execute.prepare(scenario, each, native)]
        runs = directory / output.RUNS
        name = own[motors[0]].profile.name
        plan = campaign.Plan([scenario for scenario, _ in todo], jobs, runs, name, _draw if options.draw else None)
        with Bar(screen, options.told) as bar:
            results, beside = variant.separate(campaign.run_all(plan, options.where, bar), variants)
        report.write(directory, results, list(settings.values()), beside)
    return Reproduction(results, beside, refused)


def _draw(plot: Plot, scenario: Scenario, recorded: Mapping[str, Signals], extras: Mapping[str, pieces.Extras]) -> str:
    need("matplotlib")
    from stillspin.report import plots  # noqa: PLC0415 - matplotlib takes a second to load, and not all need it

    return plots.draw(plot, scenario, recorded, extras)


def _own(native: NativeCore, options: Options, motor: str) -> Settings:
    """Settings with the profile on a motor as it is."""
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(options.profile, schema, known, motor)
    changes = profile.changes(options.changes, schema, known, chosen.parameters)
    return Settings(chosen, changes, options.seed, revision(), firmware=firmware())


def _told(native: NativeCore, own: Mapping[str, Settings], options: Options) -> dict[str, Settings]:
    """Settings of each motor with the parameters given."""
    file = options.params
    if not file:
        return dict(own)
    if len(own) > 1:
        raise InputError(f"--params {file}: is of one motor, and the scenarios are about {', '.join(own)}")
    return {motor: _with_file(settings, file, native, file.name) for motor, settings in own.items()}


def _in_scheme(native: NativeCore, settings: Settings, scheme: Scheme | None) -> Settings:
    """Settings whose drive runs in another scheme, where one is wanted: on what it was told, or has found out."""
    if scheme is None:
        return settings
    told = scheme.told(settings.profile, core.parameters(native))
    return replace(settings, profile=told, parameters_from=f"{settings.parameters_from} and the {scheme.title}")


def _variants(own: Mapping[str, Settings], settings: Mapping[str, Settings], options: Options) -> list[Variant]:
    variants: list[Variant] = []
    plates = {each.profile.motor: each.profile for each in own.values()}
    if options.nameplate and any(settings[key].profile.parameters != own[key].profile.parameters for key in own):
        variants.append(variant.nameplate(plates))
    if options.paper_scheme and not options.scheme:
        variants.append(variant.paper())
    return [*variants, *options.others]


def _commissioned(native: NativeCore, settings: Settings, file: Path, screen: Console) -> tuple[Settings, list[str]]:
    """Settings with what the drive found out on this plant, written to a file, and what it refused."""
    with PhaseBar(screen) as bar:
        found = commission.run(native, settings.profile, settings.changes, settings.seed, bar.show)
    write_found(file, found, settings)
    refused = [f"{value.name} keeps its value: {value.words}" for value in found.refused]
    # Read back, so that a run with --params on this file is the same run.
    return _with_file(settings, file, native, "commissioning on this plant"), refused


def _with_file(settings: Settings, file: Path, native: NativeCore, origin: str) -> Settings:
    plate = settings.profile.parameters
    told = {**plate, **commission.load(file, core.parameters(native), plate)}
    return replace(settings, profile=replace(settings.profile, parameters=told), parameters_from=origin)


def write_found(file: Path, found: commission.Result, settings: Settings) -> None:
    """The parameter file of a commissioning, with a head that says where it comes from."""
    plant, words = settings.profile, settings.changes.words
    where = f"Motor {plant.motor}, commissioned in profile {plant.name}, seed {settings.seed}"
    about = [f"{where}, stillspin {__version__} ({settings.revision})."]
    about += [f"Firmware {settings.firmware}."] if settings.firmware else []
    about += [f"Changed beforehand: {', '.join(words)}."] if words else []
    commission.write(file, found, about)
