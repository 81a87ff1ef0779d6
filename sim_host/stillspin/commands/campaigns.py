"""`stillspin run`, `reproduce` and `drift`: scenarios on the virtual drive, measured and judged."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, resources
from stillspin.board.image import blocks_of
from stillspin.cases import scenario_file
from stillspin.cases.scenario import Scenario
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.image import opened
from stillspin.image.opened import Image
from stillspin.options import (
    NEEDS_IMAGE,
    ChangeOption,
    ClusterOption,
    CommissionOption,
    JobsOption,
    OtherMotorOption,
    ParamsOption,
    ProfileOption,
    RomOption,
    RunImageOption,
    SchemeOption,
    SeedOption,
    by_mark,
    processors,
)
from stillspin.report import junit, tables
from stillspin.report import page as report
from stillspin.report.junit import JunitOption
from stillspin.runs import drift as drifts
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.workers import Where
from stillspin.studies.reproduction import Options, carry_out


def on_motor(motor: str | None, scenario: Scenario) -> Scenario:
    """The scenario on another motor than its own, where one is wanted."""
    return scenario if motor is None else replace(scenario, motor=motor)


def _carry_out(scenarios: Sequence[Scenario], options: Options, verdicts: junit.Report | None = None) -> None:
    """Run scenarios, print what came out, and end the process when a run broke off or a goal is missed."""
    done = carry_out(scenarios, options)
    if verdicts:
        verdicts.add(junit.of_refused(words) for words in done.refused)
    tables.summary(done.results, done.beside, "image" if options.image else "value")
    for result in done.results:
        for outcome in result.outcomes:
            for words in outcome.notes:
                print(f"{outcome.scenario}, run {outcome.run}: {words}")
    total = report.tally(done.results)
    reached = f"{counted(total.met, 'goal', total.goals)} met, {counted(total.broken, 'run')} broken off"
    print(f"{reached}; see {options.out / report.PAGE}")
    for item in done.beside:
        beside = report.tally(list(item.results.values()))
        lost = sum(len(result.lost) for result in item.results.values())
        print(f"{item.variant.title}: {counted(beside.met, 'goal', beside.goals)} met, {counted(lost, 'run')} lost")
    for words in done.refused:
        print(f"stillspin: {words}", file=sys.stderr)
    broken = [outcome for result in done.results for outcome in result.broken]
    for outcome in broken:
        print(f"stillspin: {outcome.scenario}, run {outcome.run}: broken off: {outcome.broken}", file=sys.stderr)
    if broken or done.refused or total.met < total.goals:
        raise typer.Exit(ExitCode.SHORT)


def _image(file: Path | None, rom: Path | None) -> Image | None:
    """What is to be executed; it is said before anything runs when it cannot be."""
    if file is None:
        if rom:
            raise InputError(NEEDS_IMAGE)
        return None
    image = opened.read(file, rom)
    blocks_of(image.program, str(file))
    return image


def run(
    *,
    scenario: Annotated[str, typer.Argument(help="Id of the scenario, such as A10, or a TOML file.")],
    profile_name: ProfileOption = "bench",
    motor: OtherMotorOption = None,
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    scheme: SchemeOption = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Directory of the results [default: results-SCENARIO].")
    ] = None,
    no_plots: Annotated[bool, typer.Option("--no-plots", help="Write no plots.")] = False,
    image: RunImageOption = None,
    rom: RomOption = None,
) -> None:
    """Run one scenario: figures of merit, plots, and a Parquet file per run."""
    chosen = _scenario(scenario)
    where = out or Path(f"results-{chosen.id}")
    _carry_out(
        [on_motor(motor, chosen)],
        Options(
            profile_name,
            seed,
            where,
            change or [],
            draw=not no_plots,
            params=params,
            scheme=scheme,
            image=_image(image, rom),
        ),
    )


def _scenario(name_or_path: str) -> Scenario:
    """One that ships, or one in a file."""
    is_path = name_or_path.endswith(".toml") or "/" in name_or_path
    return scenario_file.read(Path(name_or_path)) if is_path else scenario_file.load(name_or_path)


def reproduce(
    *,
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(metavar="[ID]...", help="Scenarios [default: all of the motor but those on demand]."),
    ] = None,
    profile_name: ProfileOption = "bench",
    motor: Annotated[
        list[str] | None,
        typer.Option(
            "--motor",
            metavar="NAME",
            help="All scenarios of this motor, repeatable [default: A]; or, with an ID, another one for it.",
        ),
    ] = None,
    seed: SeedOption = 1,
    params: ParamsOption = None,
    scheme: SchemeOption = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the report.")] = Path("results"),
    jobs: JobsOption = None,
    cluster: ClusterOption = "",
    commission_first: CommissionOption = True,
    nameplate: Annotated[
        bool,
        typer.Option("--nameplate/--no-nameplate", help="Run everything on the nameplate's parameters, too."),
    ] = True,
    paper_scheme: Annotated[
        bool,
        typer.Option(
            "--paper-scheme/--no-paper-scheme",
            help="Run the scenarios of the paper's figures and of the position error with the paper's own scheme, too.",
        ),
    ] = True,
    image: RunImageOption = None,
    rom: RomOption = None,
    junit_file: JunitOption = None,
) -> None:
    """Commission the drive, run scenarios in parallel and write report.html and metrics.json.

    With --image the native drive is commissioned, and the image gets what it has found.
    """
    chosen = _chosen(scenarios or [], motor or [])
    own = {scenario.id for scenario in chosen}
    verdicts = junit.Report(junit_file, "reproduce", firmware)

    def told(result: ScenarioResult) -> None:
        if result.scenario.id in own:
            verdicts.add(junit.of_scenario(result))

    options = Options(
        profile_name,
        seed,
        out,
        where=Where(jobs or processors(), cluster),
        params=params,
        scheme=scheme,
        commission=commission_first,
        paper_scheme=paper_scheme,
        nameplate=nameplate,
        image=_image(image, rom),
        told=told,
    )
    with verdicts:
        _carry_out(chosen, options, verdicts)


def _chosen(names: Sequence[str], motors: Sequence[str]) -> list[Scenario]:
    """The scenarios named, on the motor given if there is one; else all that motors have."""
    if not names:
        ids = scenario_file.campaign_ids(motors or [resources.DEFAULT_MOTOR])
        if not ids:
            raise InputError(f"--motor {', '.join(motors)}: there is no scenario for it; name one to run on it")
        return [scenario_file.load(name) for name in ids]
    if len(motors) > 1:
        raise InputError(f"--motor {', '.join(motors)}: name only one motor together with scenarios")
    ids = list(dict.fromkeys(scenario_file.find(name).stem for name in names))
    return [on_motor(motors[0] if motors else None, scenario_file.load(name)) for name in ids]


def drift(
    *,
    scenarios: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="Scenarios [default: those of the list].")
    ] = None,
    profile_name: ProfileOption = "bench",
    seed: SeedOption = 1,
    params: ParamsOption = None,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="MARK", help="Only this drift, such as flux. Repeatable.")
    ] = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the report.")] = Path("results-drift"),
    jobs: JobsOption = None,
    cluster: ClusterOption = "",
) -> None:
    """Commission the drive, then change the plant (drift); exit status 1 when a figure is beyond twice its goal."""
    listed, known = drifts.load(core.plant_schema(core.load()))
    ids = dict.fromkeys(scenario_file.find(name).stem for name in scenarios or listed)
    chosen = by_mark(known, only or [], "drift")
    options = Options(
        profile_name,
        seed,
        out,
        where=Where(jobs or processors(), cluster),
        params=params,
        commission=True,
        others=chosen,
    )
    done = carry_out([scenario_file.load(identifier) for identifier in ids], options)
    short = tables.drift(done.results, done.beside)
    print(f"{counted(short, 'figure')} beyond the goal of a plant that has drifted; see {out / report.PAGE}")
    if short or done.refused:
        raise typer.Exit(ExitCode.SHORT)
