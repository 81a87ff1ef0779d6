"""What happens inside PWM periods: gate patterns, switching frequency and spectrum of a stretch of a run.

A waveform has three tables: `raster` (true phase currents, angle and leg voltages at even times), `edges` (levels of
the two gate pins of a leg, one row for each change) and `samples` (instants at which the ADC held the phase currents).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stillspin.core import Signals, Waveform

Floats = npt.NDArray[np.float64]
Ticks = npt.NDArray[np.int64]

PERIOD = 10_000
"""Ticks of 10 ns in a PWM period."""

T_MIN = 2_000
"""The paper's shortest extended vector, ticks."""

HIGHEST = 50e3
"""Upper end of the spectrum that counts as distortion, Hz."""

_LOBE = 2  # half width of the window's main lobe, lines
_TURNS = 6  # fewer electrical periods leave no room between the lobes of DC and fundamental


def cut(waveform: Waveform, window: tuple[float, float]) -> Waveform:
    """The part of every table in a window (s)."""
    first, last = window
    parts: Waveform = {}
    for table, columns in waveform.items():
        mask = (columns["time"] >= first - 1e-9) & (columns["time"] < last - 1e-9)
        parts[table] = {name: data[mask] for name, data in columns.items()}
    return parts


@dataclass(frozen=True)
class Spectrum:
    """Line spectrum of the phase currents: Hz, and the amplitude's square averaged over the phases (A²).

    `fundamental`: its line; its lobe reaches two lines to either side.
    """

    frequency: Floats
    power: Floats
    fundamental: int

    def _lobe(self) -> slice:
        return slice(self.fundamental - _LOBE, self.fundamental + _LOBE + 1)

    @property
    def fundamental_power(self) -> float:
        """Of the whole lobe."""
        return float(np.sum(self.power[self._lobe()]))

    @property
    def distortion(self) -> float:
        """Everything but DC and fundamental up to the highest frequency, rms as a share of the fundamental."""
        rest = self.power.copy()
        rest[self._lobe()] = 0.0
        rest[: _LOBE + 1] = 0.0
        rest[self.frequency > HIGHEST] = 0.0
        return float(np.sqrt(np.sum(rest) / self.fundamental_power))


def spectrum(raster: Signals) -> Spectrum:
    """Spectrum over the largest whole number of electrical periods, Hann window.

    Raises:
        ValueError: the stretch is too short.
    """
    angle = np.abs(np.unwrap(np.asarray(raster["angle"], dtype=np.float64)))
    turned = np.abs(angle - angle[0]) / (2.0 * np.pi) if angle.size else np.zeros(1)
    turns = int(turned[-1])
    if turns < _TURNS:
        raise ValueError(f"the waveform has {turns} electrical periods, the spectrum needs {_TURNS}")
    count = int(np.searchsorted(turned, turns))
    step = float(np.mean(np.diff(raster["time"][:count])))
    window = np.hanning(count + 1)[:count]
    lines = [np.fft.rfft(window * np.asarray(raster[name][:count], np.float64)) for name in ("i_a", "i_b", "i_c")]
    squares = [np.square(2.0 * np.abs(line) / np.sum(window)) for line in lines]
    power: Floats = np.mean(squares, axis=0, dtype=np.float64)
    return Spectrum(np.asarray(np.fft.rfftfreq(count, step), np.float64), power, turns)


def switching_frequency(edges: Signals, seconds: float) -> float:
    """Mean over the legs of how often an upper device is switched on, Hz."""
    rises = 0
    for leg in range(3):
        upper = edges["upper"][edges["leg"] == leg]
        rises += int(np.sum(np.diff(upper) > 0.5))
    return rises / 3.0 / seconds


def levels(edges: Signals, leg: int) -> tuple[Ticks, npt.NDArray[np.bool_]]:
    """What the leg is told, with the dead band undone: ticks from which a level holds, and the level.

    The dead band delays the edge that switches a device on; the one that switches its opposite off is the command's.
    """
    mine = edges["leg"] == leg
    ticks = np.rint(edges["time"][mine] * 1e8).astype(np.int64)
    upper, lower = edges["upper"][mine] > 0.5, edges["lower"][mine] > 0.5
    if ticks.size == 0:
        raise ValueError("the waveform has no gate edges")
    at, level = [int(ticks[0])], [bool(upper[0])]
    for k in range(1, ticks.size):
        on, off = lower[k - 1] and not lower[k], upper[k - 1] and not upper[k]
        if on or off:
            at.append(int(ticks[k]))
            level.append(bool(on))
    return np.array(at), np.array(level)


