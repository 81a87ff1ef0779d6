"""Which line of which source file an address comes from: the line programs of DWARF 2 to 5 (section .debug_line).

cl2000 writes them with `-g`, and without too much optimisation; addresses are those of the C28x, which count words.
Source: the DWARF standard, versions 2 to 5, section on line number information.
"""

from __future__ import annotations

import bisect
from collections.abc import Iterator
from typing import NamedTuple

from stillspin.flash import debug_head
from stillspin.flash.debug_head import Head, Strings
from stillspin.flash.octets import Octets

NO_STRINGS = Strings()
_WIDE = 0xFFFFFFF0
"""From here on a length stands for 64-bit DWARF, which no compiler of this chip writes."""


class Source(NamedTuple):
    """A line, the first is 1."""

    file: str
    number: int

    def __str__(self) -> str:
        """For people, and for editors that follow it."""
        return f"{self.file}:{self.number}"


class Row(NamedTuple):
    """From this address on; no source where a sequence ends."""

    address: int
    source: Source | None


class Lines:
    """The lines of a program by address."""

    def __init__(self, rows: list[Row]) -> None:
        """Rows in any order; of those at one address the last counts, an end least."""
        kept: dict[int, Source | None] = {}
        for address, source in rows:
            if source is not None or address not in kept:
                kept[address] = source
        self._rows = sorted(kept.items())
        self._addresses = [address for address, _ in self._rows]

    def __bool__(self) -> bool:
        """Whether there are any."""
        return bool(self._rows)

    def at(self, address: int) -> Source | None:
        """The line that the instruction at an address comes from; None where nobody says."""
        index = bisect.bisect_right(self._addresses, address) - 1
        return self._rows[index][1] if index >= 0 else None

    def places(self, file: str, number: int) -> list[int]:
        """Addresses at which a line begins; the file may be given by the end of its path."""
        file = file.replace("\\", "/")
        return [
            address
            for address, source in self._rows
            if source is not None and source.number == number and f"/{source.file}".endswith(f"/{file}")
        ]


def read(section: bytes, strings: Strings = NO_STRINGS) -> Lines:
    """The lines of a section. What is of another version, or damaged, is left out."""
    rows: list[Row] = []
    for unit in _units(section):
        try:
            rows += _unit(unit, strings)
        except (IndexError, ValueError):
            continue
    return Lines(rows)


def is_whole(section: bytes) -> bool:
    """Whether units follow each other up to its end, but for what fills words."""
    at = 0
    while at + 4 <= len(section):
        at += 4 + int.from_bytes(section[at : at + 4], "little")
    return at <= len(section)


def _units(section: bytes) -> Iterator[bytes]:
    at = 0
    while at + 4 <= len(section):
        length = int.from_bytes(section[at : at + 4], "little")
        if length >= _WIDE or length == 0:
            return
        yield section[at + 4 : at + 4 + length]
        at += 4 + length


class _Machine:
    """The state of a line program and what its opcodes do to it."""

    def __init__(self, head: Head) -> None:
        self.head = head
        self.rows: list[Row] = []
        self.reset()

    def reset(self) -> None:
        self.address, self.file, self.line = 0, 1, 1

    def row(self) -> None:
        self.rows.append(Row(self.address, Source(self.head.files.get(self.file, "?"), self.line)))

    def special(self, opcode: int) -> None:
        adjusted = opcode - len(self.head.lengths) - 1
        self.address += adjusted // self.head.line_range * self.head.step
        self.line += self.head.line_base + adjusted % self.head.line_range
        self.row()

    def standard(self, opcode: int, octets: Octets) -> None:
        if opcode == 1:
            self.row()
        elif opcode == 2:
            self.address += octets.unsigned_leb() * self.head.step
        elif opcode == 3:
            self.line += octets.signed_leb()
        elif opcode == 4:
            self.file = octets.unsigned_leb()
        elif opcode == 8:
            self.address += (255 - len(self.head.lengths) - 1) // self.head.line_range * self.head.step
        elif opcode == 9:
            self.address += octets.number(2)
        else:  # columns, blocks and what later versions added: operands that say nothing about lines
            for _ in range(self.head.lengths[opcode - 1]):
                octets.unsigned_leb()

    def extended(self, octets: Octets) -> None:
        length = octets.unsigned_leb()
        end = octets.at + length
        opcode = octets.number(1)
        if opcode == 1:
            self.rows.append(Row(self.address, None))
            self.reset()
        elif opcode == 2:
            self.address = octets.number(length - 1)
        octets.at = end


def _unit(unit: bytes, strings: Strings) -> list[Row]:
    octets = Octets(unit)
    machine = _Machine(debug_head.read(octets, strings))
    while octets.at < len(unit):
        opcode = octets.number(1)
        if opcode > len(machine.head.lengths):
            machine.special(opcode)
        elif opcode:
            machine.standard(opcode, octets)
        else:
            machine.extended(octets)
    return machine.rows
