"""Options that several commands have."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from stillspin.errors import InputError


def whole(name: str, low: int, high: int) -> Callable[[str], int]:
    """A parser of whole numbers that says what was given and what is allowed."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise InputError(f"{name} '{text}': must be a whole number, {low} … {high}")
        return value

    return parse


ProfileOption = Annotated[
    str, typer.Option("--profile", "-p", help="The plant: a name from `stillspin list`, or a TOML file.")
]
MotorOption = Annotated[
    str,
    typer.Option("--motor", metavar="NAME", help="The machine and its board: a name from `stillspin list`, or a file."),
]
SeedOption = Annotated[
    int,
    typer.Option(
        "--seed",
        metavar="N",
        parser=whole("--seed", 0, 2**32 - 1),
        help="Seed of the noise: the same seed, the same run.",
    ),
]
ChangeOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change an entry of the plant (section.entry=value) or a firmware parameter (name=value). Repeatable.",
    ),
]


ParamsOption = Annotated[
    Path | None,
    typer.Option("--params", metavar="FILE", help="Firmware parameters, such as `commission` writes them."),
]


JobsOption = Annotated[
    int | None,
    typer.Option(
        "--jobs",
        "-j",
        metavar="N",
        parser=whole("--jobs", 1, 256),
        help="Runs at a time [default: one per processor].",
    ),
]
