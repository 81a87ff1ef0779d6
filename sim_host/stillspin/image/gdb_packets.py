"""The packets of GDB's remote serial protocol: framing, check sums, acknowledgements.

Source: "Debugging with GDB", appendix on the remote serial protocol.
"""

from __future__ import annotations

INTERRUPT = "\x03"
"""What stands for Ctrl-C among the packets."""
LARGEST = 0x4000


def framed(text: str) -> bytes:
    """A packet as it goes over the line."""
    body = bytearray()
    for octet in text.encode("latin-1"):
        if octet in b"#$}*":
            body += bytes((0x7D, octet ^ 0x20))
        else:
            body.append(octet)
    return b"$" + bytes(body) + b"#%02x" % (sum(body) & 0xFF)


def _plain(body: bytes) -> str:
    out = bytearray()
    octets = iter(body)
    for octet in octets:
        out.append(next(octets, 0) ^ 0x20 if octet == 0x7D else octet)
    return out.decode("latin-1")


class Line:
    """What comes over the line, taken apart. `acknowledged` ends when both sides have agreed on it."""

    def __init__(self) -> None:
        """Of a connection that has just been made."""
        self.acknowledged = True
        self._waiting = b""

    def take(self, octets: bytes) -> tuple[list[str], bytes]:
        """The packets that are complete, and what is to be sent for them at once."""
        self._waiting += octets
        packets: list[str] = []
        answers = b""
        while self._waiting:
            first, rest = self._waiting[:1], self._waiting[1:]
            if first == b"\x03":
                packets.append(INTERRUPT)
                self._waiting = rest
            elif first != b"$":  # an acknowledgement, or the rest of something broken
                self._waiting = rest
            else:
                body, mark, sum_ = rest.partition(b"#")
                if not mark or len(sum_) < 2:
                    break
                self._waiting = sum_[2:]
                right = sum_[:2].lower() == b"%02x" % (sum(body) & 0xFF)
                if self.acknowledged:
                    answers += b"+" if right else b"-"
                if right:
                    packets.append(_plain(body))
        if len(self._waiting) > 2 * LARGEST:
            self._waiting = b""
        return packets, answers
