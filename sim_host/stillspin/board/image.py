"""An image on the virtual board: its words where a probe would put them, and a way to them from the flash's entry."""

from __future__ import annotations

from pathlib import Path

from stillspin.core import Blocks
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.flash import layout, memories
from stillspin.flash.files import read_program
from stillspin.flash.program import Block, Program

IN_ROM = "in the linker command file it has to be TYPE = DSECT (the reset vector) or TYPE = NOLOAD (IQmathTables)"
"""What to do about a section that is loaded into the boot ROM."""

_LONG_BRANCH = 0x0040
"""The first word of LB, with the upper six bits of where it goes."""


def load(file: Path) -> Blocks:
    """The words of a linked file.

    Raises:
        InputError: it cannot be read, or nothing says where it begins.
    """
    return blocks_of(read_program(file), str(file))


def _check_place(block: Block, name: str) -> None:
    filled = memories.Filled([memories.Extent(block.address, len(block.words), loaded=True)])
    taken = sum(filled.of(memory) for memory in memories.MEMORIES if memory.group)
    if taken < len(block.words):
        lost = counted(len(block.words) - taken, "word")
        if block.address in layout.BOOT_ROM:
            raise InputError(
                f"{name}: 0x{block.address:06X} to 0x{block.end - 1:06X} is in the boot ROM, which has its own words; "
                f"{IN_ROM}"
            )
        raise InputError(
            f"{name}: of 0x{block.address:06X} to 0x{block.end - 1:06X} {lost} lie in neither flash nor RAM "
            "(the OTP of the virtual one is erased and stays so); `stillspin image show` lists where its sections go"
        )


def blocks_of(program: Program, name: str) -> Blocks:
    """The words of a program. One that has nothing at the flash's entry gets a branch there, to its own entry.

    Where the file tells none (Intel hex), a program that has words at the boot ROM's entry in RAM begins there.

    Raises:
        InputError: nothing says where it begins, or it has words that the virtual board has no memory for.
    """
    for block in program.blocks:
        _check_place(block, name)
    blocks: Blocks = [(block.address, list(block.words)) for block in program.blocks]
    if program.word(layout.BOOT_ENTRY) is None:
        entry = layout.RAM_ENTRY if program.entry is None else program.entry
        there = program.word(entry) is not None
        if program.entry is None and not there:
            raise InputError(
                f"{name}: has no code at the flash's entry 0x{layout.BOOT_ENTRY:06X}, to which the boot ROM jumps, "
                "none at that in RAM, 0x000000, and no entry point of its own"
            )
        if not there:
            raise InputError(f"{name}: its entry point 0x{entry:06X} is in none of its sections")
        branch = [_LONG_BRANCH | entry >> 16, entry & 0xFFFF]
        blocks.append((layout.BOOT_ENTRY, branch))
    return blocks
