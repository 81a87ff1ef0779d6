"""Executables of COFF as TI's linker leaves them, made by an encoder of their own.

Names of any length, auxiliary entries, sections that are empty, dummies, copied or beside the program, in pages.
"""

import struct
from typing import NamedTuple

TEXT, DATA, BSS = 0x20, 0x40, 0x80
DUMMY, COPY = 0x01, 0x10
EXTERNAL, STATIC, LABEL, FILE, FUNCTION = 2, 3, 6, 103, 101
ABSOLUTE = -1
_HEADS = 22 + 28


class Part(NamedTuple):
    """A section; its content is words, or octets beside the program, or how many words it takes."""

    name: str
    run: int
    content: tuple[int, ...] | bytes | int
    kind: int = TEXT
    load: int | None = None
    page: int = 0
    lines: tuple[tuple[int, int], ...] = ()


class Named(NamedTuple):
    """A symbol: `section` is its number or the name of its part; `more` are the octets of auxiliary entries."""

    name: str
    value: int
    section: int | str
    kind: int = EXTERNAL
    more: bytes = b""


class _Strings:
    def __init__(self) -> None:
        self.octets = bytearray(4)

    def field(self, name: str) -> bytes:
        """Eight octets: the name, or where it is."""
        if len(name) <= 8:
            return name.encode().ljust(8, b"\0")
        at = len(self.octets)
        self.octets += name.encode() + b"\0"
        return struct.pack("<II", 0, at)

    def table(self) -> bytes:
        return struct.pack("<I", len(self.octets)) + bytes(self.octets[4:])


def _content(part):
    if isinstance(part.content, bytes):
        return len(part.content), part.content
    if isinstance(part.content, int):
        return part.content, b""
    return len(part.content), struct.pack(f"<{len(part.content)}H", *part.content)


def _table(symbols, numbers, strings):
    table = b""
    for one in symbols:
        section = numbers[one.section] if isinstance(one.section, str) else one.section
        more = one.more + bytes(-len(one.more) % 18)
        table += strings.field(one.name) + struct.pack("<IhHBB", one.value, section, 0, one.kind, len(more) // 18)
        table += more
    return table


def linked(parts, symbols=(), entry=0x3F7FF6):
    """The file: heads, content, line numbers, symbols, strings. A section's second address is the one to load to."""
    strings = _Strings()
    at = _HEADS + 48 * len(parts)
    heads, behind = b"", b""
    for part in parts:
        size, octets = _content(part)
        raw = at + len(behind) if octets else 0
        behind += octets
        lines = at + len(behind) if part.lines else 0
        behind += b"".join(struct.pack("<IH", *line) for line in part.lines)
        load = part.run if part.load is None else part.load
        heads += strings.field(part.name)
        heads += struct.pack("<9I", part.run, load, size, raw, 0, lines, 0, len(part.lines), part.kind)
        heads += struct.pack("<HH", 0, part.page)
    table = _table(symbols, {part.name: number for number, part in enumerate(parts, 1)}, strings)
    head = struct.pack("<HHIIIHHH", 0xC2, len(parts), 0x55432101, at + len(behind), len(table) // 18, 28, 0x1103, 0x9D)
    optional = struct.pack("<HHIIIIII", 0x108, 0x0150, 0, 0, 0, entry, 0, 0)
    return head + optional + heads + behind + table + strings.table()
