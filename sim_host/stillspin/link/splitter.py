"""Takes text and records out of one stream of octets, whatever noise is between them.

A zero begins a record and a zero ends it. A zero behind something that is no record may as well be the beginning of the
next one, so the splitter then looks for a record at once: a record that arrives whole is found, whatever came before
it. What looked like a damaged record but is readable text, is text.
"""

from __future__ import annotations

from dataclasses import dataclass

from stillspin.link.records import MARK, MAX_ENCODED, Record, RecordError, from_cobs

REST = 0.1
"""Seconds without an octet that end a record which has begun."""
_TEXT = frozenset((*range(0x20, 0x7F), 0x07, 0x08, 0x09, 0x0A, 0x0D, 0x1B))


@dataclass(frozen=True)
class Text:
    """Octets outside of records."""

    octets: bytes


@dataclass(frozen=True)
class Damaged:
    """Octets that were to be a record, and why they are none."""

    octets: bytes
    reason: str


Item = Text | Record | Damaged


class Splitter:
    """Keeps what is incomplete between two calls of `feed`."""

    def __init__(self) -> None:
        self._inside = False  # behind a zero
        self._doubtful = False  # that zero may have been an end
        self._pending = bytearray()
        self._last = 0.0

    def feed(self, octets: bytes, now: float) -> list[Item]:
        """What is complete with these octets.

        Args:
            octets: as received; empty when a reader has waited and there was nothing. Only this lets time pass: a
                reader that comes late finds the octets of a whole record.
            now: monotonic seconds.
        """
        if not octets:
            rested = self._inside and now - self._last > REST
            return self._give_up("cut off") if rested else []
        self._last = now
        items: list[Item] = []
        while octets:
            head, mark, octets = octets.partition(MARK)
            items += self._inside_part(head) if self._inside else self._text(head)
            if mark:
                items += self._mark()
        return items

    @staticmethod
    def _text(octets: bytes) -> list[Item]:
        return [Text(octets)] if octets else []

    def _inside_part(self, octets: bytes) -> list[Item]:
        self._pending += octets
        return self._give_up("too long") if len(self._pending) > MAX_ENCODED else []

    def _mark(self) -> list[Item]:
        if not self._inside or not self._pending:
            self._inside = True
            return []
        try:
            record = from_cobs(bytes(self._pending))
        except RecordError as error:
            items = self._broken(str(error))
            self._doubtful = True
            return items
        self._leave()
        return [record]

    def _give_up(self, reason: str) -> list[Item]:
        items = self._broken(reason) if self._pending else []
        self._leave()
        return items

    def _broken(self, reason: str) -> list[Item]:
        octets = bytes(self._pending)
        self._pending.clear()
        if self._doubtful and _TEXT.issuperset(octets):
            return [Text(octets)]
        return [Damaged(octets, reason)]

    def _leave(self) -> None:
        self._inside = self._doubtful = False
        self._pending.clear()
