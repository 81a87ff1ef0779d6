"""`stillspin image assemble`: a linked image of assembly files, with labels and source lines."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from stillspin.c28x import linked
from stillspin.c28x.program import assemble_files
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.flash import layout

_START = "START"


def assemble(
    *,
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="Assembly files, one after the other; .org says where.")
    ],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The image, an ELF file.")],
) -> None:
    """Assemble a program of instructions as TI writes them; it begins at the flash's entry or at the label start."""
    program = assemble_files(files)
    if not program.words:
        raise InputError(f"{files[0]}: has no instruction and no word")
    entry = layout.BOOT_ENTRY if layout.BOOT_ENTRY in program.words else program.symbols.get(_START)
    if entry is None:
        raise InputError(
            f"{files[0]}: has nothing at the flash's entry 0x{layout.BOOT_ENTRY:06X} and no label 'start' to begin at"
        )
    try:
        out.write_bytes(linked.to_elf(program, entry))
    except OSError as error:
        raise InputError(f"{out}: cannot be written ({error.strerror})") from error
    print(f"{out}: {counted(len(program.words), 'word')}, entry 0x{entry:06X}")
