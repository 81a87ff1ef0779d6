"""Image files and kernel files: reading any format that is known, and refusing what is not meant for this board."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.flash import boot_stream, coff, elf, image_sum, intel_hex, layout
from stillspin.flash.layout import contains
from stillspin.flash.program import Block, Program

_FORMATS = "an .out file of cl2000 (COFF or ELF), Intel hex or a boot stream of hex2000"
_LARGEST = 64 << 20
"""Octets: debug information of a large program takes far more than its words."""
_OTHERS = {
    b"!<arch>": "is a library, not a program; give the .out that was linked with it",
    b"S0": "has S-records; give Intel hex (hex2000 -i)",
}
"""Beginnings of files that a linker's folder has, too."""


def _reader(data: bytes) -> Callable[[bytes, str], Program] | None:
    """What reads that format; None of one that is not known."""
    formats = (
        (data.startswith(elf.MAGIC), elf.read),
        (data.startswith(coff.MAGIC), coff.read),
        (boot_stream.is_binary(data), boot_stream.from_octets),
        (boot_stream.is_text(data), boot_stream.from_text),
        (data.lstrip()[:1] == b":", intel_hex.read),
    )
    return next((reader for fits, reader in formats if fits), None)


def read_boot_rom(path: Path) -> tuple[Block, ...]:
    """Words of the boot ROM: of a linked file what lies there; any other file is a dump from its first word on.

    Raises:
        InputError: it cannot be read, or has nothing of the boot ROM.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    rom = layout.BOOT_ROM
    if not _reader(data):
        if not data or len(data) % 2 or len(data) > 2 * len(rom):
            raise InputError(
                f"{path}: {counted(len(data), 'octet')} are no dump of the boot ROM (words from 0x{rom.start:06X} on, "
                f"low octet first, at most {counted(2 * len(rom), 'octet')}); give one, or {_FORMATS}"
            )
        return (Block(rom.start, struct.unpack(f"<{len(data) // 2}H", data)),)
    parts = []
    for block in read_program(path).blocks:
        first, end = max(block.address, rom.start), min(block.end, rom.stop)
        if first < end:
            parts.append(Block(first, block.words[first - block.address : end - block.address]))
    if not parts:
        raise InputError(
            f"{path}: has nothing in the boot ROM (0x{rom.start:06X} to 0x{rom.stop - 1:06X}); a section of TYPE = "
            "NOLOAD has no words"
        )
    return tuple(parts)


def read_program(path: Path) -> Program:
    """Read a file in whatever format it is.

    Raises:
        InputError: it cannot be read, or is none of them.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    name = str(path)
    if len(data) > _LARGEST:
        raise InputError(
            f"{name}: a file of {counted(len(data), 'octet')} is no program for this chip; give {_FORMATS}"
        )
    if reader := _reader(data):
        return reader(data, name)
    if not data:
        raise InputError(f"{name}: is empty; give {_FORMATS}")
    for begin, words in _OTHERS.items():
        if data.startswith(begin):
            raise InputError(f"{name}: {words}")
    raise InputError(f"{name}: has an unknown format; give {_FORMATS}")


def _read_for_flash(path: Path) -> Program:
    """The same of what this drive is linked as: its start-up zeroes what COFF leaves to it.

    Raises:
        InputError: also for ELF.
    """
    program = read_program(path)
    if program.kind == elf.KIND:
        raise InputError(
            f"{path}: is an ELF file; link with --abi=coffabi, as the preset f2808 does, or give Intel hex"
        )
    return program


@dataclass(frozen=True)
class Identity:
    """What an image says of itself (hal/hal_image.h)."""

    version: tuple[int, int, int]
    revision: int
    changed: bool
    tables: int
    demonstration: bool = False
    """It is no program, and for a virtual board alone."""
    edition: str = ""
    """What is in it (firmware/editions/); empty where it does not say."""

    @property
    def text(self) -> str:
        """For people."""
        version = ".".join(map(str, self.version))
        if self.demonstration:
            return f"{version} (a demonstration, for a virtual board alone)"
        commit = f"commit {self.revision:08x}" if self.revision else "unknown commit"
        edition = f"edition {self.edition}, " if self.edition else ""
        return f"{version} ({edition}{commit}{', changed' if self.changed else ''}, tables {self.tables:08x})"


