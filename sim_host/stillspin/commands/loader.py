"""`stillspin loader`: a virtual board that waits for `stillspin flash`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stillspin.board import loader as virtual
from stillspin.commands.flash import kernel_beside
from stillspin.flash.files import kernel_program
from stillspin.options import PaceOption, SerialLinkOption


def loader(
    *,
    file: Annotated[
        Path, typer.Argument(metavar="FLASH", help="File that holds the board's flash; created when missing.")
    ],
    kernel_file: Annotated[
        Path | None,
        typer.Option("--kernel", metavar="FILE", help="The flash kernel to expect [default: the one beside FLASH]."),
    ] = None,
    link: SerialLinkOption = None,
    speed: PaceOption = 1.0,
) -> None:
    """Run a virtual board in serial boot, to try `stillspin flash`; Ctrl-C switches it off.

    Downloaded C28x code cannot run here: the same kernel, compiled for this computer, runs in its place.
    """
    virtual.serve(file, kernel_program(kernel_file or kernel_beside(file)), link, speed)
