"""Executables of TI's EABI for the C28x: 32-bit ELF, little-endian, machine 141.

Addresses count 16-bit words, sizes and places in the file octets. What is loaded where is in the program headers, whose
physical address is the one to load to; symbols have run addresses. What is copied before it runs has a segment with its
words at the one address and a segment without content at the other (SPRAC71, program header).
Source: the C28x's application binary interface (SPRAC71, chapters on object files) and System V's ELF.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from stillspin.errors import InputError
from stillspin.flash.code_names import chosen
from stillspin.flash.octets import readable
from stillspin.flash.program import Block, Program, assemble, complete

KIND = "ELF"
MAGIC = b"\x7fELF"
_CLASS_AND_ORDER = b"\x01\x01"
MACHINE = 141
_OTHERS = {
    **{3: "a PC", 40: "an ARM", 62: "a PC", 105: "an MSP430", 140: "a C6000", 142: "a C55x", 144: "a PRU"},
    **{183: "an ARM", 243: "a RISC-V"},
}
"""Machine numbers of System V's ELF."""
_EXECUTABLE = 2
_HEADER = struct.Struct("<16sHHIIIIIHHHHHH")
_SEGMENT = struct.Struct("<IIIIIIII")
_SECTION = struct.Struct("<IIIIIIIIII")
_SYMBOL = struct.Struct("<IIIBBH")
_LOAD = 1
_ABSOLUTE = 0xFFF1
_CONTENT = 1
_NO_CONTENT = 8
_ALLOCATED = 2
_SYMBOL_TABLE = 2
_INSTRUCTIONS = 4
_FUNCTION = 2
_NAMED = {0, _FUNCTION}
"""Types of symbols that are places in code: without a type (assembly), function."""
_ADDRESSED = {0, 1, _FUNCTION}
"""And of data: object."""


class _Header(NamedTuple):
    kind: int
    machine: int
    entry: int
    segments: int
    sections: int
    segment_count: int
    section_count: int


def _header(data: bytes) -> _Header:
    _, kind, machine, _, entry, segments, sections, _, _, _, segment_count, _, section_count, _ = _HEADER.unpack_from(
        data
    )
    return _Header(kind, machine, entry, segments, sections, segment_count, section_count)


def read(data: bytes, name: str) -> Program:
    """Read a file.

    Raises:
        InputError: it is damaged, of another chip, or no executable.
    """
    with complete(KIND, name):
        return _read(data, name)


def _read(data: bytes, name: str) -> Program:
    header = _header(data)
    if header.machine != MACHINE or data[4:6] != _CLASS_AND_ORDER:
        raise InputError(
            f"{name}: is an ELF file for {_OTHERS.get(header.machine, 'another processor')} (machine "
            f"{header.machine}), not for the C28x ({MACHINE}): compile and link it with cl2000"
        )
    if header.kind != _EXECUTABLE or not header.segment_count:
        raise InputError(f"{name}: is an ELF object that has not been linked; give the .out file")
    return assemble(list(_blocks(data, header, name)), header.entry, KIND, name, sections(data))


def _blocks(data: bytes, header: _Header, name: str) -> Iterator[Block]:
    left = len(data)  # segments share nothing, so a file has no more in them than its size
    for index in range(header.segment_count):
        kind, at, _, load, octets, _, _, _ = _SEGMENT.unpack_from(data, header.segments + index * _SEGMENT.size)
        if kind != _LOAD or not octets:
            continue
        left -= octets
        if octets % 2 or left < 0:
            raise InputError(f"{name}: segment {index} is damaged, its size is {octets}; copy the file again")
        yield Block(load, struct.unpack_from(f"<{octets // 2}H", data, at))


def functions(data: bytes) -> dict[int, str]:
    """Names of places in code, by run address.

    Raises:
        struct.error: the file is cut short.
    """
    sections = _sections(data)

    def is_code(section: int) -> bool:
        return section < len(sections) and bool(sections[section][2] & _INSTRUCTIONS)

    return chosen(
        (value, name, kind == _FUNCTION)
        for name, value, kind, section in _named(data, sections)
        if is_code(section) and kind in _NAMED and not name.startswith((".", "$"))
    )


def addresses(data: bytes) -> dict[str, int]:
    """Addresses of everything that has a name, code and data; absolute values too. Raises as `functions` does."""
    sections = _sections(data)
    return {
        name: value
        for name, value, kind, section in _named(data, sections)
        if kind in _ADDRESSED and (0 < section < len(sections) or section == _ABSOLUTE)
    }


