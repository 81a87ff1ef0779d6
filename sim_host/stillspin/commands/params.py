"""`stillspin params`: the firmware's table; `dump`, `diff` and `load` between a drive and a file."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, tables
from stillspin.commands import parameter_file
from stillspin.commands.connection import DriveOption, opened
from stillspin.commands.parameter_file import Difference
from stillspin.drive import Drive, Parameter
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, RefusedError
from stillspin.one_line_errors import OneLineErrors

DEFAULTS = "defaults"
DRIVE = "drive"

app = typer.Typer(
    cls=OneLineErrors, help="The firmware's parameters: the table; dump, diff and load.", rich_markup_mode=None
)


@app.callback(invoke_without_command=True)
def table(context: typer.Context) -> None:
    """The parameters of the firmware in this package: number, name, range, default, meaning."""
    if context.invoked_subcommand is None:
        tables.parameters(core.parameters(core.load()).values())


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
        about = [f"Parameters of a drive with firmware {drive.version}."]
        content = parameter_file.text(values, drive.table, about)
    if file:
        parameter_file.write(file, content)
        print(f"{len(values)} parameters; see {file}")
    else:
        print(content, end="")


@app.command()
def diff(
    *,
    one: Annotated[str, typer.Argument(help="A file, or 'defaults'.")],
    other: Annotated[str, typer.Argument(help="A file, 'defaults' or 'drive'.")] = DRIVE,
    where: DriveOption = "",
) -> None:
    """Compare a file with the drive, or with another file; what a file does not name is not compared."""
    with opened(where) as drive:
        first, second = (_side(name, drive) for name in (one, other))
        named = [name for name in first if name in second]
        rows = parameter_file.differences(first, second, drive.table, named)
    tables.differences(rows, one, other)
    print(f"{len(rows)} of {len(named)} parameters differ")


def _side(name: str, drive: Drive) -> dict[str, float]:
    if name == DRIVE:
        return drive.parameters()
    if name == DEFAULTS:
        return {parameter.name: parameter.initial for parameter in drive.table.parameters}
    return parameter_file.read(Path(name), drive.table)


@app.command()
def load(
    *,
    file: Annotated[Path, typer.Argument(help="A file as `dump` writes it.")],
    where: DriveOption = "",
    save: Annotated[bool, typer.Option("--save", help="Keep them in the drive's store.")] = False,
) -> None:
    """Put the values of a file into the drive; all are checked before the first is sent."""
    with opened(where) as drive:
        wanted = parameter_file.read(file, drive.table)
        rows = parameter_file.differences(drive.parameters(), wanted, drive.table, wanted)
        refused = transfer(drive, rows)
        tables.differences(rows, "before", str(file))
        if not refused and save:
            drive.save()
    kept = ", saved" if save and not refused else ""
    print(f"{len(rows) - len(refused)} of {len(wanted)} parameters changed{kept}")
    for words in refused:
        print(f"stillspin: {words}", file=sys.stderr)
    if refused:
        raise DriveError(f"{len(refused)} values were refused{'; nothing was saved' if save else ''}")


def transfer(drive: Drive, rows: list[Difference], progress: Callable[[Parameter], None] | None = None) -> list[str]:
    """Change parameters one by one. What does not fit yet is tried again when the others are in.

    Returns:
        What the drive says about those that it refused.
    """
    waiting, refused = rows, ["at least one round"]
    while refused:
        again, refused = [], []
        for row in waiting:
            parameter, _, value = row
            if value is None:
                raise InputError(f"{parameter.name}: no value")
            try:
                drive.set(parameter.name, value)
            except RefusedError as error:
                again.append(row)
                refused.append(str(error))
                continue
            if progress:
                progress(parameter)
        if len(again) == len(waiting):
            break
        waiting = again
    return refused
