"""Small executables of the C28x's EABI, made by an encoder of their own."""

import struct

CODE, DATA = 6, 3  # flags of sections: allocated and with instructions, allocated and written
FUNCTION, OBJECT, UNTYPED = 2, 1, 0


SEGMENT_OCTETS = 52 + 16
"""Where the first segment says how many octets it has in the file."""


def altered(data, at, value):
    """The same file with another 32-bit value at an offset."""
    return data[:at] + struct.pack("<I", value) + data[at + 4 :]


def elf(blocks, entry=0x3F4000, *, symbols=(), machine=141, kind=2, order=b"\x01\x01", load=None, runs=None):
    """An executable. `symbols` are (name, address, index of its block or None, type); `load` moves load addresses.

    One segment is without content, as .ebss. With `runs` a block is loaded where it is and runs elsewhere as the EABI
    has it: a segment and a section without content come behind all others, at the address to run at.
    """
    names = bytearray(b"\0")
    table = bytes(16)
    for name, value, block, form in symbols:
        section = 0xFFF1 if block is None else block + (1 if block < len(blocks) else 3)
        table += struct.pack("<IIIBBH", len(names), value, 0, 0x10 | form, 0, section)
        names += name.encode() + b"\0"
    runs = runs or {}
    heads = len(blocks) + 1 + len(runs)
    at = 52 + 32 * heads
    content, segments, sections = b"", b"", struct.pack("<10I", *(0,) * 10)
    for number, block in enumerate(blocks):
        octets = struct.pack(f"<{len(block.words)}H", *block.words)
        to = block.address + (load or {}).get(number, 0)
        segments += struct.pack("<8I", 1, at + len(content), block.address, to, len(octets), len(octets), 5, 2)
        flags = DATA if block.address < 0x3E8000 else CODE
        sections += struct.pack("<10I", 0, 1, flags, block.address, at + len(content), len(octets), 0, 0, 2, 0)
        content += octets
    segments += struct.pack("<8I", 1, 0, 0x8000, 0x8000, 0, 200, 6, 2)
    copied = b""
    for number, run in runs.items():
        octets = 2 * len(blocks[number].words)
        segments += struct.pack("<8I", 1, 0, run, run, 0, octets, 7, 2)
        copied += struct.pack("<10I", 0, 8, CODE, run, 0, octets, 0, 0, 2, 0)
    table_at = at + len(content)
    names_at = table_at + len(table)
    sections += struct.pack("<10I", 0, 2, 0, 0, table_at, len(table), len(blocks) + 2, 0, 4, 16)
    sections += struct.pack("<10I", 0, 3, 0, 0, names_at, len(names), 0, 0, 1, 0) + copied
    sections_at = names_at + len(names)
    head = struct.pack(
        "<16sHHIIIIIHHHHHH", b"\x7fELF" + order + b"\x01" + bytes(9), kind, machine, 1, entry, 52, sections_at, 0, 52,
        32, heads, 40, len(blocks) + 3 + len(runs), 0,
    )  # fmt: skip
    return head + segments + content + table + bytes(names) + sections