def identity_of(words: tuple[int, ...]) -> Identity | None:
    """The identity in its words, whether or not the mark is there; None where there is none."""
    _, form, major, minor, patch, low, high, flags, tables_low, tables_high, *rest = words
    if form != layout.IDENTITY_FORMAT:
        return None
    changed, demonstration = bool(flags & layout.CHANGED), bool(flags & layout.DEMONSTRATION)
    tables = tables_high << 16 | tables_low
    name = b"".join(word.to_bytes(2, "little") for word in rest[layout.SUM_WORDS :]).rstrip(b"\0\xff")
    edition = name.decode("ascii", "replace")
    return Identity((major, minor, patch), high << 16 | low, changed, tables, demonstration, edition)


@dataclass(frozen=True)
class DriveImage:
    """A drive for sectors B to D, and the sector A that it was linked with."""

    words: tuple[int, ...]
    """All of layout.UPDATE, with the mark; erased where the file has nothing."""
    resident: tuple[Block, ...]
    """What the file has for sector A, boot code and resident part: compared with the board, never written."""
    identity: Identity
    size: int
    """Words that the file has for the update."""
    summed: bool
    """It has a check sum, and that is right."""

    def piece(self, words: range, *, sealed: bool = True) -> tuple[int, ...]:
        """The words of an address range; the mark erased where not sealed."""
        found = self.words[words.start - layout.UPDATE.start : words.stop - layout.UPDATE.start]
        if not sealed and layout.IDENTITY in words:
            at = layout.IDENTITY - words.start
            found = (*found[:at], layout.ERASED, *found[at + 1 :])
        return found


def _place(block: Block, name: str) -> None:
    """Refuse what does not lie in the flash, or on what nobody may write."""
    count = len(block.words)
    span = f"0x{block.address:06X} to 0x{block.end - 1:06X}"
    if not contains(layout.FLASH, block.address, count):
        raise InputError(
            f"{name}: {span} is not in the flash of a {layout.PART_NAME} (0x3E8000 to 0x3F7FFF): "
            "linked for RAM or another chip; use toolchain/c28x/f2808_flash.cmd"
        )
    for kept, what in ((layout.CSM_RESERVED, "the area reserved for code security"), (layout.PASSWORDS, "passwords")):
        if block.address < kept.stop and block.end > kept.start:
            raise InputError(
                f"{name}: {span} reaches into the {what.removeprefix('the ')}: these words are never written"
            )


def _split(block: Block) -> tuple[Block | None, Block | None]:
    """The parts of a block in the update's sectors and in sector A."""
    cut = min(max(layout.SECTOR_A.start - block.address, 0), len(block.words))
    below, above = block.words[:cut], block.words[cut:]
    return (
        Block(block.address, below) if below else None,
        Block(block.address + cut, above) if above else None,
    )


def drive_image(path: Path) -> DriveImage:
    """Read an image of the drive.

    Raises:
        InputError: it cannot be read, or is no image that this board may get.
    """
    program, name = _read_for_flash(path), str(path)
    words = [layout.ERASED] * len(layout.UPDATE)
    resident, size = [], 0
    for block in program.blocks:
        _place(block, name)
        update, above = _split(block)
        if update:
            at = update.address - layout.UPDATE.start
            words[at : at + len(update.words)] = update.words
            size += len(update.words)
        if above:
            resident.append(above)
    at = layout.IDENTITY - layout.UPDATE.start
    identity = identity_of(tuple(words[at : at + layout.IDENTITY_WORDS]))
    if words[at] != layout.MARK or identity is None:
        raise InputError(
            f"{name}: is no image of this drive: no mark and identity at 0x{layout.IDENTITY:06X} (hal/hal_image.h)"
        )
    return DriveImage(tuple(words), tuple(resident), identity, size, image_sum.check(program, name))


def kernel_program(path: Path) -> Program:
    """Read the flash kernel, which the boot ROM loads.

    Raises:
        InputError: it cannot be read, or is no kernel that may be loaded.
    """
    program, name = _read_for_flash(path), str(path)
    for block in program.blocks:
        if not contains(layout.KERNEL_RAM, block.address, len(block.words)):
            raise InputError(
                f"{name}: 0x{block.address:06X} to 0x{block.end - 1:06X} is not in the kernel's RAM (H0); "
                "link it with toolchain/c28x/f2808_kernel.cmd"
            )
    if program.word(layout.KERNEL_RAM.start) not in {layout.KERNEL_MARK, layout.KERNEL_DEMONSTRATION}:
        raise InputError(f"{name}: is no flash kernel: there is no mark at 0x{layout.KERNEL_RAM.start:06X}")
    if program.entry is None or program.word(program.entry) is None:
        raise InputError(f"{name}: its entry point is outside of what it loads; build it again")
    return program
