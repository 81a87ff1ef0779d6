"""Bulk reading from a drive, and waiting for its store."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stillspin.drive.describe import Ask, unpack
from stillspin.drive.inspection import Inspection
from stillspin.drive.protocol import Command, Request, StatusCode, Words
from stillspin.drive.requester import wait_until
from stillspin.drive.scope import CHUNK
from stillspin.drive.table import Parameter, Table
from stillspin.link.errors import DriveError, RefusedError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

_READ_MOST = 4
"""Per question: answers that are short leave room on the line for a stream."""
_SAVE_TIMEOUT = 10.0
STORE_SAVING, STORE_SAVED, STORE_FAILED = 4, 5, 6
"""States of the store, firmware/store/store.h."""


class ConflictWarning(UserWarning):
    """A parameter was changed, and the drive would not start with what it has now."""


@dataclass(frozen=True)
class Change:
    """A parameter that has been changed."""

    value: float
    """In effect, in the parameter's unit."""
    conflict: str
    """Why the drive would not start now, in its words; empty when it would."""


def change(ask: Ask, parameter: Parameter, value: float | str) -> Change:
    """Change a parameter.

    Raises:
        InputError: no number, or out of range.
        RefusedError: the drive says why not.
    """
    wanted = parameter.to_raw(value)
    conflict = ""
    try:
        body = ask(Request.PARAMETER_SET, struct.pack("<Hi", parameter.id, wanted))
    except RefusedError as error:
        conflict = _prefixed(parameter.name, str(error))
        refused = RefusedError(conflict, error.status)
        if error.status != StatusCode.CONFLICT:
            raise refused from error
        body = ask(Request.PARAMETER_GET, struct.pack("<H", parameter.id))
        if unpack("<i", body)[0] != wanted:  # a drive that runs does not take it
            raise refused from error
    (raw,) = unpack("<i", body)
    return Change(parameter.to_user(raw), conflict)


def _prefixed(name: str, words: str) -> str:
    """What the drive says about a parameter, with its name in front unless it is there."""
    return words if words.startswith(name) else f"{name}: {words}"


def read_all(ask: Ask, table: Table) -> dict[str, int]:
    """The raw values of all parameters, by name."""
    names: Mapping[int, str] = {parameter.id: parameter.name for parameter in table.parameters}
    found: dict[str, int] = {}
    for first in range(0, len(names), _READ_MOST):
        count = min(_READ_MOST, len(names) - first)
        body = ask(Request.PARAMETER_READ, struct.pack("<HB", first, count))
        flat = unpack("<" + "Hi" * count, body)
        found |= {names[number]: raw for number, raw in zip(flat[::2], flat[1::2], strict=True)}
    return found


def read_channel(ask: Ask, channel: int, count: int, chunk: int = CHUNK) -> npt.NDArray[np.int16]:
    """The records of one channel of the scope, so many per question."""
    words = bytearray()
    while len(words) < 2 * count:
        at = len(words) // 2
        body = ask(Request.SCOPE_READ, struct.pack("<BHB", channel, at, min(chunk, count - at)))
        if not body:
            break
        words += body
    import numpy as np  # noqa: PLC0415 - takes long to load, and not all need it

    return np.frombuffer(bytes(words), dtype="<i2").astype(np.int16)


def save(drive: Inspection) -> None:
    """Ask for it, and wait until the store has it.

    Raises:
        DriveError: it has not.
    """
    drive.command(Command.SAVE)
    if not wait_until(lambda: drive.raw_status().store != STORE_SAVING, _SAVE_TIMEOUT, 0.05):
        raise DriveError(f"still saving after {_SAVE_TIMEOUT:g} s; the drive's status says how it ends")
    state = drive.raw_status().store
    if state != STORE_SAVED:
        raise DriveError(f"not saved; {drive.words(Words.STORE, state)}")
