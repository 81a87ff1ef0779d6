"""`stillspin image`: what a linked image has, and where on the chip."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated

import typer

from stillspin import resources
from stillspin.board import image as on_board
from stillspin.c28x.disassembler import disassemble
from stillspin.commands import image_assemble, image_inject, image_replay, image_time, image_trace
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash import memories, sections
from stillspin.flash.memories import Extent, Filled
from stillspin.flash.program import Program
from stillspin.flash.sections import Section
from stillspin.image import opened
from stillspin.one_line_errors import OneLineErrors
from stillspin.options import ImageArgument, whole

app = typer.Typer(
    cls=OneLineErrors,
    help="Programs as they are linked for the chip (images): look at one; run one on the virtual board, which executes "
    "its machine code, and say what it took and did; make one of assembly.",
    rich_markup_mode=None,
)

app.command(name="time")(image_time.time)
app.command(name="trace")(image_trace.trace)
app.command(name="inject")(image_inject.inject)
app.command(name="record")(image_replay.record)
app.command(name="replay")(image_replay.replay)
app.command(name="assemble")(image_assemble.assemble)

ROM = "boot ROM"


def _memory(section: Section) -> str:
    """Where a section lies, loaded and running."""
    return ", runs in ".join(_within(extent) for extent in section.extents())


def _within(extent: Extent) -> str:
    first, last = memories.name(extent.address), memories.name(extent.address + extent.count - 1)
    return first if first == last else f"{first} to {last}"


def _taken(section: Section) -> Iterator[Extent]:
    """What no other may have: a section without content in flash or registers (CsmPwlFile) only names what is there."""
    return (extent for extent in section.extents() if extent.loaded or memories.is_ram(extent.address))


def _say(there: Sequence[Section]) -> int:
    """Sections and how full the memories are; gives how many words are in none."""
    print(f"{'section':<20}{'words':>7}  {'loaded to':<10} {'runs at':<9} memory")
    for section in there:
        load = "-" if section.load is None else f"0x{section.load:06X}"
        print(f"{section.name:<20}{section.words:>7}  {load:<10} 0x{section.run:06X}  {_memory(section)}")
    filled = Filled(extent for section in there for extent in section.extents())
    for name, used, size in filled.rows():
        print(f"{name:<9} {used:>6} of {counted(size, 'word')}")
    for one, other, first, end in memories.shared((part.name, _taken(part)) for part in there):
        print(f"{one} and {other} share 0x{first:06X} to 0x{end - 1:06X}: an overlay, or a mistake of the command file")
    if filled.outside:
        print(f"{counted(filled.outside, 'word')} in no memory of the chip")
    of_rom = [section for section in there if memories.name(section.run) == ROM]
    in_rom = [section.name for section in of_rom if section.load is None]
    for section in of_rom:
        if section.load is not None:
            print(f"{section.name} is loaded into the boot ROM, which has its own words; {on_board.IN_ROM}")
    if in_rom:
        print(
            f"{', '.join(in_rom)}: tables of the boot ROM, which the virtual chip has not: they read as 0 unless "
            f"--rom FILE gives them; or link them into flash ({resources.page('c28x')})"
        )
    return filled.outside


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


@app.command()
def show(
    *,
    file: ImageArgument,
    code: Annotated[
        str,
        typer.Option("--code", metavar="PLACE", help="List the code from a name, FILE:LINE or an address on instead."),
    ] = "",
    lines: Annotated[
        int,
        typer.Option("--lines", metavar="N", parser=whole("--lines", 1, 65536), help="How many lines of code to list."),
    ] = 24,
) -> None:
    """Say what an image loads where, where it runs, and how full the memories are.

    Exit status 1 when some of it lies in no memory, or it has instructions that an F2808 does not have.
    """
    image = opened.look(file)
    program = image.program
    if code:
        for line in _code(program, image.names.address(code, "--code"), lines):
            print(line)
        return
    entry = "" if program.entry is None else f", entry 0x{program.entry:06X}"
    print(f"{file.name}: {program.kind}, {counted(program.size, 'word')}{entry}")
    for words in image.remarks:
        print(f"{opened.WARNING}{words}")
    outside = _say(sections.read(file, program))
    if image.foreign:
        print(image.foreign)
    if outside or image.foreign:
        raise typer.Exit(ExitCode.SHORT)
