"""`stillspin image`: what a linked image has, and where on the chip."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Annotated

import typer

from stillspin.c28x.disassembler import disassemble
from stillspin.commands import image_assemble, image_inject, image_replay, image_time, image_trace
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash import layout
from stillspin.flash.files import read_program
from stillspin.flash.program import Block, Program
from stillspin.one_line_errors import OneLineErrors
from stillspin.options import ImageArgument

app = typer.Typer(
    cls=OneLineErrors,
    help="Linked images: show one; time, trace and interrupt one on the virtual board; assemble one.",
    rich_markup_mode=None,
)

app.command(name="time")(image_time.time)
app.command(name="trace")(image_trace.trace)
app.command(name="inject")(image_inject.inject)
app.command(name="record")(image_replay.record)
app.command(name="replay")(image_replay.replay)
app.command(name="assemble")(image_assemble.assemble)

PLACES = (
    *(("M0", range(0x000000, 0x000400)), ("M1", range(0x000400, 0x000800)), ("L0", range(0x008000, 0x009000))),
    *(("L1", range(0x009000, 0x00A000)), ("H0", range(0x00A000, 0x00C000))),
    *((f"sector {sector.name}", sector.words) for sector in layout.SECTORS),
    ("sector A", layout.SECTOR_A),
    *(("L0 high", range(0x3F8000, 0x3F9000)), ("L1 high", range(0x3F9000, 0x3FA000))),
    ("H0 high", range(0x3FA000, 0x3FC000)),
)
"""The memories of an F2808 that a program is loaded to; L0, L1 and H0 are there twice, as the same words."""
NOWHERE = "nowhere"


def _place(address: int) -> str:
    return next((name for name, words in PLACES if address in words), NOWHERE)


def _used(program: Program) -> Counter[str]:
    """Words by the memory they are in."""
    return Counter(_place(address) for block in program.blocks for address in range(block.address, block.end))


def _within(block: Block) -> str:
    first, last = _place(block.address), _place(block.end - 1)
    return first if first == last else f"{first} to {last}"


def _code(program: Program, address: int, lines: int) -> Iterator[str]:
    """Lines of code as they are in memory.

    Raises:
        InputError: the image has nothing there.
    """
    if program.word(address) is None:
        raise InputError(f"--code: the image has nothing at 0x{address:06X}")
    for _ in range(lines):
        there = [word for word in (program.word(address), program.word(address + 1)) if word is not None]
        if not there or program.word(address) is None:
            return
        line = disassemble(there, address)
        words = " ".join(f"{word:04X}" for word in there[: line.words])
        yield f"0x{address:06X}  {words:<9}  {line.text}"
        address += line.words


def _address(text: str) -> int:
    try:
        return int(text, 0)
    except ValueError:
        raise InputError(f"--code: '{text}' is no address, such as 0x3F4000") from None


@app.command()
def show(
    *,
    file: ImageArgument,
    code: Annotated[
        str, typer.Option("--code", metavar="ADDRESS", help="List the code from this address on instead.")
    ] = "",
    lines: Annotated[int, typer.Option("--lines", min=1, max=65536, help="As many lines of it.")] = 24,
) -> None:
    """Say what an image loads and how full the chip's memories are; exit status 1 when something is in none of them."""
    program = read_program(file)
    if code:
        for line in _code(program, _address(code), lines):
            print(line)
        return
    entry = "" if program.entry is None else f", entry 0x{program.entry:06X}"
    print(f"{file.name}: {program.kind}, {counted(program.size, 'word')}{entry}")
    for block in program.blocks:
        print(
            f"0x{block.address:06X} to 0x{block.end - 1:06X}  {counted(len(block.words), 'word'):>12}  {_within(block)}"
        )
    used = _used(program)
    for name, words in PLACES:
        if used[name]:
            print(f"{name:<9} {used[name]:>6} of {counted(len(words), 'word')}")
    if used[NOWHERE]:
        print(f"{counted(used[NOWHERE], 'word')} in no memory of the chip")
        raise typer.Exit(ExitCode.SHORT)
