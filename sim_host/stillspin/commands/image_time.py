"""`stillspin image time`: what an image's interrupts, functions and source lines take on the virtual board."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer

from stillspin import resources
from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.c28x import timed
from stillspin.core_code import Interrupt, Spent
from stillspin.counted import counted
from stillspin.image import opened, vectors
from stillspin.image.opened import Image
from stillspin.options import ImageArgument, MotorOption, ProfileOption, SeedOption, number

_STACK = 0x0400
"""Where the boot ROM leaves the stack pointer."""
_WAITS = ("registers", "data", "fetches")


def _say_run(file: Path, seconds: float, before: Mapping[str, int], after: Mapping[str, int], asleep: int) -> None:
    grown = {key: after[key] - before[key] for key in after}
    cycles = max(grown["cycles"], 1)
    print(f"{file.name}: {seconds:g} s, {cycles} cycles, {counted(grown['instructions'], 'instruction')}")
    waited = ", ".join(f"{what} {100 * grown[f'waited_for_{what}'] / cycles:.1f} %" for what in _WAITS)
    print(f"waited for {waited}; asleep {100 * asleep / (seconds * TICKS_PER_SECOND):.1f} %")


def _say_interrupts(
    image: Image, each: Mapping[Interrupt, list[int]], within: Mapping[Interrupt, Mapping[int, int]], most: int
) -> None:
    names = image.names.functions
    print(f"\n{'interrupt':<28}{'count':>8}{'mean':>10}{'worst':>8}   cycles")
    for which, cycles in sorted(each.items()):
        vector, routine = which
        label = f"{vectors.name(vector)} {names.get(routine, f'0x{routine:06X}')}"
        print(f"{label:<28}{len(cycles):>8}{sum(cycles) / len(cycles):>10.1f}{max(cycles):>8}")
        for line in timed.histogram(cycles):
            print(line)
        inside = {address: (count, 0, 0, 0) for address, count in within.get(which, {}).items()}
        for row in timed.functions(image.program, names, inside)[:most]:
            if row.cycles:
                print(f"    {row.name:<32}{row.cycles / len(cycles):>10.1f}   of each in the mean")


def _shares(spent: Spent, total: int) -> str:
    """Columns: cycles, their share of all, and of them what was waited for."""
    cycles, *waits = spent
    columns = "".join(f"{100 * wait / max(cycles, 1):>10.1f}%" for wait in waits)
    return f"{cycles:>12}{100 * cycles / total:>8.1f}%{columns}"


_HEADS = f"{'cycles':>12}{'share':>9}" + "".join(f"{head:>11}" for head in _WAITS)


def _say_functions(image: Image, spent: Mapping[int, Spent], most: int) -> None:
    program = image.program
    rows = timed.functions(program, image.names.functions, spent)
    total = max(sum(cycles for cycles, *_ in spent.values()), 1)
    print(f"\n{'function':<28}{_HEADS}{'ran':>8}   of its words")
    for row in rows[:most]:
        size = row.end - row.first
        print(f"{row.name:<28}{_shares(row.spent, total)}{100 * row.ran / size:>7.0f}%{size:>8}")
    if len(rows) > most:
        print(f"and {len(rows) - most} more (--functions)")
    copied = timed.elsewhere(program, spent)
    if copied[0]:
        print(f"{'(copied code)':<28}{_shares(copied, total)}")
    ran = sum(row.ran for row in rows)
    print(f"code that ran: {counted(ran, 'word')} of {program.size} that the image has, data among them")


def _say_lines(image: Image, spent: Mapping[int, Spent], most: int) -> None:
    if not image.names.lines:
        print("\nno source lines: the image has no .debug_line of DWARF 2 to 4 (cl2000 -g)")
        return
    total = max(sum(cycles for cycles, *_ in spent.values()), 1)
    rows = timed.by_line(image.names.lines, spent)
    print(f"\n{'source line':<28}{_HEADS}")
    for source, count in rows[:most]:
        print(f"{source!s:<28}{_shares(count, total)}")
    if len(rows) > most:
        print(f"and {len(rows) - most} more (--lines)")


def time(
    *,
    file: ImageArgument,
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
    lines: Annotated[int, typer.Option("--lines", min=0, max=100_000, help="List as many source lines.")] = 0,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Run an image on the virtual board and say what its interrupts and functions took, in cycles of the CPU."""
    image = opened.read(file)
    board = opened.power_on(image, profile_name, motor, seed)
    try:
        opened.advance(board, after)
        before, asleep = board.code(), board.statistics()["idle_ticks"]
        board.profile()
        opened.advance(board, seconds)
        _say_run(file, seconds, before, board.code(), board.statistics()["idle_ticks"] - asleep)
        spent, interrupts, stack = board.spent()
        if interrupts:
            _say_interrupts(image, interrupts, board.within(), most)
        _say_functions(image, spent, most)
        if lines:
            _say_lines(image, spent, lines)
        print(f"stack: up to 0x{stack:04X}, {counted(max(stack - _STACK, 0), 'word')} from 0x{_STACK:04X}")
    finally:
        board.close()
