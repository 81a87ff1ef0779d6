"""What a drive tells of itself: its status and its faults, in users' units and in words."""

from __future__ import annotations

from dataclasses import dataclass

from stillspin.drive.describe import unpack

_Q16 = 2**16
_Q20 = 2**20
STATUS_FORM = "<IBBHiiBBBBHB"
FAULT_FORM = "<HIBBiiii"

BOOT, CALIBRATE, READY, START, RUN, STOP, FAULT, COMMISSION = range(8)
"""States of the drive, firmware/drive_api.h."""
ENERGISED = frozenset({START, RUN, STOP, COMMISSION})
COMMISSIONING_RUNNING = 1


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

    @classmethod
    def unpack(cls, body: bytes) -> RawStatus:
        """From the body of an answer."""
        return cls(*unpack(STATUS_FORM, body))


@dataclass(frozen=True)
class Status:
    """What the drive does now."""

    time: float
    """Seconds since the drive was switched on."""
    state: str
    fault: str
    """Empty when there is none."""
    remedy: str
    """What to do about it."""
    limits: tuple[str, ...]
    """What holds the drive back."""
    speed: float
    """rpm, as the drive estimates it."""
    reference: float
    """rpm, after the ramp."""
    store: str
    """State of the parameter store."""
    raw: RawStatus

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
    link_voltage_q16: int
    current_d_q20: int
    current_q_q20: int

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
    """rpm"""
    link_voltage: float
    """V"""
    current_d: float
    """A"""
    current_q: float
    """A"""
    code: int

    @classmethod
    def from_raw(cls, raw: RawFault, cause: str, state: str, remedy: str) -> Fault:
        """In users' units, with the words for code and state."""
        currents = (raw.current_d_q20 / _Q20, raw.current_q_q20 / _Q20)
        speed, link = raw.speed_q16 / _Q16, raw.link_voltage_q16 / _Q16
        return cls(raw.time_ms / 1e3, cause, state, remedy, speed, link, *currents, raw.code)


def rpm(q16: int) -> float:
    """Revolutions per minute of a Q16 value."""
    return q16 / _Q16