def lost_symbols(data: bytes) -> int:
    """Of how many the name cannot be read, or they lie behind the end of the file. Raises as `functions` does."""
    sections = _sections(data)
    cut = 0
    for table in sections:
        if table[1] == _SYMBOL_TABLE:
            cut += (table[5] - len(_entries(data, table))) // _SYMBOL.size
    return cut + sum(name is None for name, *_ in _symbols(data, sections))


def section(data: bytes, wanted: str) -> Iterator[bytes]:
    """The content of a section by its name. Raises as `functions` does."""
    sections = _sections(data)
    names = _HEADER.unpack_from(data)[13]
    if not names < len(sections):
        return
    strings = sections[names][4]
    for name, kind, _, _, at, octets, *_ in sections:
        if kind == _CONTENT and _text(data, strings + name) == wanted:
            yield data[at : at + octets]


def sections(data: bytes) -> Iterator[tuple[str, int, int, int | None]]:
    """Of every section that takes memory: name, words, where it runs, and where it is loaded if it is.

    Segments that have more than their sections follow as a whole. Raises as `functions` does.
    """
    header, heads = _header(data), _sections(data)
    names = _HEADER.unpack_from(data)[13]
    strings = heads[names][4] if names < len(heads) else len(data)
    left = [_Piece(*piece) for piece in _pieces(data, header)]
    for name, kind, flags, address, at, octets, *_ in heads:
        if not flags & _ALLOCATED or octets < 2:
            continue
        load, words = None, octets // 2
        for piece in left:
            inside = piece.word_of(None if kind == _NO_CONTENT else at, address)
            if 0 <= inside < piece.words:
                load = None if piece.load is None else piece.load + inside
                piece.named += words
                break
        yield _text(data, strings + name) or "?", words, address, load
    for piece in left:
        if piece.named < piece.words:
            yield "(segment)", piece.words, piece.run, piece.load


@dataclass
class _Piece:
    """What a segment has in the file from `at` on, or takes beyond that; `named` words of it are in sections."""

    run: int
    words: int
    load: int | None
    at: int | None
    named: int = 0

    def word_of(self, at: int | None, run: int) -> int:
        """Which of its words a section begins with, by where its content is in the file; -1 for none.

        The EABI has two segments for what is copied, one at either address, and tools may tell a section's by either.
        """
        if self.at is None or at is None:
            return run - self.run if self.at is at else -1
        return (at - self.at) // 2


def _pieces(data: bytes, header: _Header) -> Iterator[tuple[int, int, int | None, int | None]]:
    for index in range(header.segment_count):
        kind, at, run, load, octets, all_octets, _, _ = _SEGMENT.unpack_from(
            data, header.segments + index * _SEGMENT.size
        )
        if kind == _LOAD and octets:
            yield run, octets // 2, load, at
        if kind == _LOAD and all_octets > octets:
            yield run + octets // 2, (all_octets - octets) // 2, None, None


def _sections(data: bytes) -> list[tuple[int, ...]]:
    header = _header(data)
    return [
        _SECTION.unpack_from(data, header.sections + index * _SECTION.size) for index in range(header.section_count)
    ]


def _entries(data: bytes, table: tuple[int, ...]) -> bytes:
    """The octets of those symbols of a table that the file has."""
    there = data[table[4] : table[4] + table[5]]
    return there[: len(there) // _SYMBOL.size * _SYMBOL.size]


def _symbols(data: bytes, sections: list[tuple[int, ...]]) -> Iterator[tuple[str | None, int, int, int]]:
    """Name, value, type and section of every symbol; None for a name that cannot be read, "" for none."""
    for table in sections:
        if table[1] != _SYMBOL_TABLE:
            continue
        link = table[6]
        strings = sections[link][4] if link < len(sections) else len(data)
        for name, value, _, information, _, section in _SYMBOL.iter_unpack(_entries(data, table)):
            yield _text(data, strings + name) if name else "", value, information & 0xF, section


def _named(data: bytes, sections: list[tuple[int, ...]]) -> Iterator[tuple[str, int, int, int]]:
    for name, value, kind, section in _symbols(data, sections):
        if name:
            yield name, value, kind, section


def _text(data: bytes, at: int) -> str | None:
    end = data.find(0, at)
    return None if end < 0 else readable(data[at:end])
