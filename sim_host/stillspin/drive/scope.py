"""The drive's captured scope: set-up, what comes back, and how 32-bit signals are made to fit 16-bit records."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from stillspin.drive.protocol import CONTROL_PERIOD
from stillspin.drive.recording import Recording
from stillspin.drive.table import Signal, Table
from stillspin.errors import InputError, did_you_mean
from stillspin.quantity import Range

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

MOST = 4
DEPTH = 512
"""Records that the drive keeps."""
CHUNK = 100
"""Records per Request.SCOPE_READ."""
EDGES = {"rising": 0, "falling": 1, "either": 2, "now": 3, "above": 4, "below": 5}
IDLE, FILLING, ARMED, TRIGGERED, DONE = range(5)
NOWHERE = 0xFFFF
_WORD = 2**15
_UNKNOWN = -_WORD
"""In a record: the signal was unknown."""
_SHIFT_MAX = 31
DECIMATION = Range(1, 0xFFFF, whole=True)
"""Control interrupts per record."""
BEFORE = Range(0, 99.9, "%")
"""Records before the trigger."""
# Bits of the raw numbers per unit that hold all that the limits let a drive reach, whatever its scales make of that in
# amperes and volts: a record keeps the upper ones when nothing else is asked for.
_REACH = {"A": 25, "V": 25, "rpm": 29, "turn": 31, "Nm": 22, "C": 16}


@dataclass(frozen=True)
class Channel:
    """A signal to record."""

    signal: str
    full_scale: float | None = None
    """Largest magnitude to be told apart, in the signal's unit; a smaller one gives a finer resolution."""


@dataclass(frozen=True)
class Trigger:
    """When to record."""

    signal: str = "speed"
    level: float | str = 0.0
    """In the signal's unit; text may have it behind the number."""
    edge: str = "now"
    """One of EDGES; `now` triggers at once, `above` and `below` need no edge."""
    hysteresis: float | None = None
    """How far an edge must come from beyond the level, in the signal's unit; None: a quarter of what the signal has
    spanned during the last second, half against the way that it has gone."""


@dataclass(frozen=True)
class Setup:
    """A capture as it is asked for."""

    channels: Sequence[Channel]
    trigger: Trigger = field(default_factory=Trigger)
    decimation: int = 1
    """Control interrupts (100 µs) per record."""
    pretrigger: float = 0.25
    """Share of the records before the trigger."""
    repeat: bool = False

    @property
    def duration(self) -> float:
        """Seconds that a whole capture covers."""
        return DEPTH * self.decimation * CONTROL_PERIOD


@dataclass(frozen=True)
class ScopeState:
    """Where a capture stands."""

    state: int
    recorded: int
    trigger_at: int
    trigger_time: float
    """Seconds since the drive was switched on."""

    @property
    def done(self) -> bool:
        """Whether it can be read."""
        return self.state == DONE


@dataclass(frozen=True)
class Capture(Recording):
    """What the scope recorded; `time` counts from the trigger and is negative before it."""

    clipped: tuple[str, ...]
    """Signals that went beyond their full scale."""
    trigger: Trigger
    trigger_time: float
    """Seconds since the drive was switched on."""
    interval: float
    """Seconds between two records."""
    version: str
    """Of the firmware."""

    @property
    def about(self) -> dict[str, Any]:
        """Firmware, trigger, interval, and what was clipped."""
        trigger = self.trigger
        return {
            "firmware": self.version,
            "trigger": {
                "signal": trigger.signal,
                "level": trigger.level,
                "edge": trigger.edge,
                "time": self.trigger_time,
            },
            "interval": self.interval,
            "clipped": list(self.clipped),
        }


def shift(signal: Signal, full_scale: float | None) -> int:
    """Bits to drop so that ±`full_scale` fits a 16-bit record."""
    if full_scale is None:  # numbers of states, bits, shares: as they are, down to 16 bits
        return max(0, _REACH.get(signal.unit, signal.q + 1) - 15)
    if not full_scale > 0:
        raise InputError(f"full scale of {signal.name}: must be above 0, not {full_scale:g}")
    bits = 0
    while bits < _SHIFT_MAX and full_scale * 2**signal.q > (_WORD << bits):
        bits += 1
    return bits


def encode(setup: Setup, table: Table) -> bytes:
    """The body of Request.SCOPE_SETUP.

    Raises:
        InputError: what is asked for is not possible; in words.
    """
    if not 1 <= len(setup.channels) <= MOST:
        raise InputError(f"{len(setup.channels)} scope channels; 1 … {MOST} are possible")
    DECIMATION.read(setup.decimation, "decimation")
    BEFORE.read(100.0 * setup.pretrigger, "pretrigger")
    edge = EDGES.get(setup.trigger.edge)
    if edge is None:
        raise InputError(f"no trigger edge '{setup.trigger.edge}'{did_you_mean(setup.trigger.edge, EDGES)}")
    signal = table.signal(setup.trigger.signal)
    before = min(DEPTH - 1, round(setup.pretrigger * DEPTH))
    head = (setup.decimation, before, setup.repeat, edge, signal.index, signal.to_raw(setup.trigger.level))
    body = struct.pack("<HHBBHiB", *head, len(setup.channels))
    for channel in setup.channels:
        chosen = table.signal(channel.signal)
        body += struct.pack("<HB", chosen.index, shift(chosen, channel.full_scale))
    if setup.trigger.hysteresis is not None:
        if not setup.trigger.hysteresis >= 0:
            raise InputError(f"hysteresis {setup.trigger.hysteresis:g}: must be 0 or more")
        body += struct.pack("<i", signal.to_raw(setup.trigger.hysteresis))
    return body


def decode(setup: Setup, state: ScopeState, words: Sequence[npt.NDArray[np.int16]], table: Table) -> Capture:
    """What was recorded, in users' units."""
    import numpy as np  # noqa: PLC0415 - takes long to load, and not all need it

    signals, units, clipped = {}, {}, []
    for channel, raw in zip(setup.channels, words, strict=True):
        signal = table.signal(channel.signal)
        bits = shift(signal, channel.full_scale)
        half = 0.5 if bits else 0.0  # dropping bits rounds down, half a step on average
        known = raw != _UNKNOWN
        signals[signal.name] = np.where(known, (raw.astype(np.float64) + half) * 2.0 ** (bits - signal.q), np.nan)
        units[signal.name] = signal.unit
        if np.any(np.abs(raw[known].astype(np.int32)) == _WORD - 1) and bits + 16 < 32:
            clipped.append(signal.name)
    interval = setup.decimation * CONTROL_PERIOD
    at = 0 if state.trigger_at == NOWHERE else state.trigger_at
    count = min((int(raw.size) for raw in words), default=0)
    time = (np.arange(count, dtype=np.float64) - at) * interval
    signals = {name: values[:count] for name, values in signals.items()}
    return Capture(time, signals, units, tuple(clipped), setup.trigger, state.trigger_time, interval, table.version)
