"""COFF's own tables of line numbers, which TI's tools write where they write no DWARF (`-gcoff`).

A section has entries of six octets: an address and a number. A number of 0 begins a function, whose symbol the address
then is an index of; the numbers behind it count from the line that the function's .bf symbol has, which is 1. The file
is that of the .file symbol before the function. Source: TI's description of its COFF (SPRAAO8), from memory; sizes and
fields as in every COFF.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from stillspin.flash import coff
from stillspin.flash.debug_lines import Lines, Row, Source

_ENTRY = struct.Struct("<IH")
_LINE = struct.Struct("<4xH")
"""Of the entry behind a .bf symbol."""
_FILE = 103
"""Storage class."""
_NAME = 14


@dataclass(frozen=True)
class _Function:
    address: int
    file: str
    line: int


def read(data: bytes) -> Lines:
    """The lines of a file; none where it has no such tables.

    Raises:
        struct.error: the file is cut short.
    """
    functions = _functions(data)
    rows: list[Row] = []
    for run, size, entries in coff.line_tables(data):
        within: _Function | None = None
        for index in range(len(entries) // _ENTRY.size):
            address, number = _ENTRY.unpack_from(entries, index * _ENTRY.size)
            if number == 0:
                within = functions.get(address)
                address, number = (within.address, 1) if within else (0, 0)
            if within and number:
                rows.append(Row(address, Source(within.file, within.line + number - 1)))
        if rows and entries:
            rows.append(Row(run + size, None))
    return Lines(rows)


def _functions(data: bytes) -> dict[int, _Function]:
    """By the index of their symbols."""
    found: dict[int, _Function] = {}
    file, last, address = "?", 0, 0
    for index, entry, more in coff.raw_symbols(data):
        if entry.kind == _FILE and more:
            file = (coff.text(more[:_NAME], data) or "?").replace("\\", "/")
        elif entry.kind == coff.BEGIN_OR_END:
            if entry.name == ".bf" and len(more) >= _LINE.size:
                found[last] = _Function(address, file, _LINE.unpack_from(more)[0])
        elif entry.has_address and entry.section > 0:
            last, address = index, entry.value
    return found
