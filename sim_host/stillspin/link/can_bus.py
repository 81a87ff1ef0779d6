"""Records over a CAN bus, through python-can: an SLCAN adapter, SocketCAN, or any other bus it knows."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import serial

from stillspin.link.errors import LinkError, gone
from stillspin.link.records import Record
from stillspin.link.segments import DEFAULT_BITRATE, Joiner, split
from stillspin.link.serial_port import descriptor_of, explain
from stillspin.link.splitter import Damaged, Item
from stillspin.link.transport import beats_of_clock

REQUEST = 0x400
RESPONSE = 0x480
_SEND_TIMEOUT = 0.5


class CanTransport:
    """The records of one node on a bus; no console."""

    has_console = False

    def __init__(self, interface: str, channel: str, node: int, bitrate: int = DEFAULT_BITRATE) -> None:
        self.name = f"node {node} on CAN {interface} {channel}"
        self._node = node
        self._bus = open_bus(interface, channel, bitrate)
        self._joiner = Joiner()
        self._sending = threading.Lock()
        self._bus.set_filters([{"can_id": RESPONSE + node, "can_mask": 0x7FF, "extended": False}])

    @property
    def port(self) -> tuple[int, int] | None:
        """See Transport."""
        port = _serial_port(self._bus)
        return descriptor_of(port, self._node) if port else None

    def send(self, record: Record) -> None:
        """See Transport."""
        identifier = REQUEST + self._node
        try:
            with self._sending:
                for data in split(record):
                    message = can.Message(arbitration_id=identifier, is_extended_id=False, data=data)
                    self._bus.send(message, timeout=_SEND_TIMEOUT)
        except can.CanError as error:
            raise LinkError(f"{self.name}: cannot send: {error}") from error
        except OSError as error:  # of pyserial, too
            raise gone(self.name) from error

    def send_text(self, octets: bytes) -> None:
        """See Transport."""
        raise LinkError(f"{self.name}: the console is on the serial port only")

    def receive(self, timeout: float) -> list[Item]:
        """See Transport."""
        items: list[Item] = []
        damaged = self._joiner.damaged
        try:
            message = self._bus.recv(timeout)
            while message is not None:
                record = self._take(message)
                if record:
                    items.append(record)
                message = self._bus.recv(0)
        except (can.CanError, OSError, serial.SerialException, ValueError) as error:
            raise gone(self.name) from error
        items += [Damaged(b"", "a piece is missing")] * (self._joiner.damaged - damaged)
        return items

    def beats(self, interval: float, end: threading.Event) -> Iterator[None]:
        """See Transport."""
        return beats_of_clock(interval, end)

    def close(self) -> None:
        """See Transport."""
        with contextlib.suppress(can.CanError, OSError, serial.SerialException):
            self._bus.shutdown()

    def _take(self, message: can.Message) -> Record | None:
        wanted = message.arbitration_id == RESPONSE + self._node and not message.is_extended_id
        if not wanted or message.is_error_frame or message.is_remote_frame:
            return None
        return self._joiner.feed(bytes(message.data))


def open_bus(interface: str, channel: str, bitrate: int = DEFAULT_BITRATE) -> can.BusABC:
    """A bus of python-can.

    Args:
        interface: its name there, such as slcan or socketcan.
        channel: the port of the adapter, or the name of the kernel's interface.
        bitrate: bit/s; SocketCAN's is set with `ip link`.

    Raises:
        LinkError: it cannot be opened, in words.
    """
    options: dict[str, Any] = {"bitrate": bitrate}
    if interface == "slcan":
        options["sleep_after_open"] = 0.1  # the two seconds of the default are for an Arduino's boot loader
    if interface in {"socketcan", "virtual"}:
        options = {}
    try:
        bus = can.Bus(channel=channel, interface=interface, **options)
        _hold(bus)
    except (can.CanError, OSError, serial.SerialException, ValueError, ImportError) as error:
        raise LinkError(_explain(interface, channel, error)) from error
    return bus


def _serial_port(bus: can.BusABC) -> serial.Serial | None:
    """The port of an SLCAN adapter."""
    port = getattr(bus, "serialPortOrig", None)
    return port if isinstance(port, serial.Serial) else None


def _hold(bus: can.BusABC) -> None:
    """An adapter's port is for one program: two would each get half of the frames."""
    port = _serial_port(bus)
    if port:
        try:
            port.exclusive = True
        except (OSError, serial.SerialException):
            bus.shutdown()
            raise


def _explain(interface: str, channel: str, error: Exception) -> str:
    if interface == "slcan":
        return explain(channel, error)
    if interface == "socketcan" and not Path("/sys/class/net", channel).exists():
        return f"there is no CAN interface {channel}; ip -brief link show type can lists them"
    return f"CAN {interface} {channel} cannot be opened: {' '.join(str(error).split())}"
