"""Executables of TI's COFF for the C28x (version 2, target 0x009D), as cl2000 links them: loadable sections alone.

Source: TI's description of its COFF (SPRAAO8), and published dumps of what cl2000 18.1 made; sizes count words, of
debug information octets, values are little-endian.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from stillspin.errors import InputError
from stillspin.flash import layout
from stillspin.flash.code_names import chosen
from stillspin.flash.octets import readable
from stillspin.flash.program import Block, Program, assemble, complete

KIND = "COFF"
MAGIC = b"\xc2\x00"
_TARGET = 0x009D
_OTHERS = {
    **{0x0097: "an ARM (TMS470)", 0x0098: "a C54x", 0x0099: "a C6000", 0x009C: "a C55x", 0x00A0: "an MSP430"},
    **{0x00A1: "a C55x+"},
}
"""Target numbers of TI's COFF (SPRAAO8)."""
_HEADER = struct.Struct("<HHIIIHHH")
_OPTIONAL = struct.Struct("<HHIIIIII")
_SECTION = struct.Struct("<8sIIIIIIIIIHH")
_SYMBOL = struct.Struct("<8sIhHBB")
_LINE_SIZE = 6
_EXTERNAL = 2
_NAMED = {_EXTERNAL, 3, 6}
"""Storage classes of what has an address: external, static, label."""
_SECTIONS = re.compile(r"[.$].*")
_WITHIN = re.compile(r"[.$].*|DW\$.*|C\$.*|L\d+")
"""And of places within a function, which assemblers keep where they are told to (cl2000 -as)."""
BEGIN_OR_END = 101
"""Storage class of .bf and .ef, about the lines of a function."""
_ABSOLUTE = -1
_TEXT = 0x0020
_EXECUTABLE = 0x0002
_NOT_LOADED = 0x0001 | 0x0002 | 0x0010 | 0x0080
"""Dummy sections, those of another load, those that are only copied by a loader, and those without content."""

_NO_MEMORY = 0x0001 | 0x0010
"""Of these, those that the linker gives no memory: dummies, and debug information."""


def read(data: bytes, name: str) -> Program:
    """Read a file.

    Raises:
        InputError: it is damaged, of another chip, or no executable.
    """
    with complete(KIND, name):
        return _read(data, name)


def _read(data: bytes, name: str) -> Program:
    *_, optional, flags, target = _HEADER.unpack_from(data)
    if target != _TARGET:
        raise InputError(
            f"{name}: is a COFF file for {_OTHERS.get(target, 'another processor')} (0x{target:04X}), not for the C28x "
            "(0x009D): compile and link it with cl2000"
        )
    if not flags & _EXECUTABLE or not optional:
        raise InputError(f"{name}: is a COFF object that has not been linked; give the .out file")
    entry = _OPTIONAL.unpack_from(data, _HEADER.size)[5]
    blocks = [
        Block(head.load_and_run[0], struct.unpack_from(f"<{head.size}H", data, head.raw))
        for head in _heads(data)
        if head.is_loaded
    ]
    return assemble(blocks, entry, KIND, name, sections(data))


class _Head(NamedTuple):
    """A section's, with where in the file its content and its line numbers are."""

    name: bytes
    physical: int
    virtual: int
    size: int
    raw: int
    lines_at: int
    lines: int
    kind: int

    @property
    def is_loaded(self) -> bool:
        """Whether a chip gets its words."""
        return bool(self.size and self.raw) and not self.kind & _NOT_LOADED

    @property
    def load_and_run(self) -> tuple[int, int]:
        """Where it is loaded and where it runs."""
        return _load_and_run(self.physical, self.virtual)

    def words(self, data: bytes) -> bytes:
        """Its content where the size counts words, two octets each."""
        return data[self.raw : self.raw + 2 * self.size]


def _heads(data: bytes) -> Iterator[_Head]:
    """All, in the file's order. Raises struct.error where it is cut short."""
    count, optional = _HEADER.unpack_from(data)[1], _HEADER.unpack_from(data)[5]
    for index in range(count):
        at = _HEADER.size + optional + index * _SECTION.size
        name, physical, virtual, size, raw, _, lines_at, _, lines, kind, _, _ = _SECTION.unpack_from(data, at)
        yield _Head(name, physical, virtual, size, raw, lines_at, lines, kind)


def sections(data: bytes) -> Iterator[tuple[str, int, int, int | None]]:
    """Of every section that takes memory: name, words, where it runs, and where it is loaded if it is.

    Raises:
        struct.error: the file is cut short.
    """
    for head in _heads(data):
        if head.size and not head.kind & _NO_MEMORY:
            load, run = head.load_and_run
            yield text(head.name, data) or "?", head.size, run, load if head.is_loaded else None


def _load_and_run(physical: int, virtual: int) -> tuple[int, int]:
    """Where a section is loaded and where it runs, of the two addresses that its head has.

    TI's loaders take the first to run at and the second to load to. No cl2000 was at hand to see it, so it does not
    hang on that where it matters: what is copied to RAM at the start lies in the flash.
    """
    if physical in layout.FLASH and virtual not in layout.FLASH:
        return physical, virtual
    return virtual, physical


