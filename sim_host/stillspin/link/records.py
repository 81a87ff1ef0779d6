"""Records: what a drive and its client say to each other.

A record is a type, a tag, a body and a CRC-16/CCITT-FALSE over the three (polynomial 0x1021, initial value 0xFFFF, not
reflected), little-endian like every number in it. On the serial port it is COBS between two zeros; text between records
never contains a zero.
"""

from __future__ import annotations

import binascii
import struct
from dataclasses import dataclass

from stillspin.counted import counted
from stillspin.link import cobs

MARK = b"\0"
MAX_BODY = 240
MAX_ENCODED = 256
"""Octets between two zeros; what is longer is no record."""

ANSWER = 0x80
"""Added to the type of a request by its answer."""
EVENTS = range(0x40, 0x60)
"""Types of what the drive sends unasked; the tag is a counter."""

_HEAD = 2
_CRC = 2
MAX_PACKED = _HEAD + MAX_BODY + _CRC
"""Octets of the longest record with its CRC, before COBS."""


class RecordError(ValueError):
    """Octets that are no record."""


@dataclass(frozen=True)
class Record:
    """One record; `kind` and `tag` are octets."""

    kind: int
    tag: int
    body: bytes = b""

    @property
    def is_answer(self) -> bool:
        """Whether it answers a request."""
        return bool(self.kind & ANSWER)

    @property
    def is_event(self) -> bool:
        """Whether it came unasked."""
        return self.kind in EVENTS


def crc16(data: bytes) -> int:
    """CRC-16/CCITT-FALSE."""
    return binascii.crc_hqx(data, 0xFFFF)


def pack(record: Record) -> bytes:
    """The record with its CRC, before COBS: what CAN carries in pieces.

    Raises:
        RecordError: the body is longer than MAX_BODY.
    """
    if len(record.body) > MAX_BODY:
        raise RecordError(f"a body of {counted(len(record.body), 'octet')}; {MAX_BODY} fit")
    content = bytes((record.kind, record.tag)) + record.body
    return content + struct.pack("<H", crc16(content))


def unpack(octets: bytes) -> Record:
    """The reverse of `pack`.

    Raises:
        RecordError: too short, or its CRC does not fit.
    """
    if len(octets) < _HEAD + _CRC:
        raise RecordError("too short")
    content, crc = octets[:-_CRC], octets[-_CRC:]
    if struct.pack("<H", crc16(content)) != crc:
        raise RecordError("CRC")
    return Record(content[0], content[1], content[_HEAD:])


def to_wire(record: Record) -> bytes:
    """The record as it goes over the serial port, with a zero before and behind it."""
    return MARK + cobs.encode(pack(record)) + MARK


def from_cobs(encoded: bytes) -> Record:
    """What was between two zeros.

    Raises:
        RecordError: it is no record.
    """
    try:
        return unpack(cobs.decode(encoded))
    except cobs.CobsError as error:
        raise RecordError(str(error)) from None
