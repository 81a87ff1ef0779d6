"""Consistent overhead byte stuffing (Cheshire and Baker 1999): octets without a zero among them, so that zero can mark.

Every block of up to 254 octets without a zero is preceded by its length plus one; a block shorter than that stands for
itself and a zero behind it. The costs are one octet, and one more in every 254.
"""

from __future__ import annotations

_BLOCK = 254


class CobsError(ValueError):
    """Not the encoding of anything."""


def encode(data: bytes) -> bytes:
    """`data` without zeros; not delimited."""
    out = bytearray()
    parts = data.split(b"\0")
    for index, part in enumerate(parts):
        rest = part
        while len(rest) >= _BLOCK:
            out.append(_BLOCK + 1)
            out += rest[:_BLOCK]
            rest = rest[_BLOCK:]
            if not rest and index == len(parts) - 1:
                return bytes(out)
        out.append(len(rest) + 1)
        out += rest
    return bytes(out)


def decode(encoded: bytes) -> bytes:
    """What `encode` was given.

    Raises:
        CobsError: empty, with a zero in it, or cut off.
    """
    if not encoded:
        raise CobsError("empty")
    out = bytearray()
    at = 0
    while at < len(encoded):
        length = encoded[at]
        block = encoded[at + 1 : at + length]
        if length == 0 or 0 in block:
            raise CobsError("a zero inside")
        if len(block) != length - 1:
            raise CobsError("cut off")
        out += block
        at += length
        if length <= _BLOCK and at < len(encoded):
            out.append(0)
    return bytes(out)
