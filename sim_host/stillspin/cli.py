"""The command line `stillspin`.

What is wrong is said in one line, and the exit status is one of exit_codes.py.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import __version__, commands, core, resources
from stillspin.board import power, serve
from stillspin.cases import drift, profile, scenario_file
from stillspin.cases.scenario import Scenario
from stillspin.commands.connection import opened
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.one_line_errors import HELP, OneLineErrors
from stillspin.options import (
    ChangeOption,
    JobsOption,
    MotorOption,
    OtherMotorOption,
    ParamsOption,
    ProfileOption,
    SeedOption,
    by_mark,
    number,
    processors,
    whole,
)
from stillspin.report import explain_report, junit, output, startup_report, tables
from stillspin.report import page as report
from stillspin.report.junit import JunitOption
from stillspin.report.progress import Counter, PhaseBar
from stillspin.revision import revision
from stillspin.runs import commission, execute, explain, startup
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.reproduction import Options, carry_out, write_found

app = typer.Typer(
    cls=OneLineErrors,
    help="Tools of the drive: run its firmware on a simulated inverter and motor, or work with a board.",
    rich_markup_mode=None,
    context_settings=HELP,
    epilog="To begin: `stillspin board --serial-link /tmp/drive` is a virtual drive; in a second terminal "
    "`stillspin console --drive /tmp/drive` talks to it, and `stillspin tune --drive /tmp/drive` is its page.",
)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"stillspin {__version__} ({revision()})")
        raise typer.Exit


@app.callback()
def _common(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    pass


def _on(motor: str | None, scenario: Scenario) -> Scenario:
    """The scenario on another motor than its own, where one is wanted."""
    return scenario if motor is None else replace(scenario, motor=motor)


def _carry_out(scenarios: Sequence[Scenario], options: Options, verdicts: junit.Report | None = None) -> None:
    """Run scenarios, print what came out, and end the process when a run broke off or a goal is missed."""
    done = carry_out(scenarios, options)
    if verdicts:
        verdicts.add(junit.of_refused(words) for words in done.refused)
    tables.summary(done.results, done.beside)
    total = report.tally(done.results)
    print(f"{total.met} of {total.goals} goals met, {total.broken} runs broken off; see {options.out / report.PAGE}")
    for item in done.beside:
        beside = report.tally(list(item.results.values()))
        lost = sum(len(result.lost) for result in item.results.values())
        print(f"{item.variant.title}: {beside.met} of {beside.goals} goals met, {lost} runs lost")
    for words in done.refused:
        print(f"stillspin: {words}", file=sys.stderr)
    broken = [outcome for result in done.results for outcome in result.broken]
    for outcome in broken:
        print(f"stillspin: {outcome.scenario}, run {outcome.run}: broken off: {outcome.broken}", file=sys.stderr)
    if broken or done.refused or total.met < total.goals:
        raise typer.Exit(ExitCode.SHORT)


@app.command()
def run(
    *,
    scenario: Annotated[str, typer.Argument(help="Id of the scenario, such as A10.")],
    profile_name: ProfileOption = "bench",
    motor: OtherMotorOption = None,
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Directory of the results [default: results-SCENARIO].")
    ] = None,
    no_plots: Annotated[bool, typer.Option("--no-plots", help="Write no plots.")] = False,
) -> None:
    """Run one scenario: figures of merit, plots, and a Parquet file per run."""
    chosen = scenario_file.load(scenario)
    where = out or Path(f"results-{chosen.id}")
    _carry_out([_on(motor, chosen)], Options(profile_name, seed, where, change or [], draw=not no_plots, params=params))


@app.command()
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
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the report.")] = Path("results"),
    jobs: JobsOption = None,
    commission_first: Annotated[
        bool,
        typer.Option(
            "--commission/--no-commission",
            help="Let the drive measure machine and inverter first where the profile differs from the nameplate.",
        ),
    ] = True,
    nameplate: Annotated[
        bool,
        typer.Option("--nameplate/--no-nameplate", help="Run everything on the nameplate's parameters, too."),
    ] = True,
    paper_scheme: Annotated[
        bool,
        typer.Option(
            "--paper-scheme/--no-paper-scheme",
            help="Run the scenarios about the position error with the paper's position scheme, too.",
        ),
    ] = True,
    junit_file: JunitOption = None,
) -> None:
    """Commission the drive, run scenarios in parallel and write report.html and metrics.json."""
    chosen = _chosen(scenarios or [], motor or [])
    own = {scenario.id for scenario in chosen}
    verdicts = junit.Report(junit_file, "reproduce")

    def told(result: ScenarioResult) -> None:
        if result.scenario.id in own:
            verdicts.add(junit.of_scenario(result))

    workers = jobs or processors()
    options = Options(
        profile_name,
        seed,
        out,
        jobs=workers,
        params=params,
        commission=commission_first,
        paper_scheme=paper_scheme,
        nameplate=nameplate,
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
    return [_on(motors[0] if motors else None, scenario_file.load(name)) for name in ids]


@app.command(name="drift")
def drift_(
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
) -> None:
    """Commission the drive, then change the plant (drift); exit status 1 when a figure is beyond twice its goal."""
    listed, drifts = drift.load(core.plant_schema(core.load()))
    ids = dict.fromkeys(scenario_file.find(name).stem for name in scenarios or listed)
    workers = jobs or processors()
    chosen = by_mark(drifts, only or [], "drift")
    options = Options(profile_name, seed, out, jobs=workers, params=params, commission=True, others=chosen)
    done = carry_out([scenario_file.load(identifier) for identifier in ids], options)
    short = tables.drift(done.results, done.beside)
    print(f"{short} figures miss the goal of a plant that has drifted; see {out / report.PAGE}")
    if short or done.refused:
        raise typer.Exit(ExitCode.SHORT)


@app.command(name="explain")
def explain_(
    *,
    scenario: Annotated[str, typer.Argument(help="Id of the scenario, such as A10.")],
    profile_name: ProfileOption = "bench",
    motor: OtherMotorOption = None,
    seed: SeedOption = 1,
    params: ParamsOption = None,
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="MARK", help="Only this effect, such as cogging. Repeatable.")
    ] = None,
    alone: Annotated[
        bool, typer.Option("--alone/--no-alone", help="Run each effect alone on profile ideal, too.")
    ] = True,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Directory of the results [default: results-explain-SCENARIO].")
    ] = None,
    jobs: JobsOption = None,
) -> None:
    """Run a scenario without each effect of the plant in turn, and with each alone, to see which one counts."""
    chosen = _on(motor, scenario_file.load(scenario))
    where = out or Path(f"results-explain-{chosen.id}")
    workers = jobs or processors()
    found = explain.carry_out(chosen, explain.Options(profile_name, seed, where, workers, params, only or [], alone))
    tables.explanation(found)
    for run_name, words in found.broken.items():
        print(f"stillspin: {chosen.id}, {run_name}: broken off: {words}", file=sys.stderr)
    print(f"see {where / explain_report.PICTURE} and {where / output.MARK}")
    if found.broken:
        raise typer.Exit(ExitCode.SHORT)


@app.command(name="commission")
def commission_(
    *,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
    change: ChangeOption = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="The parameter file to write.")] = Path("params.toml"),
) -> None:
    """Let the drive measure motor and inverter; write the parameters that it found, for `run --params`."""
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor)
    profile.say_not_stated(chosen)
    changes = profile.changes(change or [], schema, known)
    commission.check_target(out)
    with PhaseBar(Console(stderr=True)) as bar:
        result = commission.run(native, chosen, changes, seed, bar.show)
    tables.commissioning(result)
    write_found(out, result, execute.Settings(chosen, changes, seed, revision(), firmware=firmware()))
    found = len(result.values) - len(result.refused)
    print(f"{found} of {len(result.values)} values found in {result.duration:.1f} s of the drive's time")
    print(f"they are in {out} and in no drive: 'stillspin params load {out} --save' puts them into one")
    for value in result.refused:
        print(f"stillspin: {value.name} keeps its value: {value.words}", file=sys.stderr)
    if result.refused:
        raise typer.Exit(ExitCode.SHORT)


@app.command(name="board")
def board_(
    *,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    speed: Annotated[
        float,
        typer.Option(
            "--speed",
            parser=number("--speed", 0),
            metavar="N",
            help="Speed as a multiple of real time; 0 is as fast as possible.",
        ),
    ] = 1.0,
    serial_link: Annotated[
        Path | None,
        typer.Option("--serial-link", metavar="PATH", help="Symbolic link to the port: a name that stays the same."),
    ] = None,
    can_link: Annotated[
        Path | None,
        typer.Option(
            "--can-link", metavar="PATH", help="Symbolic link to the SLCAN adapter: a name that stays the same."
        ),
    ] = None,
    socketcan: Annotated[
        str | None,
        typer.Option(
            "--socketcan", metavar="NAME", help="A CAN interface of the kernel, instead of the SLCAN adapter."
        ),
    ] = None,
    eeprom: Annotated[
        Path | None,
        typer.Option("--eeprom", metavar="FILE", help="Keeps what the drive saves from one start to the next."),
    ] = None,
    load: Annotated[
        float,
        typer.Option("--load", parser=number("--load", unit="Nm"), metavar="NM", help="Load torque on the shaft."),
    ] = 0.0,
    end: Annotated[
        float | None,
        typer.Option(
            "--for",
            parser=number("--for", 0, unit="s"),
            metavar="SECONDS",
            help="Switch off after so many seconds of the board's time.",
        ),
    ] = None,
    parent: Annotated[
        int | None, typer.Option("--parent", metavar="PID", help="Switch off when this process, its parent, is gone.")
    ] = None,
) -> None:
    """Run a virtual board in real time; its serial port is a pseudo-terminal. Ctrl-C switches it off."""
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor)
    profile.say_not_stated(chosen)
    changes = profile.changes(change or [], schema, known)
    if params:
        changes.parameters = {**commission.load(params, known), **changes.parameters}
        changes.words.append(f"--params {params.name}")
    title = f"motor {chosen.motor}, profile {chosen.name}, seed {seed}" + "".join(
        f", {words}" for words in changes.words
    )
    board = power.power(native, chosen, changes, seed)
    serve.serve(board, serve.Options(speed, serial_link, can_link, socketcan, load, end, eeprom, parent), title)


@app.command(name="startup-matrix")
def startup_matrix(
    *,
    profile_name: ProfileOption = "bench",
    seeds: Annotated[
        int, typer.Option("--seeds", metavar="N", parser=whole("--seeds", 1, 100), help="Noise seeds of each case.")
    ] = 3,
    quick: Annotated[bool, typer.Option("--quick", help="About a hundred representative starts, in seconds.")] = False,
    way: Annotated[
        list[str] | None,
        typer.Option("--way", metavar="WAY", help="Only this kind of start: brake, free or flying. Repeatable."),
    ] = None,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the results.")] = Path("results-startup"),
    jobs: JobsOption = None,
    junit_file: JunitOption = None,
) -> None:
    """Start from every angle, under loads and parameter errors, standing and turning; exit status 1 when one fails."""
    common, linear = startup.bench(profile_name)
    todo = startup.chosen(startup.cases(seeds, quick, linear), way or [])
    with junit.Report(junit_file, "startup-matrix") as verdicts, output.fresh_directory(out) as directory:
        with Counter(Console(stderr=True), len(todo)) as counter:

            def told(outcome: startup.Outcome) -> None:
                verdicts.add([junit.of_start(outcome)])
                counter.one_more(outcome)

            outcomes = startup.run_all(common, todo, jobs or processors(), told)
        startup_report.write(directory, outcomes, profile_name)
    tables.startup(startup_report.rows(outcomes))
    failed = [outcome for outcome in outcomes if outcome.problem]
    print(f"{len(outcomes) - len(failed)} of {len(outcomes)} starts are good; see {out}")
    if failed:
        raise typer.Exit(ExitCode.SHORT)


@app.command(name="list")
def list_() -> None:
    """The scenarios, the profiles and the motors."""
    tables.scenarios(scenario_file.load(identifier) for identifier in scenario_file.ids())
    print(f"\nprofiles: {', '.join(resources.names('profiles'))}")
    print(f"motors: {', '.join(resources.names('motors'))}")


@app.command()
def version(
    *,
    where: Annotated[
        str, typer.Option("--drive", "-d", metavar="ADDRESS", help="The drive to ask, such as /dev/ttyUSB0.")
    ] = "",
) -> None:
    """The version, and the revision of the sources; with --drive that of the drive's firmware, too."""
    print(f"stillspin {__version__} ({revision()})")
    if where:
        with opened(where) as drive:
            print(f"drive: {drive.identity.text}")


commands.register(app)


def main() -> None:
    """Entry point of the console script."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a file on Windows takes 250 letters; "?" for the rest
    app()
