"""`stillspin can`: what is on the bus, decoded with the drive's DBC."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Annotated, Any

import can
import cantools
import typer
from cantools.database import Database
from cantools.database.errors import Error as DatabaseError

from stillspin import scales, whole_file
from stillspin.can import text_of
from stillspin.commands.connection import opened
from stillspin.errors import InputError
from stillspin.link import address
from stillspin.link.can_bus import open_bus
from stillspin.link.segments import NODES
from stillspin.options import DurationOption

_DBC = Path(__file__).resolve().parent.parent / "can" / "stillspin.dbc"
_NODE_MASK = 0x7F
"""An identifier is a base, a multiple of 0x80, plus the node."""
_WAIT = 0.2
_FLAG = ("STATUS", "SPEED_KNOWN")
_STATE, _START = "STATE", 3
_OF_ROTOR = {"STATUS": ("SPEED",), "TELEMETRY_1": ("LOAD_TORQUE",)}
"""Signals that are 0 on the bus, and unknown, while the flag is 0."""
_OF_CURRENTS = {"TELEMETRY_1": ("CURRENT_D", "CURRENT_Q")}
"""The same of these, but that a start shows them in the frame that it works in before it knows the rotor's."""


def bus(
    *,
    where: Annotated[
        str,
        typer.Argument(
            metavar="ADDRESS", help="can:slcan:/dev/ttyACM0 or can:socketcan:can0; with ?node=1 that node alone."
        ),
    ],
    dbc: Annotated[Path, typer.Option("--dbc", help="DBC file that describes the messages.")] = _DBC,
    duration: DurationOption = 0.0,
    changes: Annotated[bool, typer.Option("--changes", help="Only messages whose content has changed.")] = False,
    export: Annotated[
        Path | None,
        typer.Option(
            "--export", metavar="FILE", help="Write the DBC file of the node, as its edition has it, and end."
        ),
    ] = None,
) -> None:
    """Show every message of the bus with its signals, until Ctrl-C."""
    wanted = address.parse(where)
    if wanted.kind != "can":
        raise InputError(f"address '{where}': must be a CAN bus, such as can:slcan:/dev/ttyACM0")
    if export:
        with opened(where) as drive:
            told = text_of(drive.has_faults(), wanted.options["node"], scales.of(drive.parameters()))
            whole_file.write(export, told)
            print(f"node {wanted.options['node']}, {drive.identity.text}; see {export}")
        return
    only = wanted.options["node"] if "node=" in where else None
    decoder = Decoder(load(dbc))
    end = time.monotonic() + duration if duration else math.inf
    listened = open_bus(wanted.interface, wanted.channel, wanted.options["bitrate"])
    seen: dict[int, bytes] = {}
    try:
        while time.monotonic() < end:
            message = listened.recv(_WAIT)
            if message is None or (only is not None and message.arbitration_id & _NODE_MASK != only):
                continue
            data = bytes(message.data)
            if not (changes and seen.get(message.arbitration_id) == data):
                print(decoder.line(message), flush=True)
            seen[message.arbitration_id] = data
    except KeyboardInterrupt:
        if duration:  # without, it is the end
            raise
    finally:
        listened.shutdown()


def load(path: Path) -> Database:
    """A description of a bus.

    Raises:
        InputError: it cannot be read.
    """
    try:
        database = cantools.database.load_file(path)
    except (OSError, ValueError, DatabaseError) as error:
        raise InputError(f"--dbc {path}: cannot be read ({' '.join(str(error).split())})") from error
    if not isinstance(database, Database):
        raise InputError(f"--dbc {path}: describes no CAN bus")
    return database


class Decoder:
    """Messages in words. The description is for one node; the others' identifiers differ in the node alone."""

    def __init__(self, database: Database) -> None:
        self._database = database
        self._bases = {message.frame_id & ~_NODE_MASK: message for message in database.messages}
        described = {(message.name, signal.name) for message in database.messages for signal in message.signals}
        self._flagged = _FLAG in described
        self._known: set[int] = set()
        """Nodes whose last STATUS says that angle and speed are known."""
        self._starting: set[int] = set()
        """Nodes whose last STATUS says that they start."""

    def line(self, message: can.Message) -> str:
        """A line for a message: time, node, name, signals with units."""
        identifier, data = message.arbitration_id, bytes(message.data)
        node = identifier & _NODE_MASK
        known = self._bases.get(identifier & ~_NODE_MASK)
        head = f"{message.timestamp:.3f}  {identifier:03X}"
        if message.is_error_frame:
            return f"{head}  error frame"
        if known is None or message.is_extended_id or node not in NODES:
            return f"{head}  {data.hex(' ')}"
        try:
            values = known.decode(data, decode_choices=True)
        except (DatabaseError, ValueError):
            return f"{head}  node {node}  {known.name}  {data.hex(' ')} (not as the description says)"
        units = {signal.name: signal.unit or "" for signal in known.signals}
        return f"{head}  node {node}  {known.name}  {_signals(values, units, self._unknown(node, known.name, values))}"

    def _unknown(self, node: int, name: str, values: Any) -> Collection[str]:
        """Signals of a message whose numbers mean nothing now: a node that has not said that it knows does not."""
        if not self._flagged:
            return ()
        if name == _FLAG[0]:
            (self._known.add if values[_FLAG[1]] else self._known.discard)(node)
            (self._starting.add if _is_start(values.get(_STATE)) else self._starting.discard)(node)
        if node in self._known:
            return ()
        of_currents = () if node in self._starting else _OF_CURRENTS.get(name, ())
        return (*_OF_ROTOR.get(name, ()), *of_currents)


def _is_start(state: Any) -> bool:
    """Also of a description without words for the states."""
    return bool(getattr(state, "value", state) == _START)


def _signals(values: Any, units: Mapping[str, str], unknown: Collection[str]) -> str:
    shown = {name: f"{_number(value)} {units[name]}".rstrip() for name, value in values.items()}
    return "  ".join(f"{name} {'unknown' if name in unknown else text}" for name, text in shown.items())


def _number(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
