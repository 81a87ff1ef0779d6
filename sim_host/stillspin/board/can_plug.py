"""What is plugged into the virtual board's CAN connector: an SLCAN adapter on a pseudo-terminal, or SocketCAN."""

from __future__ import annotations

import contextlib
from typing import Protocol

import can

from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.board.slcan import QUEUE, Adapter, Frame
from stillspin.core_board import NativeBoard
from stillspin.errors import InputError
from stillspin.link.can_bus import DEFAULT_BITRATE

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


class SocketcanPlug:
    """An interface of the kernel, such as vcan0. It has no bit rate of its own: the drive's default is taken."""

    def __init__(self, board: NativeBoard, channel: str) -> None:
        """Join it.

        Raises:
            InputError: there is no such interface, or the kernel has no CAN.
        """
        self._board = board
        self.name = channel
        try:
            self._bus = can.Bus(channel=channel, interface="socketcan")
        except (can.CanError, OSError, ValueError) as error:
            raise InputError(f"--socketcan {channel}: cannot be opened ({' '.join(str(error).split())})") from error
        board.can_open(DEFAULT_BITRATE)

    @property
    def listens_to(self) -> int | None:
        """See CanPlug."""
        return int(self._bus.fileno())

    @property
    def plain(self) -> int | None:
        """See CanPlug."""
        return None

    def pass_on(self, commands: bytes, left: bytes) -> None:
        """See CanPlug."""

    def hand_over(self) -> None:
        """See CanPlug."""
        while self._board.can_waiting < QUEUE:
            message = self._bus.recv(0)
            if message is None:
                return
            if not message.is_error_frame and not message.is_fd:
                data = b"" if message.is_remote_frame else bytes(message.data)
                self._board.can_write(
                    (message.arbitration_id, message.is_extended_id, message.is_remote_frame, message.dlc, data)
                )

    def hand_back(self) -> None:
        """See CanPlug."""
        for _, identifier, extended, remote, length, data in self._board.can_read():
            message = can.Message(
                arbitration_id=identifier, is_extended_id=extended, is_remote_frame=remote, dlc=length, data=data
            )
            with contextlib.suppress(can.CanError):  # the kernel's queue is full: nobody reads
                self._bus.send(message, timeout=0)

    def close(self) -> None:
        """See CanPlug."""
        self._bus.shutdown()
