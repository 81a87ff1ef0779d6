"""The option that says where the drive is, and opening it with a word about what takes time."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from stillspin.drive import Drive
from stillspin.errors import InputError

DriveOption = Annotated[
    str,
    typer.Option(
        "--drive",
        "-d",
        metavar="ADDRESS",
        envvar="STILLSPIN_DRIVE",
        help="serial:///dev/ttyUSB0, can:slcan:/dev/ttyACM0?node=1, can:socketcan:can0, or virtual: (a virtual board).",
    ),
]


def wanted(where: str) -> str:
    """The address, which must be given.

    Raises:
        InputError: it is not.
    """
    if not where:
        raise InputError(
            "no drive is given: --drive /dev/ttyUSB0, or the variable STILLSPIN_DRIVE; virtual: is a virtual board"
        )
    return where


@contextmanager
def opened(where: str) -> Iterator[Drive]:
    """The drive at an address, with a bar on stderr while its table is read for the first time."""
    columns = (TextColumn("reading the drive's table"), BarColumn(), TextColumn("{task.percentage:3.0f} %"))
    screen = Console(stderr=True)
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar:
        task = bar.add_task("", total=1.0, visible=False)
        drive = Drive.open(wanted(where), progress=lambda share: bar.update(task, completed=share, visible=True))
    with drive:
        yield drive


def say_unsaved(drive: Drive) -> None:
    """On stderr, what would be lost with the power; nothing where nothing would, or where nobody can be asked."""
    if not drive.link.lost and (words := drive.status().unsaved_text):
        print(f"stillspin: {words}", file=sys.stderr)
