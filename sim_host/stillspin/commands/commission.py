"""`stillspin commission`: the virtual drive measures its machine and inverter."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core, resources
from stillspin.cases import profile
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.exit_codes import ExitCode
from stillspin.options import ChangeOption, MotorOption, ProfileOption, SeedOption
from stillspin.report import tables
from stillspin.report.progress import PhaseBar
from stillspin.revision import revision
from stillspin.runs import commission as commissioning
from stillspin.runs import execute
from stillspin.studies.reproduction import write_found


def commission(
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
    changes = profile.changes(change or [], schema, known, chosen.parameters)
    commissioning.check_target(out)
    with PhaseBar(Console(stderr=True)) as bar:
        result = commissioning.run(native, chosen, changes, seed, bar.show)
    tables.commissioning(result)
    write_found(out, result, execute.Settings(chosen, changes, seed, revision(), firmware=firmware()))
    found = len(result.values) - len(result.refused)
    print(f"{counted(found, 'value', len(result.values))} found in {result.duration:.1f} s of the drive's time")
    print(f"they are in {out} and in no drive: 'stillspin params load {out} --save' puts them into one")
    if result.told.get("start_method") == 1.0:
        print(
            "the motor shows next to no saliency: at rest its angle is not known; a current vector (if_current) turns "
            "it at the start and below if_speed, and carries slowly changing loads there"
        )
    for value in result.refused:
        print(f"stillspin: {value.name} keeps its value: {value.words}", file=sys.stderr)
    if result.refused:
        raise typer.Exit(ExitCode.SHORT)
