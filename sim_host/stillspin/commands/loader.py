"""`stillspin loader`: a virtual board that waits for `stillspin flash`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stillspin.board import loader as virtual
from stillspin.commands.flash import kernel_beside
from stillspin.flash.files import kernel_program
from stillspin.options import number


def loader(
    *,
    file: Annotated[Path, typer.Argument(metavar="FLASH", help="Keeps the flash; a new board when not there.")],
    kernel_file: Annotated[
        Path | None,
        typer.Option("--kernel", metavar="FILE", help="The flash kernel to expect [default: the one beside FLASH]."),
    ] = None,
    link: Annotated[
        Path | None, typer.Option("--serial-link", metavar="PATH", help="A name for the port that stays the same.")
    ] = None,
    speed: Annotated[
        float,
        typer.Option(
            "--speed", parser=number("--speed", 0), metavar="N", help="Times real time; 0 is as fast as possible."
        ),
    ] = 1.0,
) -> None:
    """Put a virtual board in serial boot on the desk, to try `stillspin flash`; Ctrl-C switches it off.

    What is downloaded is C28x code and does not run here: the kernel's C stands in for its own image and no other.
    """
    virtual.serve(file, kernel_program(kernel_file or kernel_beside(file)), link, speed)
