"""The command line `stillspin`.

What is wrong is said in one line, and the exit status is one of exit_codes.py.
"""

from __future__ import annotations

import io
import sys
from typing import Annotated, Any

import typer

from stillspin import commands
from stillspin.one_line_errors import HELP, OneLineErrors


class _CommandLine(OneLineErrors):
    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands: Any = commands.ByName()


app = typer.Typer(
    cls=_CommandLine,
    help="Tools of the drive: run its firmware on a simulated inverter and motor, or work with a board.",
    rich_markup_mode=None,
    context_settings=HELP,
    epilog="To begin: `stillspin board --serial-link /tmp/drive` is a virtual drive; in a second terminal "
    "`stillspin console --drive /tmp/drive` talks to it, and `stillspin tune --drive /tmp/drive` is its page.",
)


def _version(wanted: bool) -> None:
    if wanted:
        print(commands.own_version())
        raise typer.Exit


@app.callback()
def _common(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Entry point of the console script."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a file on Windows takes 250 letters; "?" for the rest
    app()
