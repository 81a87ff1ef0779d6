"""What is plugged into the virtual board's CAN connector; an SLCAN adapter on a pseudo-terminal."""

from __future__ import annotations

from typing import Protocol

from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.board.slcan import Adapter, Frame
from stillspin.core_board import NativeBoard

_AT_ONCE = 1024  # octets taken from the port in one slice


class CanPlug(Protocol):
    """Passes frames between programs and the board, before and after each slice of time."""

    name: str

    @property
    def listens_to(self) -> int | None:
        """Descriptor at which the next frame of a program shows; None while there is no program."""
        ...

    @property
    def plain(self) -> int | None:
        """Descriptor of a port at which nothing but plain frames and their lines pass, for native code; None: another.

        -1 while it has to be looked at here first.
        """
        ...

    def hand_over(self) -> None:
        """What programs have sent goes to the board."""
        ...

    def pass_on(self, commands: bytes, left: bytes) -> None:
        """What native code leaves over at that port: commands for the adapter, octets for the program."""
        ...

    def hand_back(self) -> None:
        """What the board has sent goes to the programs."""
        ...

    def close(self) -> None:
        """Unplug it."""
        ...


class SlcanPlug:
    """A CANable on a pseudo-terminal."""

    def __init__(self, board: NativeBoard, port: PseudoTerminal) -> None:
        self._board = board
        self.port = port
        self.adapter = Adapter(board)
        self.name = port.name
        self._answers = b""  # of the adapter, which go to the program with the frames of the slice

    @property
    def listens_to(self) -> int | None:
        """See CanPlug."""
        return self.port.listens_to

    @property
    def plain(self) -> int | None:
        """See CanPlug."""
        listens_to = self.port.listens_to
        return listens_to if listens_to is not None and self.adapter.is_plain else -1

    def pass_on(self, commands: bytes, left: bytes) -> None:
        """See CanPlug."""
        self.port.write(left + self.adapter.feed(commands))

    def hand_over(self) -> None:
        """See CanPlug. A program that sends faster than the bus is held back."""
        if self.adapter.has_room:
            octets = self.port.read(_AT_ONCE)
            if octets:
                self._answers += self.adapter.feed(octets)

    def hand_back(self) -> None:
        """See CanPlug."""
        octets, self._answers = self._answers, b""
        for heard in self._board.can_read():
            octets += self.adapter.frame(Frame(*heard))
        if octets:
            self.port.write(octets)

    def close(self) -> None:
        """See CanPlug."""
        self.port.close()
