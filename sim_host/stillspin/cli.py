"""The command line `stillspin`.

What is wrong is said in one line, and the exit status is one of exit_codes.py.
"""

from __future__ import annotations

import io
import sys
from typing import Annotated

import typer

from stillspin import __version__, commands, resources
from stillspin.cases import scenario_file
from stillspin.commands.connection import opened
from stillspin.one_line_errors import HELP, OneLineErrors
from stillspin.report import tables
from stillspin.revision import revision

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


commands.register(app)


@app.command(name="list")
def list_() -> None:
    """The scenarios, the profiles and the motors, and what campaigns draw from."""
    tables.scenarios(scenario_file.load(identifier) for identifier in scenario_file.ids())
    print()
    for kind in ("profiles", "motors", "spreads", "faults"):
        more = "; other people's: stillspin motor list" if kind == "motors" else ""
        print(f"{kind}: {', '.join(resources.names(kind))}{more}")


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


def main() -> None:
    """Entry point of the console script."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a file on Windows takes 250 letters; "?" for the rest
    app()
