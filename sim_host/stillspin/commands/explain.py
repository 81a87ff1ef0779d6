"""`stillspin explain`: which effect of the plant makes the figures of a scenario."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from stillspin.cases import scenario_file
from stillspin.commands.campaigns import on_motor
from stillspin.exit_codes import ExitCode
from stillspin.options import (
    ClusterOption,
    JobsOption,
    OtherMotorOption,
    ParamsOption,
    ProfileOption,
    SeedOption,
    processors,
)
from stillspin.report import explain_report, output, tables
from stillspin.runs.workers import Where
from stillspin.studies.explain import Options, carry_out


def explain(
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
    cluster: ClusterOption = "",
) -> None:
    """Run a scenario without each effect of the plant in turn, and with each alone, to see which one counts."""
    chosen = on_motor(motor, scenario_file.load(scenario))
    where = out or Path(f"results-explain-{chosen.id}")
    found = carry_out(
        chosen, Options(profile_name, seed, where, Where(jobs or processors(), cluster), params, only or [], alone)
    )
    tables.explanation(found)
    for run_name, words in found.broken.items():
        print(f"stillspin: {chosen.id}, {run_name}: broken off: {words}", file=sys.stderr)
    print(f"see {where / explain_report.PICTURE} and {where / output.MARK}")
    if found.broken:
        raise typer.Exit(ExitCode.SHORT)
