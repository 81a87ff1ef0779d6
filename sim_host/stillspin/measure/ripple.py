"""What the excitation costs: the ripple of the true phase currents in a stretch that was looked into.

Ripple is everything above 1 kHz, above what speed and current control move at standstill and at low speed. The spectrum
has a Hann window; sums over its lines are exact for a stretch that is many times longer than the slowest line.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from stillspin.core import Signals

Floats = npt.NDArray[np.float64]

LOWEST = 1e3
"""Lower end of what counts as ripple, Hz."""

SUBHARMONIC = 9.5e3
"""Upper end of what lies below the switching frequency, Hz."""

AUDIBLE = 16e3
"""Upper end of what is heard, Hz."""

HIGHEST = 200e3
"""Upper end of what is counted, Hz."""

PHASES = ("i_a", "i_b", "i_c")

PERIOD = 100e-6
"""PWM period, s."""


def _squares(time: Floats, signal: Floats) -> tuple[Floats, Floats]:
    count = int(time.size)
    step = float(np.mean(np.diff(time))) if count > 1 else 0.0
    if count * step < 0.02:
        raise ValueError("the waveform is shorter than the 20 ms that its spectrum needs")
    window = np.hanning(count + 1)[:count]
    line = np.fft.rfft(window * (signal - np.mean(signal)))
    # Mean squares: 2 |X|² / (N sum w²) sums up to the signal's own.
    squares = 2.0 * np.abs(line) ** 2 / (count * np.sum(window**2))
    return np.asarray(np.fft.rfftfreq(count, step), np.float64), np.asarray(squares, np.float64)


def spectrum(raster: Signals) -> tuple[Floats, Floats]:
    """Line frequencies (Hz) and mean squares (A²) of the phase currents, summed over the phases.

    Raises:
        ValueError: the stretch is shorter than 20 ms.
    """
    lines = [_squares(raster["time"], np.asarray(raster[name], np.float64)) for name in PHASES]
    return lines[0][0], np.asarray(sum(squares for _, squares in lines), np.float64)


def rms(raster: Signals, lowest: float, highest: float) -> float:
    """Rms of a phase current between two frequencies (Hz), mean of the phases, A."""
    frequency, squares = spectrum(raster)
    inside = (frequency >= lowest) & (frequency <= highest)
    return float(np.sqrt(np.sum(squares[inside]) / 3.0))


def torque(raster: Signals, machine: Mapping[str, float]) -> float:
    """Rms of the torque above 1 kHz, N m: fundamental flux and constant inductances, no harmonics, no saturation."""
    a, b, c = (np.asarray(raster[name], np.float64) for name in PHASES)
    turned = (2.0 * a - b - c + 1j * np.sqrt(3.0) * (b - c)) / 3.0 * np.exp(-1j * np.asarray(raster["angle"]))
    saliency = machine["inductance_d"] - machine["inductance_q"]
    made = 1.5 * machine["pole_pairs"] * (machine["flux_linkage"] + saliency * turned.real) * turned.imag
    frequency, squares = _squares(raster["time"], made)
    inside = (frequency >= LOWEST) & (frequency <= HIGHEST)
    return float(np.sqrt(np.sum(squares[inside])))


def peak_to_peak(raster: Signals) -> float:
    """Largest peak-to-peak of a phase current within one PWM period, A."""
    time = raster["time"]
    step = float(np.mean(np.diff(time)))
    rows = round(PERIOD / step)
    whole = time.size // rows * rows
    if whole == 0:
        raise ValueError("the waveform is shorter than a period")
    return max(float(np.max(np.ptp(np.asarray(raster[name][:whole]).reshape(-1, rows), axis=1))) for name in PHASES)
