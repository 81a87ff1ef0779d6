"""What the server says to the page."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from stillspin.drive.state import Status

Message = dict[str, Any]
Tell = Callable[[Message], None]

_GUARD_STOPPED = 2
"""Bit of the status's link octet, firmware/link/requests_drive.c."""


_SHOWN = {
    "C": "°C", "ohm": "Ω", "us": "µs", "deg": "°", "kgm2": "kg m²", "rad/s2": "rad/s²", "A2s2": "A² s²",
    "Nm": "N m", "Nms": "N m s", "Vs": "V s", "mVs": "mV s",
}  # fmt: skip


def shown_unit(unit: str) -> str:
    """A unit of the drive, which has ASCII alone, as people write it."""
    return _SHOWN.get(unit, unit)


def for_page(value: float) -> float | None:
    """What JSON has for a number that is not known."""
    return None if math.isnan(value) else value


def status_message(status: Status) -> Message:
    """A status for the page."""
    raw = status.raw
    return {
        "t": "status",
        "time": status.time,
        "state": status.state,
        "number": raw.state,
        "energised": status.energised,
        "fault": status.fault,
        "remedy": status.remedy,
        "limits": list(status.limits),
        "speed": for_page(status.speed),
        "speed_known": status.speed_known,
        "reference": status.reference if status.energised else None,
        "store": status.store,
        "unsaved": status.unsaved_count or status.unsaved_text,
        "unheard": bool(raw.link & _GUARD_STOPPED),
        "commissioning": {"outcome": raw.outcome, "phase": raw.phase, "progress": raw.progress / 1000},
    }
