"""Numbers and texts out of octets, one after the other, as DWARF has them."""

from __future__ import annotations


def readable(name: bytes) -> str | None:
    """The characters of a symbol's name; None where there are others than those of names."""
    text = name.decode("ascii", "replace")
    return text if text.isascii() and text.isprintable() else None


class Octets:
    """A place in some octets, which goes on with what is read."""

    def __init__(self, data: bytes) -> None:
        """At their beginning."""
        self.data = data
        self.at = 0

    def number(self, count: int) -> int:
        """Little-endian. IndexError: they end before."""
        if count < 0 or self.at + count > len(self.data):
            raise IndexError("the octets end within a number")
        value = int.from_bytes(self.data[self.at : self.at + count], "little")
        self.at += count
        return value

    def signed(self, count: int) -> int:
        """The same in two's complement."""
        value = self.number(count)
        return value - (1 << 8 * count) if value >> (8 * count - 1) else value

    def text(self) -> str:
        """Up to the next zero. ValueError: there is none."""
        end = self.data.index(0, self.at)
        text = self.data[self.at : end].decode("utf-8", "replace")
        self.at = end + 1
        return text

    def unsigned_leb(self) -> int:
        """Seven bits to an octet, the lowest first."""
        return self._leb()[0]

    def signed_leb(self) -> int:
        """The same with a sign."""
        value, bits = self._leb()
        return value - (1 << bits) if value >> (bits - 1) else value

    def _leb(self) -> tuple[int, int]:
        value, bits = 0, 0
        while True:
            octet = self.number(1)
            value |= (octet & 0x7F) << bits
            bits += 7
            if not octet & 0x80:
                return value, bits
