"""The port of a board that proves to be virtual to who asks (stillspin/flash/virtual.py)."""

from __future__ import annotations

from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.flash import virtual


class ProvingPort(PseudoTerminal):
    """A pseudo-terminal that answers the question itself, when it is the first that a program says."""

    _listens = True
    _heard = b""

    def read(self, limit: int = 4096) -> bytes:
        """What is for the chip: all but the question."""
        if not self.is_open:
            self._listens, self._heard = True, b""
            return b""
        octets = super().read(limit)
        if not (self._listens and octets):
            return octets
        self._heard += octets
        if virtual.may_become_question(self._heard):
            if len(self._heard) == virtual.LENGTH:
                self.write(virtual.answer(self._heard))
                self._heard = b""
            return b""
        self._listens, octets, self._heard = False, self._heard, b""
        return octets
