"""An assembled program as an executable of EABI's ELF, with its labels and source lines, as cl2000 links C."""

from __future__ import annotations

import struct

from stillspin.c28x.program import Line, Program
from stillspin.flash import elf

_HEADER = struct.Struct("<16sHHIIIIIHHHHHH")
_CODE, _ABSOLUTE = 0x6, 0xFFF1
_PROGRAM, _SYMBOLS, _STRINGS = 1, 2, 3
_GLOBAL = 0x10
_DWARF = 3
_LINE_BASE, _LINE_RANGE = -5, 14
_STANDARD = bytes((0, 1, 1, 1, 1, 0, 0, 0, 1))
"""Operands of the opcodes 1 to 9."""


def runs(words: dict[int, int]) -> list[tuple[int, list[int]]]:
    """Words by address as runs of neighbours."""
    made: list[tuple[int, list[int]]] = []
    for address in sorted(words):
        if made and address == made[-1][0] + len(made[-1][1]):
            made[-1][1].append(words[address])
        else:
            made.append((address, [words[address]]))
    return made


def _unsigned(value: int) -> bytes:
    octets = bytearray()
    while value > 0x7F:
        octets.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*octets, value])


def _signed(value: int) -> bytes:
    octets = bytearray()
    while not -0x40 <= value < 0x40:
        octets.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*octets, value & 0x7F])


def _sequence(rows: list[tuple[int, Line]], files: list[str], end: int) -> bytes:
    """Opcodes for code in a row: each row by its steps from the one before."""
    at, file, number = rows[0][0], 1, 1
    octets = b"\0\x05\x02" + struct.pack("<I", at)
    for address, line in rows:
        octets += b"\x02" + _unsigned(address - at) if address > at else b""
        wanted = files.index(line.file) + 1
        octets += b"\x04" + _unsigned(wanted) if wanted != file else b""
        octets += b"\x03" + _signed(line.number - number) + b"\x01"
        at, file, number = address, wanted, line.number
    return octets + b"\x02" + _unsigned(end - at) + b"\0\x01\x01"


def debug_lines(program: Program) -> bytes:
    """The section .debug_line of a program that was assembled from files."""
    files = sorted({line.file for line in program.lines.values()})
    table = b"\0" + b"".join(name.encode() + b"\0\0\0\0" for name in files) + b"\0"
    opcodes = struct.pack("<BBbBB", 1, 1, _LINE_BASE, _LINE_RANGE, len(_STANDARD) + 1) + _STANDARD
    sequences = b""
    for first, words in runs(program.words):
        end = first + len(words)
        rows = [(at, program.lines[at]) for at in range(first, end) if at in program.lines]
        sequences += _sequence(rows, files, end) if rows else b""
    body = struct.pack("<HI", _DWARF, len(opcodes + table)) + opcodes + table + sequences
    return struct.pack("<I", len(body)) + body


class _Strings:
    def __init__(self) -> None:
        self.octets = bytearray(b"\0")

    def place(self, text: str) -> int:
        self.octets += text.encode() + b"\0"
        return len(self.octets) - len(text) - 1


def _symbols(program: Program, blocks: list[tuple[int, list[int]]], strings: _Strings) -> bytes:
    places = dict(program.labels)
    known = {name.upper() for name in places}
    places |= {name: program.symbols[name] for name in sorted(program.told - known) if name in program.symbols}
    table = bytes(16)
    for name, value in places.items():
        inside = (index for index, (first, words) in enumerate(blocks, 1) if first <= value < first + len(words))
        section = next(inside, _ABSOLUTE)
        table += struct.pack("<IIIBBH", strings.place(name), value, 0, _GLOBAL, 0, section)
    return table


def to_elf(program: Program, entry: int) -> bytes:
    """An executable.

    Args:
        program: what was assembled.
        entry: where it begins.
    """
    blocks = runs(program.words)
    strings = _Strings()
    symbols = _symbols(program, blocks, strings)
    contents = [struct.pack(f"<{len(words)}H", *words) for _, words in blocks]
    parts = [
        *(
            (f".text{index}", _PROGRAM, first, octets)
            for index, ((first, _), octets) in enumerate(zip(blocks, contents, strict=True))
        ),
        (".debug_line", _PROGRAM, 0, debug_lines(program)),
        (".symtab", _SYMBOLS, 0, symbols),
    ]
    named = [(strings.place(name), kind, address, octets) for name, kind, address, octets in parts]
    named.append((strings.place(".strtab"), _STRINGS, 0, b""))
    named[-1] = (*named[-1][:3], bytes(strings.octets))
    return _file(named, len(blocks), entry)


def _file(named: list[tuple[int, int, int, bytes]], loaded: int, entry: int) -> bytes:
    at = _HEADER.size + 32 * loaded
    segments, sections, content = b"", bytes(40), b""
    for index, (name, kind, address, octets) in enumerate(named):
        place = at + len(content)
        size = len(octets)
        if index < loaded:
            segments += struct.pack("<8I", 1, place, address, address, size, size, 5, 2)
        table = (len(named), 1, 4, 16) if kind == _SYMBOLS else (0, 0, 1, 0)
        sections += struct.pack("<10I", name, kind, _CODE if index < loaded else 0, address, place, size, *table)
        content += octets
    head = _HEADER.pack(
        elf.MAGIC + b"\x01\x01\x01" + bytes(9), 2, elf.MACHINE, 1, entry, _HEADER.size, at + len(content), 0,
        _HEADER.size, 32, loaded, 40, len(named) + 1, len(named),
    )  # fmt: skip
    return head + segments + content + sections
