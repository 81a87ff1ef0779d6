"""`stillspin image time`: what an image's interrupts and functions take on the virtual board."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, resources
from stillspin.board import power
from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.board.image import blocks_of
from stillspin.c28x import timed
from stillspin.cases import profile
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.errors import CampaignError
from stillspin.flash import coff, elf
from stillspin.flash.files import read_program
from stillspin.flash.program import Program
from stillspin.options import MotorOption, ProfileOption, SeedOption, number

_STACK = 0x0400
"""Where the boot ROM leaves the stack pointer."""


def _names(file: Path) -> dict[int, str]:
    data = file.read_bytes()
    try:
        if data.startswith(elf.MAGIC):
            return elf.functions(data)
        return coff.functions(data) if data.startswith(coff.MAGIC) else {}
    except (struct.error, ValueError):
        return {}  # the words are there, and the table of names is not


def _advance(board: NativeBoard, seconds: float) -> None:
    try:
        board.advance(round(seconds * TICKS_PER_SECOND))
    except RuntimeError as error:
        raise CampaignError(f"the virtual board stopped: {error}") from error


def _say_run(file: Path, seconds: float, before: Mapping[str, int], after: Mapping[str, int], asleep: int) -> None:
    grown = {key: after[key] - before[key] for key in after}
    cycles = max(grown["cycles"], 1)
    print(f"{file.name}: {seconds:g} s, {cycles} cycles, {counted(grown['instructions'], 'instruction')}")
    print(
        "waited for "
        + ", ".join(
            f"{what} {100 * grown[f'waited_for_{what}'] / cycles:.1f} %" for what in ("registers", "data", "fetches")
        )
        + f"; asleep {100 * asleep / (seconds * TICKS_PER_SECOND):.1f} %"
    )


def _say_interrupts(spent: Mapping[tuple[int, int], list[int]], names: Mapping[int, str]) -> None:
    print(f"\n{'interrupt':<28}{'count':>8}{'mean':>10}{'worst':>8}   cycles")
    for (vector, routine), cycles in sorted(spent.items()):
        label = f"{timed.vector_name(vector)} {names.get(routine, f'0x{routine:06X}')}"
        print(f"{label:<28}{len(cycles):>8}{sum(cycles) / len(cycles):>10.1f}{max(cycles):>8}")
        for line in timed.histogram(cycles):
            print(line)


def _say_functions(program: Program, names: Mapping[int, str], spent: Mapping[int, int], most: int) -> None:
    rows = timed.functions(program, names, spent)
    total = max(sum(spent.values()), 1)
    print(f"\n{'function':<28}{'cycles':>12}{'share':>9}{'ran':>8}   of its words")
    for row in rows[:most]:
        size = row.end - row.first
        print(f"{row.name:<28}{row.cycles:>12}{100 * row.cycles / total:>8.1f}%{100 * row.ran / size:>7.0f}%{size:>8}")
    if len(rows) > most:
        print(f"and {len(rows) - most} more (--functions)")
    copied = timed.elsewhere(program, spent)
    if copied:
        print(f"{'(copied code)':<28}{copied:>12}{100 * copied / total:>8.1f}%")
    ran = sum(row.ran for row in rows)
    print(f"code that ran: {counted(ran, 'word')} of {program.size} that the image has, data among them")


def time(
    *,
    file: Annotated[Path, typer.Argument(help="An .out file of cl2000 (COFF or ELF), Intel hex or a boot stream.")],
    seconds: Annotated[
        float,
        typer.Option("--for", parser=number("--for", 0.0001, unit="s"), metavar="SECONDS", help="How long to look."),
    ] = 0.1,
    after: Annotated[
        float,
        typer.Option(
            "--after", parser=number("--after", 0, unit="s"), metavar="SECONDS", help="From when on, after power-on."
        ),
    ] = 0.0,
    most: Annotated[int, typer.Option("--functions", min=1, max=10_000, help="List as many functions.")] = 20,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Run an image on the virtual board and say what its interrupts and functions took, in cycles of the CPU."""
    program, names = read_program(file), _names(file)
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor)
    board = power.power(native, chosen, profile.Changes(), seed, blocks_of(program, str(file)))
    try:
        _advance(board, after)
        before, asleep = board.code(), board.statistics()["idle_ticks"]
        board.profile()
        _advance(board, seconds)
        _say_run(file, seconds, before, board.code(), board.statistics()["idle_ticks"] - asleep)
        spent, interrupts, stack = board.spent()
        if interrupts:
            _say_interrupts(interrupts, names)
        _say_functions(program, names, spent, most)
        print(f"stack: up to 0x{stack:04X}, {counted(max(stack - _STACK, 0), 'word')} from 0x{_STACK:04X}")
    finally:
        board.close()
