"""`stillspin startup-matrix`: starts from every angle, under loads and errors of the parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.exit_codes import ExitCode
from stillspin.options import ClusterOption, JobsOption, ProfileOption, processors, whole
from stillspin.report import junit, output, startup_report, tables
from stillspin.report.junit import JunitOption
from stillspin.report.progress import Counter
from stillspin.runs import startup
from stillspin.runs.workers import Where


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
    cluster: ClusterOption = "",
    junit_file: JunitOption = None,
) -> None:
    """Start from every angle, under loads and parameter errors, standing and turning; exit status 1 when one fails."""
    common, linear = startup.bench(profile_name)
    todo = startup.chosen(startup.cases(seeds, quick, linear), way or [])
    with junit.Report(junit_file, "startup-matrix", firmware) as verdicts, output.fresh_directory(out) as directory:
        with Counter(Console(stderr=True), len(todo)) as counter:

            def told(outcome: startup.Outcome) -> None:
                verdicts.add([junit.of_start(outcome)])
                counter.one_more(outcome)

            outcomes = startup.run_all(common, todo, Where(jobs or processors(), cluster), told)
        startup_report.write(directory, outcomes, profile_name)
    tables.startup(startup_report.rows(outcomes))
    failed = [outcome for outcome in outcomes if outcome.problem]
    print(f"{counted(len(outcomes) - len(failed), 'start', len(outcomes))} good; see {out}")
    if failed:
        raise typer.Exit(ExitCode.SHORT)
