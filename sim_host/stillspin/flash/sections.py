"""The sections of a linked file: what is loaded where, where it runs, and what takes memory without being loaded."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from stillspin.flash import coff, coff_initial, elf, layout
from stillspin.flash.memories import Extent
from stillspin.flash.program import Program, assemble


@dataclass(frozen=True)
class Section:
    """Words of one name."""

    name: str
    words: int
    run: int
    """The address at which the program has it."""
    load: int | None
    """The address at which the file's content is put; None without content, as of .ebss and .stack."""

    def extents(self) -> Iterator[Extent]:
        """What it takes of the memories: where it is loaded, and where it runs when that is elsewhere."""
        if self.load is not None:
            yield Extent(self.load, self.words, loaded=True)
        if self.run != self.load:
            yield Extent(self.run, self.words, loaded=False)


def kind_of(data: bytes) -> ModuleType | None:
    """What reads that linked file, `elf` or `coff`; None of another format."""
    return elf if data.startswith(elf.MAGIC) else coff if data.startswith(coff.MAGIC) else None


def not_loaded(file: Path, program: Program, names: Iterable[str]) -> list[str]:
    """Which of these sections a file has content of that it loads nowhere."""
    data = file.read_bytes()
    kind = kind_of(data)
    loaded = {part.name for part in read(file, program) if part.load is not None}
    try:
        return [name for name in names if kind and name not in loaded and any(kind.section(data, name))]
    except struct.error:
        return []


def with_initial_values(file: Path, program: Program) -> Program:
    """A program that is loaded into RAM with those of its variables that its loader sets (COFF, --ram_model).

    Raises:
        InputError: their table is damaged.
    """
    begins_in_flash = program.word(layout.BOOT_ENTRY) is not None
    if begins_in_flash or program.kind != coff.KIND or not not_loaded(file, program, [coff_initial.SECTION]):
        return program
    blocks = coff_initial.read(file.read_bytes(), str(file))
    return assemble([*program.blocks, *blocks], program.entry, program.kind, str(file))


def read(file: Path, program: Program) -> list[Section]:
    """Those of a file in its order; of a format without sections, or with damaged ones, the blocks that it loads."""
    data = file.read_bytes()
    kind = kind_of(data)
    try:
        if kind:
            return [Section(*row) for row in kind.sections(data)]
    except struct.error:
        pass
    return [Section("(block)", len(block.words), block.address, block.address) for block in program.blocks]
