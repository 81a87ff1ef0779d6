"""Follows a commissioning and reads what it has found."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from dataclasses import dataclass

from stillspin.drive.describe import unpack
from stillspin.drive.motion import Motion
from stillspin.drive.protocol import Request, Words
from stillspin.drive.state import COMMISSIONING_RUNNING
from stillspin.link.errors import DriveError

_INTERVAL = 0.1
_BEGIN = 5.0
DONE, PARTLY, ABORTED, FAILED = 2, 3, 4, 5
USED = 0

OnProgress = Callable[[float, str], bool | None]
"""Gets the share done, 0 to 1, and the phase in words, at the end what is not saved; False stops."""


@dataclass(frozen=True)
class Identified:
    """A value that the commissioning has measured."""

    name: str
    unit: str
    before: float
    value: float
    used: bool
    words: str
    """Why it is in use, or why not."""


@dataclass(frozen=True)
class Report:
    """The end of a commissioning."""

    values: tuple[Identified, ...]
    complete: bool
    """Whether every value is plausible and in use."""
    unsaved: str
    """What would be lost with the power, in words; empty when nothing would."""


def follow(drive: Motion, on_progress: OnProgress | None) -> Report:
    """Wait for the end of a commissioning that has been asked for.

    Raises:
        DriveError: it did not begin, was stopped, or ended in a fault.
    """
    asked = time.monotonic()
    begun = False
    while True:
        raw = drive.raw_status()
        running = raw.outcome == COMMISSIONING_RUNNING
        begun = begun or running
        if begun and not running:
            break
        if not begun and (raw.fault or time.monotonic() - asked > _BEGIN):
            cause = drive.describe_status(raw).fault_text or "the drive does not begin"
            raise DriveError(f"no commissioning: {cause}")
        if on_progress and on_progress(raw.progress / 1000, drive.words(Words.PHASE, raw.phase)) is False:
            drive.stop()
        time.sleep(_INTERVAL)
    if raw.outcome == ABORTED:
        raise DriveError("the commissioning was stopped; the parameters are as before")
    if raw.outcome not in {DONE, PARTLY}:
        raise DriveError(f"the commissioning failed: {drive.describe_status(raw).fault_text}")
    report = Report(results(drive), raw.outcome == DONE, drive.status().unsaved_text)
    if on_progress:
        on_progress(1.0, f"done: {report.unsaved}" if report.unsaved else "done")
    return report


def results(drive: Motion) -> tuple[Identified, ...]:
    """What the last commissioning found; empty without one."""
    names = {parameter.id: parameter.name for parameter in drive.table.parameters}
    found: list[Identified] = []
    total = 1
    while len(found) < total:
        body = drive.link.request(Request.COMMISSION_RESULT, struct.pack("<H", len(found)), repeat=True)
        (total,) = unpack("<H", body)
        if not total:
            break
        _, number, before, value, verdict = unpack("<HHiiB", body)
        parameter = drive.table.parameter(names[number])
        words = drive.words(Words.VERDICT, verdict)
        two = (parameter.to_user(before), parameter.to_user(value))
        found.append(Identified(parameter.name, parameter.unit, *two, verdict == USED, words))
    return tuple(found)
