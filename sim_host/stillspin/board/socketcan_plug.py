"""The virtual board's CAN connector on an interface of the kernel."""

from __future__ import annotations

import contextlib

import can

from stillspin.board.slcan import QUEUE
from stillspin.core_board import NativeBoard
from stillspin.errors import InputError
from stillspin.link.segments import DEFAULT_BITRATE


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
