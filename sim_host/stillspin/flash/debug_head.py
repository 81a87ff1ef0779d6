"""The head of a line program of DWARF 2 to 5 (section .debug_line): its numbers, and the files that it is about.

Source: the DWARF standard, versions 2 to 5, section on line number information.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from stillspin.flash.octets import Octets

_VERSIONS = range(2, 6)
_WITH_OPERATIONS = 4
"""The first version whose head has the operations of an instruction."""
_DESCRIBED = 5
"""The first version that describes the form of its lists, and counts files from 0."""
_PATH, _FOLDER = 1, 2
"""What an entry of a list says: contents of DWARF 5."""


@dataclass(frozen=True)
class Strings:
    """What paths of DWARF 5 may be kept in: the sections .debug_line_str and .debug_str."""

    of_lines: bytes = b""
    of_all: bytes = b""


@dataclass(frozen=True)
class Head:
    """Of one unit.

    Attributes:
        step: words of the smallest instruction.
        line_base, line_range: of the special opcodes.
        lengths: operands of the standard opcodes, 1 and on.
        files: paths by their numbers.
    """

    step: int
    line_base: int
    line_range: int
    lengths: list[int]
    files: dict[int, str]


def read(octets: Octets, strings: Strings) -> Head:
    """The head; the octets stand at the program then.

    Raises:
        IndexError: they end before.
        ValueError: another version, or a form that is none.
    """
    version = octets.number(2)
    if version not in _VERSIONS:
        raise ValueError(f"version {version}")
    if version >= _DESCRIBED:
        octets.number(2)  # sizes of an address and of a segment's selector
    begins = octets.number(4)
    begins += octets.at
    step = octets.number(1)
    if version >= _WITH_OPERATIONS:
        octets.number(1)  # operations of an instruction: one, the C28x is no VLIW
    octets.number(1)  # whether a row begins a statement at first
    line_base = octets.signed(1)
    line_range, base = octets.number(1), octets.number(1)
    if not line_range:
        raise ValueError("a range of no lines")
    lengths = [octets.number(1) for _ in range(1, base)]
    files = _described_files(octets, strings) if version >= _DESCRIBED else dict(enumerate(_files(octets), 1))
    octets.at = begins
    return Head(step, line_base, line_range, lengths, files)


def _files(octets: Octets) -> Iterator[str]:
    folders = list(iter(octets.text, ""))
    while name := octets.text():
        folder, _, _ = octets.unsigned_leb(), octets.unsigned_leb(), octets.unsigned_leb()
        yield _joined(folders[folder - 1] if 0 < folder <= len(folders) else "", name)


def _described_files(octets: Octets, strings: Strings) -> dict[int, str]:
    """Of DWARF 5: the first folder is that of the compilation, which a path that is short does without."""
    folders = [str(entry.get(_PATH, "")) for entry in _entries(octets, strings)]
    made = {}
    for number, entry in enumerate(_entries(octets, strings)):
        folder = int(entry.get(_FOLDER, 0))
        made[number] = _joined(folders[folder] if 0 < folder < len(folders) else "", str(entry.get(_PATH, "?")))
    return made


def _entries(octets: Octets, strings: Strings) -> list[dict[int, str | int]]:
    shape = [(octets.unsigned_leb(), octets.unsigned_leb()) for _ in range(octets.number(1))]
    forms = _forms(octets, strings)
    for _, form in shape:
        if form not in forms:
            raise ValueError(f"form 0x{form:02X}")
    count = octets.unsigned_leb()
    if count > len(octets.data):  # each has an octet at least
        raise ValueError(f"{count} entries")
    return [{content: forms[form]() for content, form in shape} for _ in range(count)]


def _forms(octets: Octets, strings: Strings) -> dict[int, Callable[[], str | int]]:
    """How a value is read, by the number of its form."""

    def elsewhere(section: bytes) -> str:
        there = Octets(section)
        there.at = octets.number(4)
        return there.text()

    def skipped(count: int) -> int:
        for _ in range(count):
            octets.number(1)
        return 0

    return {
        0x05: lambda: octets.number(2),
        0x06: lambda: octets.number(4),
        0x07: lambda: octets.number(8),
        0x08: octets.text,
        0x09: lambda: skipped(octets.unsigned_leb()),
        0x0B: lambda: octets.number(1),
        0x0E: lambda: elsewhere(strings.of_all),
        0x0F: octets.unsigned_leb,
        0x1E: lambda: skipped(16),
        0x1F: lambda: elsewhere(strings.of_lines),
    }


def _joined(folder: str, name: str) -> str:
    """A path in slashes; a name that is absolute has no folder."""
    path = name.replace("\\", "/")
    absolute = path.startswith("/") or path[1:3] == ":/"
    return path if absolute or not folder else f"{folder}/{path}".replace("\\", "/")
