"""32-bit little-endian ELF objects: sections, symbols, relocations. Only what the stand-in linker asks for."""

import struct
from dataclasses import dataclass, field
from pathlib import Path

_SYMTAB, _NOBITS, _REL = 2, 8, 9
_FUNCTION = 2
_ALLOCATED, _MERGED_STRINGS = 2, 0x20
CALLS = {10, 30}  # R_ARM_THM_CALL, R_ARM_THM_JUMP24


@dataclass
class Section:
    """A section with its relocations: (place, type, symbol)."""

    name: str
    size: int
    content: bytes
    allocated: bool
    is_strings: bool
    relocations: list[tuple[int, int, str]] = field(default_factory=list)


@dataclass(frozen=True)
class Symbol:
    """A symbol; section 0 when it is defined elsewhere."""

    name: str
    value: int
    size: int
    section: int
    is_global: bool
    is_function: bool


@dataclass
class ObjectFile:
    """One object."""

    path: Path
    sections: list[Section]
    symbols: list[Symbol]
    archive: str = ""  # that it is a member of

    @property
    def defined(self) -> set[str]:
        """Names that others may refer to."""
        return {symbol.name for symbol in self.symbols if symbol.section and symbol.is_global}

    @property
    def wanted(self) -> set[str]:
        """Names that others have to define."""
        return {symbol.name for symbol in self.symbols if not symbol.section and symbol.name}


def _text(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode()


def read_object(path: Path, archive: str = "") -> ObjectFile:
    """Parses one object file."""
    data = path.read_bytes()
    if data[:6] != b"\x7fELF\x01\x01":
        raise ValueError(f"{path} is no 32-bit object")
    (offset,) = struct.unpack_from("<I", data, 32)
    size, count, names_at = struct.unpack_from("<HHH", data, 46)
    headers = [struct.unpack_from("<10I", data, offset + k * size) for k in range(count)]
    names = data[headers[names_at][4] :]
    sections = [
        Section(
            _text(names, h[0]),
            h[5],
            b"" if h[1] == _NOBITS else data[h[4] : h[4] + h[5]],
            bool(h[2] & _ALLOCATED),
            bool(h[2] & _MERGED_STRINGS),
        )
        for h in headers
    ]
    symbols: list[Symbol] = []
    for header in (h for h in headers if h[1] == _SYMTAB):
        strings = data[headers[header[6]][4] :]
        for at in range(header[4], header[4] + header[5], 16):
            name, value, length, info, _, section = struct.unpack_from("<IIIBBH", data, at)
            kind = info & 15
            symbols.append(
                Symbol(_text(strings, name), value & ~int(kind == _FUNCTION), length, section, info >> 4 > 0, kind == 2)
            )
    for header in (h for h in headers if h[1] == _REL):
        for at in range(header[4], header[4] + header[5], 8):
            place, info = struct.unpack_from("<II", data, at)
            symbol = symbols[info >> 8]
            name = symbol.name or sections[symbol.section].name
            sections[header[7]].relocations.append((place, info & 0xFF, name))
    return ObjectFile(path, sections, symbols, archive)
