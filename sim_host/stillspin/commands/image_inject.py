"""`stillspin image inject`: an interrupt at each instruction of a stretch of code, and whether anyone could tell."""

from __future__ import annotations

from typing import Annotated

import typer

from stillspin import resources
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash.names import Names
from stillspin.image import inject as injection
from stillspin.image import opened, vectors
from stillspin.image.inject import Difference, Report, Stretch
from stillspin.options import (
    AfterOption,
    ImageArgument,
    MotorOption,
    ProfileOption,
    RomOption,
    SeedOption,
    WithinOption,
    whole,
)

_MOST_SHOWN = 8


def _watched(texts: list[str], names: Names) -> list[tuple[int, int]]:
    """NAME or NAME:WORDS."""
    found = []
    for text in texts:
        name, mark, count = text.partition(":")
        if mark and not (count.isdigit() and int(count) > 0):
            raise InputError(f"--compare: '{text}' is not NAME or NAME:WORDS, such as COUNT:2")
        found.append((names.address(name, "--compare"), int(count) if mark else 1))
    return found


def _what(difference: Difference, names: Names) -> str:
    if isinstance(difference.what, str):
        return difference.what
    named = next((name for name, address in names.addresses.items() if address == difference.what), "")
    return f"{named} (0x{difference.what:04X})" if named else f"0x{difference.what:04X}"


def _say(report: Report, image: opened.Image) -> None:
    names = image.names
    for address, differences in report.differences:
        print(f"before {names.place(address)}:")
        for one in differences[:_MOST_SHOWN]:
            print(
                f"    {_what(one, names)} is 0x{one.value:X}; with the interrupt before the stretch 0x{one.before:X}, "
                f"behind it 0x{one.after:X}"
            )
        if len(differences) > _MOST_SHOWN:
            print(f"    and {len(differences) - _MOST_SHOWN} more")
    for address, registers in report.spoilt[:1]:
        spoilt = ", ".join(f"{one.what} (0x{one.before:X} is 0x{one.value:X})" for one in registers)
        print(f"not put back by the interrupt, the first time before {names.place(address)}: {spoilt}")
    if report.held_off:
        print(f"held off to the end: asked for before {counted(len(report.held_off), 'instruction')}")
    for address in report.unclear:
        print(f"not compared, since other interrupts were moved by it: before {names.place(address)}")


def inject(
    *,
    file: ImageArgument,
    interrupt: Annotated[
        str,
        typer.Option(
            "--interrupt",
            metavar="INTx.y",
            help="Which interrupt, by group and line of the chip's interrupt table (PIE): INT1.7 is CPU timer 0.",
        ),
    ],
    begin: Annotated[
        str, typer.Option("--from", metavar="PLACE", help="Where the stretch begins: a name, FILE:LINE or an address.")
    ],
    end: Annotated[
        str,
        typer.Option(
            "--to", metavar="PLACE", help="Where it ends [default: where it begins, which is once around a loop]."
        ),
    ] = "",
    compare: Annotated[
        list[str] | None,
        typer.Option(
            "--compare", metavar="NAME[:WORDS]", help="Compare these words instead of all of RAM. Repeatable."
        ),
    ] = None,
    after: AfterOption = 0.0,
    within: WithinOption = 0.1,
    most: Annotated[
        int,
        typer.Option(
            "--most",
            metavar="N",
            parser=whole("--most", 1, 100_000),
            help="Give up when the stretch has more instructions.",
        ),
    ] = 2000,
    rom: RomOption = None,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Ask for an interrupt before each instruction executed in a stretch of code, and compare what it leaves behind.

    Exit status 1 when at some place it leaves neither what an interrupt before the stretch leaves nor what one after it
    leaves, or when it does not put a register back.
    """
    image = opened.read(file, rom)
    first = image.names.address(begin, "--from")
    last = image.names.address(end, "--to") if end else first
    vector = vectors.number(interrupt, "--interrupt")
    stretch = Stretch(first, last, vector, _watched(compare or [], image.names), most, within)
    board = opened.power_on(image, profile_name, motor, seed)
    with opened.closing(board, image):
        opened.advance(board, after)
        report = injection.inject(board, stretch)
        opened.say(board, image)
    print(
        f"{file.name}: {interrupt.upper()} before each of {counted(len(report.executed), 'instruction')} from "
        f"{image.names.place(first)} to {image.names.place(last)}"
    )
    _say(report, image)
    if report.spoilt and not report.differences:
        raise typer.Exit(ExitCode.SHORT)
    if report.differences:
        print(f"{counted(len(report.differences), 'place')} at which the interrupt can be told")
        raise typer.Exit(ExitCode.SHORT)
    print("as if it came before the stretch or behind it, each time")
