"""What a linked file says beside its words: names of functions and variables, source lines."""

from __future__ import annotations

import bisect
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import zip_longest
from pathlib import Path

from stillspin.counted import counted
from stillspin.errors import InputError, did_you_mean
from stillspin.flash import coff, coff_lines, debug_lines, memories
from stillspin.flash.debug_head import Strings
from stillspin.flash.debug_lines import Lines, Source
from stillspin.flash.sections import kind_of

_LAST = 0x3FFFFF
"""Address."""
_LINES, _LINE_STRINGS, _STRINGS = ".debug_line", ".debug_line_str", ".debug_str"


@dataclass(frozen=True)
class Names:
    """Of a format without them all are empty."""

    functions: Mapping[int, str] = field(default_factory=dict)
    addresses: Mapping[str, int] = field(default_factory=dict)
    """Of functions and variables. C's names have a _ in front in COFF."""
    lines: Lines = field(default_factory=lambda: Lines([]))
    damage: Sequence[str] = ()
    """What could not be read of the file's names, in words."""

    @cached_property
    def _places(self) -> list[int]:
        """Addresses of functions, in order."""
        return sorted(self.functions)

    def function(self, address: int) -> str:
        """The name of the function around an address, or the address."""
        index = bisect.bisect_right(self._places, address) - 1
        if index < 0 or self._places[index] not in (memories.stretch(address) or ()):
            return f"0x{address:06X}"
        first = self._places[index]
        return self.functions[first] + (f"+{address - first}" if address > first else "")

    def place(self, address: int) -> str:
        """An address for people: where it is, in which function, from which line."""
        there, name, source = f"0x{address:06X}", self.function(address), self.lines.at(address)
        return there + (f" {name}" if name != there else "") + (f" ({source})" if source else "")

    def of_name(self, name: str) -> int | None:
        """The address of a name as it is, or of C's: COFF puts a _ in front, the EABI does not."""
        ways = (name, f"_{name}", *([name[1:]] if name.startswith("_") else []))
        return next((self.addresses[way] for way in ways if way in self.addresses), None)

    def address(self, text: str, option: str) -> int:
        """What was typed: an address, a name with or without C's _, or FILE:LINE.

        Raises:
            InputError: there is nothing of it.
        """
        if (found := self.of_name(text)) is not None:
            if found > _LAST:
                raise InputError(f"{option}: {text} is a number in the image (0x{found:08X}), no address")
            return found
        file, _, number = text.rpartition(":")
        if file and number.isdigit():
            places = self.lines.places(file, int(number))
            if places:
                return places[0]
            raise InputError(f"{option}: no code comes from line {number} of {file}")
        try:
            address = int(text, 0)
        except ValueError:
            near = did_you_mean(text, self.addresses)
            raise InputError(
                f"{option}: '{text}' is neither an address such as 0x3F4000, nor FILE:LINE, nor a name that the image "
                f"has{near}"
            ) from None
        if not 0 <= address <= _LAST:
            raise InputError(f"{option}: {text} is out of range; 0x000000 … 0x{_LAST:06X}")
        return address


def read(file: Path) -> Names:
    """Those of a file. What is damaged is left out and said: the words are there, and that is what runs."""
    data = file.read_bytes()
    kind = kind_of(data)
    if kind is None:
        return Names()
    damage = []
    try:
        lines = _lines(data, kind.section) or (coff_lines.read(data) if kind is coff else Lines([]))
    except (struct.error, ValueError):
        lines = Lines([])
        damage.append("the source lines are damaged and left out")
    try:
        if lost := kind.lost_symbols(data):
            damage.append(f"{counted(lost, 'symbol')} cannot be read: left out")
        return Names(kind.functions(data), kind.addresses(data), lines, damage)
    except struct.error:
        return Names(lines=lines, damage=[*damage, "the table of symbols is damaged and left out"])


def _lines(data: bytes, section: Callable[[bytes, str], Iterator[bytes]]) -> Lines:
    """Those of DWARF. All sections of a file have their octets in words in the same way, which is to be seen."""
    ways = list(zip_longest(*(section(data, name) for name in (_LINES, _LINE_STRINGS, _STRINGS)), fillvalue=b""))
    for program, of_lines, of_all in sorted(ways, key=lambda way: not debug_lines.is_whole(way[0])):
        if lines := debug_lines.read(program, Strings(of_lines, of_all)):
            return lines
    return Lines([])


__all__ = ["Lines", "Names", "Source", "read"]
