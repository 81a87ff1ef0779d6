"""What a drive tells of itself: its status and its faults, in users' units and in words."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stillspin.counted import counted
from stillspin.drive.describe import unpack
from stillspin.drive.table import KNOWN_ROTOR, Table

_Q16 = 2**16
STATUS_FORM = "<IBBHiiBBBBHBBB"
FAULT_FORM = "<HIBBiiiiB"

BOOT, CALIBRATE, READY, START, RUN, STOP, FAULT, COMMISSION = range(8)
"""States of the drive, firmware/interfaces/state.h."""
WORDS = {
    BOOT: "boot",
    CALIBRATE: "calibrating",
    READY: "ready",
    START: "starting",
    RUN: "running",
    STOP: "stopping",
    FAULT: "FAULT",
    COMMISSION: "commissioning",
}
ENERGISED = frozenset({START, RUN, STOP, COMMISSION})
COMMISSIONING_RUNNING = 1
WIRING_FAULTS = range(25, 28)
"""Faults of which the signal `wiring` says which phase or sensor it is, firmware/start/flying/fault_list.h."""
_UNSAVED_UNKNOWN = 255


@dataclass(frozen=True)
class RawStatus:
    """The numbers of Request.STATUS."""

    time_ms: int
    state: int
    fault: int
    limits: int
    speed_q16: int
    reference_q16: int
    store: int
    save_progress: int
    outcome: int
    phase: int
    progress: int
    link: int
    known: int
    unsaved: int

    @classmethod
    def unpack(cls, body: bytes) -> RawStatus:
        """From the body of an answer."""
        return cls(*unpack(STATUS_FORM, body))

    @property
    def guarded(self) -> bool:
        """Whether the drive stops by itself when it hears nothing more from who holds it."""
        return bool(self.link & 1)

    @property
    def held(self) -> bool:
        """Whether it is this client that keeps the watchdog alive, because its start asked for it."""
        return bool(self.link & 4)

    @property
    def unsaved_known(self) -> int | None:
        """How many parameters are not saved; None when a save has failed."""
        return self.unsaved if self.unsaved < _UNSAVED_UNKNOWN else None


@dataclass(frozen=True)
class Status:
    """What the drive does now."""

    time: float
    """Seconds since the drive was switched on."""
    state: str
    fault: str
    """Empty when there is none; of a mistake of the wiring it says which phase or sensor, where the drive does."""
    remedy: str
    """What to do about it."""
    limits: tuple[str, ...]
    """What holds the drive back."""
    speed: float
    """rpm, as the drive estimates it; NaN while it is unknown."""
    speed_known: bool
    """False with the power stage off and until a start has found the rotor: the shaft may be turning."""
    reference: float
    """rpm, after the ramp; 0 with the power stage off, when nothing asks for a speed."""
    store: str
    """State of the parameter store."""
    unsaved: int | None
    """Parameters that the next power-on will not have as they are now; None when a save has failed."""
    raw: RawStatus

    @property
    def speed_text(self) -> str:
        """The speed for people."""
        return f"{self.speed:.1f} rpm" if self.speed_known else "speed unknown: the shaft may be turning"

    @property
    def reference_text(self) -> str:
        """What speed is asked for, for people; a dash where none is."""
        return f"{self.reference:.1f} rpm" if self.energised else "–"

    @property
    def fault_text(self) -> str:
        """The fault, and what to do about it; empty when there is none."""
        return "; ".join(filter(None, (self.fault, self.remedy)))

    @property
    def unsaved_text(self) -> str:
        """What would be lost with the power, for people; empty when nothing would."""
        if self.unsaved is None:
            return "parameters are not saved: the last save failed"
        return f"{self.unsaved_count}: 'save' keeps what is in force" if self.unsaved else ""

    @property
    def unsaved_count(self) -> str:
        """How many parameters are not saved, in words; empty where none is, or nobody knows."""
        verb = "is" if self.unsaved == 1 else "are"
        return f"{counted(self.unsaved, 'parameter')} {verb} not saved" if self.unsaved else ""

    @property
    def energised(self) -> bool:
        """Whether the power stage is, or may be, switching."""
        return self.raw.state in ENERGISED


@dataclass(frozen=True)
class RawFault:
    """The numbers of Request.FAULT."""

    total: int
    time_ms: int
    code: int
    state: int
    speed_q16: int
    link_voltage: int
    current_d: int
    current_q: int
    """With the fractional bits of the signals of these names."""
    known: int

    @classmethod
    def unpack(cls, body: bytes) -> RawFault:
        """From the body of an answer."""
        return cls(*unpack(FAULT_FORM, body))


@dataclass(frozen=True)
class Fault:
    """A fault in the drive's memory, and how things stood when it came."""

    time: float
    """Seconds since the drive was switched on."""
    cause: str
    state: str
    """What the drive was doing."""
    remedy: str
    """What to do about it; empty when the drive does not say."""
    speed: float
    """rpm; NaN where it was unknown."""
    link_voltage: float
    """V"""
    current_d: float
    """A; NaN with the power stage off, as current_q."""
    current_q: float
    """A"""
    code: int
    speed_known: bool

    @classmethod
    def from_raw(cls, raw: RawFault, words: tuple[str, str, str], table: Table) -> Fault:
        """In users' units: as the signals of the table have them, with cause, state and remedy in words."""
        cause, state, remedy = words
        known = bool(raw.known & KNOWN_ROTOR)
        link = table.signal("link_voltage").to_user(raw.link_voltage)
        d = table.signal("current_d").to_user(raw.current_d, raw.known)
        q = table.signal("current_q").to_user(raw.current_q, raw.known)
        speed = rpm(raw.speed_q16, known)
        return cls(raw.time_ms / 1e3, cause, state, remedy, speed, link, d, q, raw.code, known)


def rpm(q16: int, known: bool = True) -> float:
    """Revolutions per minute of a Q16 value; NaN of one that is not known."""
    return q16 / _Q16 if known else math.nan
