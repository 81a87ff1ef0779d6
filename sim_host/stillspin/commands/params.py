"""`stillspin params`: the firmware's table; `dump`, `diff` and `load` between a drive and a file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, resources, whole_file
from stillspin.commands.connection import DriveOption, opened, say_unsaved
from stillspin.counted import counted
from stillspin.drive import Drive, parameter_file
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import DriveError
from stillspin.one_line_errors import OneLineErrors
from stillspin.report import tables

DEFAULTS = "defaults"
DRIVE = "drive"

app = typer.Typer(
    cls=OneLineErrors,
    help="The firmware's parameters: the table; dump, diff and load. What each one does:\n\n\b\n"
    + resources.page("parameters"),
    rich_markup_mode=None,
)


@app.callback(invoke_without_command=True)
def table(context: typer.Context) -> None:
    """The parameters of the firmware in this package: number, name, range, default, meaning."""
    if context.invoked_subcommand is None:
        tables.parameters(core.known_parameters().values())


@app.command()
def dump(
    *,
    file: Annotated[Path | None, typer.Argument(help="The file to write [default: to the terminal].")] = None,
    where: DriveOption = "",
    changed: Annotated[bool, typer.Option("--changed", help="Only what differs from the defaults.")] = False,
) -> None:
    """Write the drive's parameters as TOML."""
    with opened(where) as drive:
        values = drive.parameters()
        if changed:
            values = {name: value for name, value in values.items() if value != drive.table.parameter(name).initial}
        about = [f"Parameters of a drive with firmware {drive.identity.text}."]
        content = parameter_file.text(values, drive.table, about)
    if file:
        whole_file.write(file, content)
        print(f"{counted(len(values), 'parameter')}; see {file}")
    else:
        print(content, end="")


@app.command()
def diff(
    *,
    one: Annotated[str, typer.Argument(help="A file, or 'defaults'.")],
    other: Annotated[str, typer.Argument(help="A file, 'defaults' or 'drive'.")] = DRIVE,
    where: DriveOption = "",
) -> None:
    """Compare a file with the drive, or with another file; what a file does not name is not compared.

    Exit status 4 when they differ.
    """
    with opened(where) as drive:
        first, second = (_side(name, drive) for name in (one, other))
        named = [name for name in first if name in second]
        rows = parameter_file.differences(first, second, drive.table, named)
    tables.differences(rows, one, other)
    print(f"{counted(len(rows), 'parameter', len(named))} different")
    if rows:
        raise typer.Exit(ExitCode.DIFFERS)


def _side(name: str, drive: Drive) -> dict[str, float]:
    if name == DRIVE:
        return drive.parameters()
    if name == DEFAULTS:
        return {parameter.name: parameter.initial for parameter in drive.table.parameters}
    return parameter_file.read(Path(name), drive.table, drive.parameters())


@app.command()
def load(
    *,
    file: Annotated[Path, typer.Argument(help="A file as `dump` writes it.")],
    where: DriveOption = "",
    save: Annotated[bool, typer.Option("--save", help="Keep them in the drive's store.")] = False,
) -> None:
    """Put the values of a file into the drive; all are checked before the first is sent."""
    with opened(where) as drive:
        wanted = parameter_file.read(file, drive.table, drive.parameters())
        drive.set_scales(wanted)
        rows = parameter_file.differences(drive.parameters(), wanted, drive.table, wanted)
        complaints = parameter_file.put(drive, rows)
        tables.differences(rows, "before", str(file))
        if not complaints and save:
            drive.save()
        after = drive.parameters()
        say_unsaved(drive)
    changed = sum(after[parameter.name] == value for parameter, _, value in rows)
    print(f"{counted(changed, 'parameter', len(wanted))} changed{', saved' if save and not complaints else ''}")
    for words in complaints:
        print(f"stillspin: {words}", file=sys.stderr)
    if complaints:
        raise DriveError(f"the drive does not take all of {file}{'; nothing was saved' if save else ''}")
