"""Records in pieces of seven octets, as CAN frames carry them.

The first octet of a frame: bit 7 in the first piece, bit 6 in the last, and the number of the piece, from 0 to 63.
A piece that is missing or out of order drops the record, and so does one too many; the next first piece begins anew.
"""

from __future__ import annotations

from collections.abc import Iterator

from stillspin.link.records import MAX_PACKED, Record, RecordError, pack, unpack

DEFAULT_BITRATE = 500_000
"""Of a bus, in bit/s."""
NODES = range(1, 32)
"""Numbers of drives on it."""
FIRST = 0x80
LAST = 0x40
COUNT = 0x3F
PIECE = 7


def split(record: Record) -> Iterator[bytes]:
    """The data of the frames, in order."""
    octets = pack(record)
    for number, at in enumerate(range(0, len(octets), PIECE)):
        first = FIRST if at == 0 else 0
        last = LAST if at + PIECE >= len(octets) else 0
        yield bytes((first | last | number & COUNT,)) + octets[at : at + PIECE]


class Joiner:
    """Puts frames together again."""

    def __init__(self) -> None:
        self.damaged = 0
        """Records that were dropped."""
        self._octets: bytearray | None = None
        self._next = 0

    def feed(self, data: bytes) -> Record | None:
        """The record that this frame completes, if it does."""
        if not data:
            return None
        head = data[0]
        if head & FIRST:
            if self._octets is not None:
                self.damaged += 1
            self._octets, self._next = bytearray(), 0
        if self._octets is None:
            return None
        if head & COUNT != self._next & COUNT or len(self._octets) + len(data) - 1 > MAX_PACKED:
            self._drop()
            return None
        self._octets += data[1:]
        self._next += 1
        if not head & LAST:
            return None
        octets, self._octets = bytes(self._octets), None
        try:
            return unpack(octets)
        except RecordError:
            self._drop()
            return None

    def _drop(self) -> None:
        self._octets = None
        self.damaged += 1
