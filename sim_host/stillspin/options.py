"""Options that several commands have."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Protocol, TypeVar

import typer

from stillspin.errors import InputError
from stillspin.quantity import Range

Choice = TypeVar("Choice", bound="Marked")


def whole(name: str, low: int, high: int) -> Callable[[str], int]:
    """A parser of whole numbers."""
    allowed = Range(low, high, whole=True)
    return lambda typed: allowed.read_whole(typed, name)


def number(name: str, low: float | None = None, high: float | None = None, unit: str = "") -> Callable[[str], float]:
    """A parser of numbers."""
    allowed = Range(low, high, unit)
    return lambda typed: allowed.read(typed, name)


def processors() -> int:
    """How many this process may use: how many runs go at a time."""
    affinity = getattr(os, "sched_getaffinity", None)  # of Linux alone
    return len(affinity(0)) if affinity else os.cpu_count() or 1


class Marked(Protocol):
    """What `--only` chooses by a mark."""

    @property
    def mark(self) -> str:
        """Unique among its kind."""


def by_mark(items: Sequence[Choice], marks: Sequence[str], kind: str) -> list[Choice]:
    """The items of some marks, or all.

    Raises:
        InputError: there is no such item; `kind` is the word for it.
    """
    known = {item.mark: item for item in items}
    for mark in marks:
        if mark not in known:
            raise InputError(f"--only '{mark}': there is no such {kind}; known: {', '.join(known)}")
    return [known[mark] for mark in marks] if marks else list(items)


ImageArgument = Annotated[
    Path, typer.Argument(help="An .out file of cl2000 (COFF or ELF), Intel hex or a boot stream.")
]
RomOption = Annotated[
    Path | None,
    typer.Option(
        "--rom",
        metavar="FILE",
        help="Words of the boot ROM for the image, such as TI's IQmathTables: a dump from 0x3FF000 on, or a linked "
        "file that has them there.",
    ),
]
NEEDS_IMAGE = "--rom: goes with --image FILE alone; the firmware on this computer reads no boot ROM"
RunImageOption = Annotated[
    Path | None,
    typer.Option(
        "--image",
        metavar="FILE",
        help="Let this image of the C28x drive the plant, told over its serial port; the native drive runs beside it; "
        "both are recorded every 5 ms.",
    ),
]
AfterOption = Annotated[
    float,
    typer.Option(
        "--after",
        parser=number("--after", 0, unit="s"),
        metavar="SECONDS",
        help="Let the image run for this long from power-on first.",
    ),
]
WithinOption = Annotated[
    float,
    typer.Option(
        "--within",
        parser=number("--within", 1e-6, unit="s"),
        metavar="SECONDS",
        help="Give up when a place is not reached within this time.",
    ),
]
ProfileOption = Annotated[
    str, typer.Option("--profile", "-p", help="The plant: a name from `stillspin list`, or a TOML file.")
]
MotorOption = Annotated[
    str,
    typer.Option("--motor", metavar="NAME", help="The machine and its board: a name from `stillspin list`, or a file."),
]
OtherMotorOption = Annotated[
    str | None, typer.Option("--motor", metavar="NAME", help="Another motor than the scenario's own.")
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
SchemeOption = Annotated[
    str | None,
    typer.Option(
        "--scheme",
        metavar="NAME",
        help="Another scheme than the drive's own, such as paper: a set of firmware parameters, or a TOML file of one.",
    ),
]
CommissionOption = Annotated[
    bool,
    typer.Option(
        "--commission/--no-commission",
        help="Let the drive measure machine and inverter first where the profile differs from the nameplate.",
    ),
]
DurationOption = Annotated[
    float,
    typer.Option(
        "--duration",
        parser=number("--duration", 0, unit="s"),
        metavar="S",
        help="End after so many seconds; 0: with Ctrl-C.",
    ),
]
SerialLinkOption = Annotated[
    Path | None,
    typer.Option("--serial-link", metavar="PATH", help="Symbolic link to the port: a name that stays the same."),
]
PaceOption = Annotated[
    float,
    typer.Option(
        "--speed",
        parser=number("--speed", 0),
        metavar="N",
        help="Speed as a multiple of real time; 0 is as fast as possible.",
    ),
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
ClusterOption = Annotated[
    str,
    typer.Option(
        "--cluster",
        metavar="ADDRESS",
        help="Let the workers of this Dask cluster do the runs, such as tcp://host:8786 [default: this computer].",
    ),
]
