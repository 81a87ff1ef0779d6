"""`stillspin list` and `stillspin version`: what there is, and of which state."""

from __future__ import annotations

from typing import Annotated

import typer

from stillspin import __version__, core, resources
from stillspin.cases import scenario_file
from stillspin.commands.connection import opened
from stillspin.drive.own import firmware
from stillspin.report import tables
from stillspin.revision import revision


def list_() -> None:
    """The scenarios, the profiles and the motors, and what campaigns draw from."""
    tables.scenarios(scenario_file.load(identifier) for identifier in scenario_file.ids())
    print()
    for kind in ("profiles", "motors", "spreads", "faults"):
        more = "; other people's: stillspin motor list" if kind == "motors" else ""
        print(f"{kind}: {', '.join(resources.names(kind))}{more}")


def own() -> str:
    """What this is: version, revision, and the virtual drive where there is one, with its edition.

    Raises:
        InputError: the edition or board that the environment asks for is not built.
    """
    head = f"stillspin {__version__} ({revision()})"
    if not core.is_there():
        return head
    others = core.other_editions()
    more = f"; {core.EDITION} chooses another edition: {', '.join(others)}" if others else ""
    return f"{head}\nvirtual drive: {firmware()}{more}"


def version(
    *,
    where: Annotated[
        str, typer.Option("--drive", "-d", metavar="ADDRESS", help="The drive to ask, such as /dev/ttyUSB0.")
    ] = "",
) -> None:
    """The version, the sources' revision, the virtual drive's edition; with --drive those of a drive, too."""
    print(own())
    if where:
        with opened(where) as drive:
            print(f"drive: {drive.identity.text}")
