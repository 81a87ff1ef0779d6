"""The way to the drive at an address, opened."""

from __future__ import annotations

from stillspin.link.address import parse
from stillspin.link.serial_port import SerialTransport
from stillspin.link.transport import Transport


def connect(text: str) -> Transport:
    """The transport that an address stands for.

    Raises:
        InputError: it is no address.
        LinkError: what it names cannot be opened.
    """
    address = parse(text)
    if address.kind == "serial":
        return SerialTransport(address.channel, address.options["baud"])
    if address.kind == "virtual":
        from stillspin.board.virtual_transport import VirtualTransport  # noqa: PLC0415 - takes long to load

        return VirtualTransport(address.channel, speed=address.options["speed"])
    from stillspin.link.can_bus import CanTransport  # noqa: PLC0415 - the same

    return CanTransport(address.interface, address.channel, address.options["node"], address.options["bitrate"])
