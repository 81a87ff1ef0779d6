"""A campaign from its options to its results: commissioning, runs, variants beside them, report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from rich.console import Console

from stillspin import __version__, campaign, commission, core, execute, output, profile, report, variant
from stillspin.assess import ScenarioResult
from stillspin.core import NativeCore
from stillspin.execute import Settings
from stillspin.progress import Bar, PhaseBar
from stillspin.revision import revision
from stillspin.scenario import Scenario
from stillspin.variant import Beside, Variant

PARAMS = "params.toml"
"""What a campaign's commissioning found, beside its results."""


@dataclass(frozen=True)
class Options:
    """What is wanted.

    Attributes:
        profile: a name or a path; changes: as `--set` takes them; out: the directory of the results.
        jobs: runs at a time; draw: whether to draw.
        params: a parameter file for the drive; None for none.
        commission: whether the drive measures itself first, where the profile is for it and there is no `params`.
        paper_scheme, nameplate: the variants beside; others: and some more.
    """

    profile: str
    seed: int
    out: Path
    changes: list[str] = field(default_factory=list)
    jobs: int = 1
    draw: bool = True
    params: Path | None = None
    commission: bool = False
    paper_scheme: bool = False
    nameplate: bool = False
    others: Sequence[Variant] = ()


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
    settings, own = _settings(native, options)
    screen = Console(stderr=True)
    # What is wrong with the scenarios is said before the drive spends half a minute on measuring itself.
    _check(scenarios, settings, native)
    with output.fresh_directory(options.out) as directory:
        refused: list[str] = []
        if options.commission and not options.params and own.commission:
            settings, refused = _commissioned(native, settings, directory / PARAMS, screen)
        variants: list[Variant] = []
        if options.nameplate and settings.profile.parameters != own.parameters:
            variants.append(variant.nameplate(own))
        if options.paper_scheme:
            variants.append(variant.paper())
        variants += options.others
        todo = [(scenario, settings) for scenario in scenarios]
        todo += [(v.scenario(s), v.settings(settings)) for v in variants for s in scenarios if v.applies(s)]
        jobs = [job for scenario, each in todo for job in execute.prepare(scenario, each, native)]
        runs = directory / output.RUNS
        plan = campaign.Plan([scenario for scenario, _ in todo], jobs, runs, own.name, options.draw)
        with Bar(screen) as bar:
            results, beside = variant.separate(campaign.run_all(plan, options.jobs, bar), variants)
        report.write(directory, results, settings, beside)
    return Reproduction(results, beside, refused)


def _settings(native: NativeCore, options: Options) -> tuple[Settings, profile.Profile]:
    """Settings with the parameters given, and the profile as it is."""
    schema, known = core.plant_schema(native), core.parameters(native)
    own = profile.load(options.profile, schema, known)
    changes = profile.changes(options.changes, schema, known)
    settings = Settings(own, changes, options.seed, revision())
    if options.params:
        settings = _with_file(settings, options.params, native, options.params.name)
    return settings, own


def _check(scenarios: Sequence[Scenario], settings: Settings, native: NativeCore) -> None:
    for scenario in scenarios:
        execute.prepare(scenario, settings, native)


def _commissioned(native: NativeCore, settings: Settings, file: Path, screen: Console) -> tuple[Settings, list[str]]:
    """Settings with what the drive found out on this plant, written to a file, and what it refused."""
    with PhaseBar(screen) as bar:
        found = commission.run(native, settings.profile, settings.changes, settings.seed, bar.show)
    write_found(file, found, settings)
    refused = [f"{value.name} keeps its value: {value.words}" for value in found.refused]
    # Read back, so that a run with --params on this file is the same run.
    return _with_file(settings, file, native, "commissioning on this plant"), refused


def _with_file(settings: Settings, file: Path, native: NativeCore, origin: str) -> Settings:
    told = {**settings.profile.parameters, **commission.load(file, core.parameters(native))}
    return replace(settings, profile=replace(settings.profile, parameters=told), parameters_from=origin)


def write_found(file: Path, found: commission.Result, settings: Settings) -> None:
    """The parameter file of a commissioning, with a head that says where it comes from."""
    name, words = settings.profile.name, settings.changes.words
    about = [f"Commissioned in profile {name}, seed {settings.seed}, stillspin {__version__} ({settings.revision})."]
    about += [f"Changed beforehand: {', '.join(words)}."] if words else []
    commission.write(file, found, about)