def functions(data: bytes) -> dict[int, str]:
    """Names of places in code, by run address.

    Raises:
        struct.error: the file is cut short.
    """
    code = {number for number, head in enumerate(_heads(data), 1) if head.kind & _TEXT}
    return chosen(
        (value, name, False)
        for name, value, section, kind in _symbols(data)
        if section in code and not (_WITHIN if kind != _EXTERNAL else _SECTIONS).fullmatch(name)
    )


def addresses(data: bytes) -> dict[str, int]:
    """Addresses of everything that has a name, code and data; absolute values too."""
    return {name: value for name, value, section, _ in _symbols(data) if section > 0 or section == _ABSOLUTE}


class Symbol(NamedTuple):
    """An entry of the table of symbols."""

    name: str | None
    """Of what has an address, and of what is about a function's lines; None where it cannot be read."""
    value: int
    section: int
    kind: int
    """Storage class."""

    @property
    def has_address(self) -> bool:
        """Whether it is something of the program's, not of its description."""
        return self.kind in _NAMED


def _symbols(data: bytes) -> Iterator[tuple[str, int, int, int]]:
    """Name, value, section and storage class of what has an address."""
    for _, entry, _ in raw_symbols(data):
        if entry.has_address and entry.name:
            yield entry.name, entry.value, entry.section, entry.kind


def lost_symbols(data: bytes) -> int:
    """Of how many the name cannot be read, or they lie behind the end of the file."""
    _, _, _, table, symbols, _, _, _ = _HEADER.unpack_from(data)
    lost = [entry for _, entry, _ in raw_symbols(data) if entry.has_address and entry.name is None]
    return len(lost) + int(symbols) - _there(data, table, symbols)


def _there(data: bytes, table: int, symbols: int) -> int:
    """How many of the table's entries the file has."""
    return min(symbols, max(len(data) - table, 0) // _SYMBOL.size)


def raw_symbols(data: bytes) -> Iterator[tuple[int, Symbol, bytes]]:
    """Every symbol that the file has, with its index, and the octets of what more there is of it."""
    _, _, _, table, symbols, _, _, _ = _HEADER.unpack_from(data)
    at, end = 0, _there(data, table, symbols)
    while at < end:
        begin = table + at * _SYMBOL.size
        name, value, section, _, kind, more = _SYMBOL.unpack_from(data, begin)
        words = text(name, data) if kind in _NAMED or kind == BEGIN_OR_END else ""
        behind = begin + _SYMBOL.size
        yield at, Symbol(words, value, section, kind), data[behind : behind + more * _SYMBOL.size]
        at += 1 + more


def text(octets: bytes, data: bytes) -> str | None:
    """A name of up to so many characters in place, or where it is in the file's table of strings.

    None: there is nothing of the kind at that place.
    """
    _, _, _, table, symbols, _, _, _ = _HEADER.unpack_from(data)
    return _name(octets, data, table + symbols * _SYMBOL.size)


def line_tables(data: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Of every section that has line numbers: where it runs, its words, and the octets of the numbers.

    Raises:
        struct.error: the file is cut short.
    """
    for head in _heads(data):
        if head.lines_at and head.lines:
            yield head.load_and_run[1], head.size, data[head.lines_at : head.lines_at + head.lines * _LINE_SIZE]


def section(data: bytes, wanted: str) -> Iterator[bytes]:
    """The content of a section that is not loaded, in each way in which its octets may lie.

    Sizes of debug information count octets (a published dump of what cl2000 18.1 has linked). Others may count words,
    with two octets to a word or one: whoever reads sees which it is.

    Raises:
        struct.error: the file is cut short.
    """
    for head in _heads(data):
        if head.raw and text(head.name, data) == wanted:
            words = head.words(data)
            yield words[: head.size]
            yield words
            yield words[::2]


def words_of(data: bytes, wanted: str) -> bytes:
    """The words of a section that is not loaded; empty without one. Raises as `section` does."""
    return next((head.words(data) for head in _heads(data) if head.raw and text(head.name, data) == wanted), b"")


def _name(name: bytes, data: bytes, strings: int) -> str | None:
    """Up to eight characters in place, or where they are in the table of strings; None for what is no name."""
    if name[:4] == bytes(4) and any(name):
        begin = strings + int.from_bytes(name[4:8], "little")
        end = data.find(0, begin)
        if end < 0:
            return None
        name = data[begin:end]
    return readable(name.rstrip(b"\0"))


def patched(data: bytes, name: str, address: int, words: Sequence[int]) -> bytes:
    """The file with other words at an address.

    Raises:
        InputError: no section has all of them.
    """
    for head in _heads(data):
        load = head.load_and_run[0]
        if head.is_loaded and load <= address and address + len(words) <= load + head.size:
            at = head.raw + 2 * (address - load)
            return data[:at] + struct.pack(f"<{len(words)}H", *words) + data[at + 2 * len(words) :]
    raise InputError(f"{name}: no section has 0x{address:06X} to 0x{address + len(words) - 1:06X}")
