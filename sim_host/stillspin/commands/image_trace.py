"""`stillspin image trace`: the instructions that an image executes, with what each of them changes."""

from __future__ import annotations

from typing import Annotated

import typer

from stillspin import resources
from stillspin.errors import CampaignError
from stillspin.image import opened
from stillspin.image import trace as tracing
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


def trace(
    *,
    file: ImageArgument,
    begin: Annotated[
        str,
        typer.Option("--from", metavar="PLACE", help="Begin here: a name, FILE:LINE or an address [default: at once]."),
    ] = "",
    end: Annotated[
        str, typer.Option("--to", metavar="PLACE", help="List the last instructions before this place instead.")
    ] = "",
    count: Annotated[
        int,
        typer.Option(
            "--instructions", metavar="N", parser=whole("--instructions", 1, 100_000), help="How many to list."
        ),
    ] = 40,
    after: AfterOption = 0.0,
    rom: RomOption = None,
    within: WithinOption = 0.1,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """List executed instructions: cycle, address, instruction, its cycles with waits, registers that it changed.

    Exit status 1 when a place is not reached; those before the end are listed all the same.
    """
    image = opened.read(file, rom)
    first = image.names.address(begin, "--from") if begin else None
    last = image.names.address(end, "--to") if end else None
    board = opened.power_on(image, profile_name, motor, seed)
    with opened.closing(board, image):
        opened.advance(board, after)
        if first is not None and not opened.run_to(board, [first], within):
            raise CampaignError(_missed("--from", image.names.place(first), within))
        board.trace(count)
        if last is None:
            board.stop_after(count)
        stopped = opened.run_to(board, () if last is None else [last], within)
        for line in tracing.lines(board, image.names):
            print(line)
        opened.say(board, image)
        if not stopped and last is not None:
            raise CampaignError(_missed("--to", image.names.place(last), within))
        if not stopped:
            print(f"no more instructions within {within:g} s: the core sleeps")


def _missed(option: str, place: str, within: float) -> str:
    return f"{option}: {place} was not reached within {within:g} s; give it longer with --within"
