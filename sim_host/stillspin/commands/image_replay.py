"""`stillspin image record` and `image replay`: one run's inputs given to another, and their outputs compared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, resources
from stillspin.board import power
from stillspin.cases import profile
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.image import opened
from stillspin.image import tape as tapes
from stillspin.image.opened import Image
from stillspin.image.tape import Difference, Octets
from stillspin.options import ImageArgument, MotorOption, ProfileOption, SeedOption, number


def _octets(texts: list[str]) -> list[Octets]:
    """SECONDS:TEXT, a line each."""
    made = []
    for text in texts:
        when, mark, line = text.partition(":")
        try:
            seconds = float(when)
        except ValueError:
            seconds = -1.0
        if not mark or not 0 <= seconds < float("inf"):
            raise InputError(f"--send: '{text}' is not SECONDS:TEXT, such as 0.5:start")
        made.append((seconds, f"{line}\r".encode().hex()))
    return made


def _firmware(profile_name: str, motor: str, seed: int) -> NativeBoard:
    native = core.load()
    chosen = profile.load(profile_name, core.plant_schema(native), core.parameters(native), motor)
    return power.power(native, chosen, profile.Changes(), seed)


def record(
    *,
    out: Annotated[Path, typer.Argument(metavar="TAPE", help="Where to write what was recorded.")],
    file: Annotated[
        Path | None,
        typer.Option("--image", metavar="FILE", help="Of this image instead of the firmware for this computer."),
    ] = None,
    seconds: Annotated[
        float,
        typer.Option("--for", parser=number("--for", 0.0001, 100, "s"), metavar="SECONDS", help="How long."),
    ] = 0.1,
    send: Annotated[
        list[str] | None,
        typer.Option("--send", metavar="SECONDS:TEXT", help="A line for the serial port at a time. Repeatable."),
    ] = None,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Record what converter, pins and encoder tell on the virtual board, and every write to the ePWM, from power-on."""
    octets = _octets(send or [])
    board = (
        opened.power_on(opened.read(file), profile_name, motor, seed) if file else _firmware(profile_name, motor, seed)
    )
    try:
        tape = tapes.play(board, seconds, octets)
    finally:
        board.close()
    tapes.save(replace(tape, made_by=file.name if file else "firmware"), out)
    print(f"{out}: {counted(len(tape.samples), 'sample')}, {counted(len(tape.writes), 'write')} to the ePWM")


def _write(write: tuple[int, int, int] | None) -> str:
    if write is None:
        return "no write any more"
    return f"step {write[0]}, {tapes.register(write[1])} = 0x{write[2]:04X}"


def _say(difference: Difference, image: Image) -> None:
    recorded, here = _write(difference.expected), _write(difference.found)
    print(f"write {difference.index + 1} differs: recorded {recorded}; here {here}")
    if difference.program:
        print(f"written at {image.names.place(difference.program - 1)}")


def replay(
    *,
    file: ImageArgument,
    tape_file: Annotated[Path, typer.Argument(metavar="TAPE", help="What `image record` has written.")],
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Give an image what another run was told; its writes to the ePWM have to be the same, bit for bit.

    Exit status 4 when one differs: the first is named by step, register and source line.
    """
    image, tape = opened.read(file), tapes.load(tape_file)
    board = opened.power_on(image, profile_name, motor, seed)
    try:
        tapes.play(board, tape.seconds, tape.octets, tape)
        difference = tapes.compare(tape, board)
        steps, writes = len(board.taped()[0]), len(board.taped()[1])
    finally:
        board.close()
    if difference:
        _say(difference, image)
        raise typer.Exit(ExitCode.DIFFERS)
    print(
        f"{file.name}: the same {counted(min(writes, len(tape.writes)), 'write')} to the ePWM as {tape.made_by} in "
        f"{counted(min(steps, len(tape.samples)), 'step')}"
    )
