"""The boot ROM's stream, as hex2000 --boot --sci8 writes it: key, reserved words, entry point, blocks.

Binary (--binary), or as text (--ascii): STX, octets as two digits with spaces, lines that begin with $A give an address
and are no data, ETX. A word is two octets, the low one first; an address two words, the high one first.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.flash.program import Block, Program, assemble

KEY = 0x08AA
_RESERVED = 8
_LONGEST = 0xFFFF
END = b"\0\0"
"""A block of size 0."""
_ADDRESS = re.compile(rb"\$A[0-9A-Fa-f]+,")
_STX, _ETX = b"\x02", b"\x03"


def is_text(data: bytes) -> bool:
    """Whether a file may be one of hex2000's in ASCII."""
    return data.startswith(_STX) or re.match(rb"\s*AA[\s,]+08\b", data, re.IGNORECASE) is not None


def is_binary(data: bytes) -> bool:
    """Whether a file may be the stream itself."""
    return data.startswith(KEY.to_bytes(2, "little"))


def from_text(data: bytes, name: str) -> Program:
    """Read the ASCII form.

    Raises:
        InputError: it is none.
    """
    if data.startswith(_STX) and _ETX not in data:
        raise InputError(f"{name}: is cut short before its end mark; copy it again")
    body = _ADDRESS.sub(b" ", data.partition(_ETX)[0].lstrip(_STX)).replace(b",", b" ")
    try:
        octets = bytes.fromhex(body.decode("ascii"))
    except ValueError:
        raise InputError(f"{name}: is no boot stream of hex2000: not all of it is hexadecimal") from None
    return from_octets(octets, name)


class _Reader:
    """Words of a stream that may break off."""

    def __init__(self, octets: bytes, name: str) -> None:
        self._octets, self._name, self.at = octets, name, 0

    def words(self, count: int) -> tuple[int, ...]:
        piece = self._octets[self.at : self.at + 2 * count]
        if len(piece) < 2 * count:
            raise InputError(
                f"{self._name}: the boot stream is cut short after {counted(len(self._octets), 'octet')}; copy it again"
            )
        self.at += 2 * count
        return tuple(piece[k] | piece[k + 1] << 8 for k in range(0, len(piece), 2))

    def address(self) -> int:
        high, low = self.words(2)
        return high << 16 | low

    @property
    def rest(self) -> bytes:
        return self._octets[self.at :]


def from_octets(octets: bytes, name: str) -> Program:
    """Read the stream itself.

    Raises:
        InputError: it is none, or breaks off.
    """
    reader = _Reader(octets, name)
    if reader.words(1) != (KEY,):
        raise InputError(
            f"{name}: is no boot stream: it does not begin with the key 0x08AA; make it with hex2000 --boot --sci8"
        )
    reader.words(_RESERVED)
    entry = reader.address()
    blocks = []
    while size := reader.words(1)[0]:
        address = reader.address()
        blocks.append(Block(address, reader.words(size)))
    if reader.rest.strip(b"\0\xff"):
        raise InputError(
            f"{name}: has {counted(len(reader.rest), 'octet')} behind the end of the boot stream; make it again"
        )
    return assemble(blocks, entry, "boot stream", name)


def _word(value: int) -> bytes:
    return value.to_bytes(2, "little")


def _address(value: int) -> bytes:
    return _word(value >> 16) + _word(value & 0xFFFF)


def head(entry: int) -> bytes:
    """Key, reserved words, entry point."""
    return _word(KEY) + bytes(2 * _RESERVED) + _address(entry)


def to_octets(program: Program) -> bytes:
    """A whole program as a file has it."""
    body = b"".join(octets for block in program.blocks for octets in block_octets(block))
    return head(program.entry or 0) + body + END


def block_octets(block: Block) -> Iterator[bytes]:
    """A block of the stream, in as many as its size needs."""
    for at in range(0, len(block.words), _LONGEST):
        words = block.words[at : at + _LONGEST]
        yield _word(len(words)) + _address(block.address + at) + b"".join(map(_word, words))
