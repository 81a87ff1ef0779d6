"""The messages of the drive's CAN bus, as `stillspin.dbc` describes them to everybody."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Collection
from importlib.resources import files

import cantools.database
from cantools.database.can import Database

from stillspin import scales as boards

NODES = range(1, 32)
_CRC_POLYNOMIAL = 0x1D


def database(node: int = 1) -> Database:
    """The messages of one node: the file has those of node 1.

    Raises:
        ValueError: a node that cannot be.
    """
    if node not in NODES:
        raise ValueError(f"node {node}: must be {NODES[0]} to {NODES[-1]}")
    loaded = cantools.database.load_string(text(), database_format="dbc")
    if not isinstance(loaded, Database):
        raise TypeError("stillspin.dbc is no description of a CAN bus")
    for message in loaded.messages:
        message.frame_id += node - 1
    loaded.refresh()
    return loaded


def text_of(faults: Collection[int], node: int = 1, scales: boards.Pair = (0, 0)) -> str:
    """A DBC file of a node.

    Args:
        faults: that its edition of the firmware has.
        node: its number.
        scales: its parameters current_scale and voltage_scale; they move what a step of a current or a voltage is.

    Raises:
        ValueError: a node that cannot be.
    """
    loaded = database(node)
    fault = loaded.get_message_by_name("STATUS").get_signal_by_name("FAULT")
    fault.choices = OrderedDict((code, name) for code, name in (fault.choices or {}).items() if code in faults)
    for message in loaded.messages:
        for signal in message.signals:
            signal.scale *= 2.0 ** boards.exponent(signal.unit or "", scales)
    return str(loaded.as_dbc_string())


def text() -> str:
    """The DBC file."""
    return files(__name__).joinpath("stillspin.dbc").read_text(encoding="utf-8")


def crc8(identifier: int, data: bytes) -> int:
    """CRC-8 SAE J1850 over the identifier, low octet first, and data: the last octet of COMMAND."""
    crc = 0xFF
    for octet in identifier.to_bytes(2, "little") + data:
        crc ^= octet
        for _ in range(8):
            crc = (crc << 1 ^ (_CRC_POLYNOMIAL if crc & 0x80 else 0)) & 0xFF
    return crc ^ 0xFF


def command(bus: Database, *, mode: int, speed: float, alive: int, clear_fault: bool = False) -> tuple[int, bytes]:
    """Identifier and data of a COMMAND of this node's database; speed in rpm, mode 0 off, 1 stop, 2 run."""
    message = bus.get_message_by_name("COMMAND")
    fields = {"MODE": mode, "SPEED": speed, "ALIVE": alive % 16, "CLEAR_FAULT": int(clear_fault), "CRC": 0}
    data = message.encode(fields)[:-1]
    return message.frame_id, data + bytes((crc8(message.frame_id, data),))