@dataclass(frozen=True)
class Pattern:
    """One PWM period as the gates show it.

    Attributes:
        start: tick at which it starts.
        on: on-time of each leg, ticks.
        states: (state, from, to) in their order, ticks from the start; a state is a word such as "110" (a, b, c).
    """

    start: int
    on: tuple[int, int, int]
    states: tuple[tuple[str, int, int], ...]

    def time_in(self, state: str) -> int:
        """Ticks spent in a state."""
        return sum(last - first for name, first, last in self.states if name == state)


def patterns(waveform: Waveform) -> list[Pattern]:
    """Every whole period of the stretch, which starts with one."""
    time = waveform["raster"]["time"]
    if time.size < 2:
        return []
    first = round(float(time[0]) * 1e8)
    last = round(float(2.0 * time[-1] - time[-2]) * 1e8)
    legs = [levels(waveform["edges"], leg) for leg in range(3)]
    return [_pattern(start, legs) for start in range(first, last - PERIOD + 1, PERIOD)]


def _pattern(start: int, legs: list[tuple[Ticks, npt.NDArray[np.bool_]]]) -> Pattern:
    inside = [at[(at > start) & (at < start + PERIOD)] for at, _ in legs]
    corners = np.unique(np.concatenate([[start], *inside, [start + PERIOD]]))
    states: list[tuple[str, int, int]] = []
    on = [0, 0, 0]
    for first, last in zip(corners[:-1].tolist(), corners[1:].tolist(), strict=True):
        high = [bool(level[max(0, int(np.searchsorted(at, first, side="right")) - 1)]) for at, level in legs]
        for leg in range(3):
            on[leg] += (last - first) * high[leg]
        states.append(("".join("1" if level else "0" for level in high), first - start, last - start))
    return Pattern(start, (on[0], on[1], on[2]), tuple(states))


def is_extended(pattern: Pattern) -> bool | None:
    """Whether a period follows the paper's Figs 4 and 13; None where its vectors need no extension.

    Both active vectors shorter than T_min are made at least that long, and their complements give back what is too
    much: to the tick.
    """
    order = sorted(range(3), key=lambda leg: -pattern.on[leg])
    high = _word(order[:1])
    pair = _word(order[:2])
    for state, wanted in ((high, _net(pattern, order, 0)), (pair, _net(pattern, order, 1))):
        if wanted >= T_MIN:
            return None
        extended, given_back = pattern.time_in(state), pattern.time_in(_complement(state))
        if extended < T_MIN or extended - given_back != wanted:
            return False
    return True


def _net(pattern: Pattern, order: list[int], k: int) -> int:
    return pattern.on[order[k]] - pattern.on[order[k + 1]]


def _word(legs: list[int]) -> str:
    return "".join("1" if leg in legs else "0" for leg in range(3))


def _complement(state: str) -> str:
    return state.translate(str.maketrans("01", "10"))


def voltage_errors(waveform: Waveform, signals: Signals) -> Floats:
    """Mean phase voltage of every period against what was asked for it, ticks; one row a period, phases a, b, c.

    Args:
        waveform: gate edges.
        signals: records; what a control interrupt asks acts in the next period.
    """
    rows = np.rint(signals["time"] * 1e8).astype(np.int64)
    errors = []
    for pattern in patterns(waveform):
        k = int(np.searchsorted(rows, pattern.start - PERIOD - PERIOD // 2))
        if k >= rows.size or abs(int(rows[k]) - (pattern.start - PERIOD)) > PERIOD // 2:
            continue
        given = np.array(pattern.on) - np.mean(pattern.on)
        errors.append(given - phases(signals, k) * PERIOD / float(signals["v_link"][k]))
    if not errors:
        raise ValueError("no period whose command is recorded")
    return np.array(errors)


def phases(signals: Signals, k: int) -> Floats:
    """The phase voltages asked for in record k, V."""
    alpha, beta = float(signals["v_alpha"][k]), float(signals["v_beta"][k])
    half, side = alpha / 2.0, beta * np.sqrt(3.0) / 2.0
    return np.array([alpha, side - half, -side - half])


def sector_two(waveform: Waveform) -> Pattern | None:
    """The period whose voltage lies closest to the middle of the vectors 110 and 010, if any does."""

    def away(pattern: Pattern) -> Any:
        a, b, c = pattern.on
        angle = np.degrees(np.arctan2((b - c) * np.sqrt(3.0), 2 * a - b - c))
        return abs(angle - 90.0)

    found = min(patterns(waveform), key=away, default=None)
    return found if found is not None and away(found) < 30.0 else None
