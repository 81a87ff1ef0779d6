"""How a shaft turns of which nothing is known: two short-circuit pulses tell, on command."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum

from stillspin.drive.describe import unpack
from stillspin.drive.inspection import Inspection
from stillspin.drive.protocol import Command, Request
from stillspin.drive.requester import wait_until
from stillspin.drive.state import rpm
from stillspin.link.errors import DriveError

_FORM = "<Bi"
_TIMEOUT = 3.0


class Outcome(IntEnum):
    """What came of it, firmware/mode/commands.h."""

    NONE = 0
    RUNNING = 1
    TURNS = 2
    STANDS = 3
    """Or turns more slowly than the pulses can tell."""
    UNCLEAR = 4
    """It turns; the pulses contradict each other, its back-EMF gives a magnitude."""
    ENDED = 5
    """By a stop or a fault."""


@dataclass(frozen=True)
class Look:
    """What the pulses have shown."""

    outcome: Outcome
    speed: float
    """rpm when it TURNS, else NaN."""
    limit: float
    """rpm: it turns more slowly when it STANDS, at about that when it is UNCLEAR; NaN when it TURNS."""
    text: str
    """In the drive's words."""


def look(drive: Inspection) -> Look:
    """Send the command, wait for the pulses.

    Raises:
        RefusedError: the drive is not ready.
        DriveError: the look was ended by a stop or a fault.
    """
    drive.command(Command.LOOK)
    if not wait_until(lambda: read(drive).outcome != Outcome.RUNNING, _TIMEOUT):
        raise DriveError("the drive has not finished looking at its shaft; try again")
    seen = read(drive)
    if seen.outcome not in {Outcome.TURNS, Outcome.STANDS, Outcome.UNCLEAR}:
        fault = drive.status().fault
        raise DriveError(f"the shaft was not looked at: {fault or seen.text}")
    return seen


def read(drive: Inspection) -> Look:
    """What the last look has shown."""
    body = drive.link.request(Request.LOOK, b"", repeat=True)
    code, q16 = unpack(_FORM, body)
    outcome = Outcome(code)
    turns, about = outcome == Outcome.TURNS, outcome in {Outcome.STANDS, Outcome.UNCLEAR}
    text = body[struct.calcsize(_FORM) :].decode("ascii", "replace").rstrip("\0")
    return Look(outcome, rpm(q16, turns), rpm(q16) if about else math.nan, text)
