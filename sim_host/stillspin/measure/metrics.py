"""Figures of merit of a run, computed from its recorded signals.

Definitions (the same for every scenario):
- position error: true electrical angle minus the angle that the controller used at the same instant, wrapped to
  ±180°, in electrical degrees; `peak` over the window, `rms` over the window's last second;
- speed ripple: half the peak-to-peak of the true shaft speed over the window's last second;
- overshoot, settling (2 % of the step), dip, recovery: of the true shaft speed.
A figure in a window shorter than a second that asks for its last second takes all of it. Values that do not exist, such
as a settling time that the window does not see the end of, are infinite.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stillspin.core import Signals
from stillspin.measure import bound, deviation_sweep, flux_metrics, ripple, speed_profile, waveforms
from stillspin.measure.pieces import Floats, Piece, as_floats, wrap_degrees

SETTLED = 0.02
"""Half width of the settling band, as a share of the step."""

QUIET = 0.05
"""For which share of the window, at its end, the speed must have stayed in the band to count as settled."""


def position_error(signals: Signals) -> Floats:
    """True minus used electrical angle, degrees el., of every record."""
    return wrap_degrees(as_floats(signals["true_angle"]) - as_floats(signals["est_angle"]))


def position_error_peak(piece: Piece) -> float:
    """Largest magnitude of the position error in the window, degrees el."""
    return float(np.max(np.abs(position_error(piece.signals))))


def position_error_rms(piece: Piece) -> float:
    """Root mean square of the position error over the last second, degrees el. A constant error counts in full."""
    return float(np.sqrt(np.mean(np.square(position_error(piece.last().signals)))))


def speed_ripple(piece: Piece) -> float:
    """Half the peak-to-peak of the true speed over the last second, rpm."""
    return float(np.ptp(piece.last().speed)) / 2.0


def speed_error(piece: Piece) -> float:
    """Magnitude of the mean of true minus commanded speed over the last second, rpm."""
    last = piece.last()
    return abs(float(np.mean(last.speed - last.command)))


def mean_speed_error(piece: Piece) -> float:
    """Magnitude of the mean of true minus commanded speed over the whole window, rpm: do the turns agree."""
    return abs(float(np.mean(piece.speed - piece.command)))


def speed_error_share(piece: Piece) -> float:
    """The speed error in percent of the commanded speed at the end."""
    return 100.0 * speed_error(piece) / abs(piece.target) if piece.target else float("inf")


def overshoot(piece: Piece) -> float:
    """How far the true speed goes beyond the target of a step that begins with the window, in percent of the step."""
    step = piece.target - piece.initial
    if step == 0.0:
        return float("inf")
    beyond = (piece.speed - piece.target) * np.sign(step)
    return 100.0 * max(0.0, float(np.max(beyond))) / abs(step)


def _last_outside(piece: Piece, band: float) -> float:
    """Time (s) from the window's start until the true speed is within `band` (rpm) of the target for good."""
    outside = np.flatnonzero(np.abs(piece.speed - piece.target) > band)
    if outside.size == 0:
        return 0.0
    # What is within the band only as the window ends has not settled; it may just be passing.
    quiet = piece.time[-1] - piece.time[outside[-1]]
    if quiet < QUIET * (piece.time[-1] - piece.time[0]):
        return float("inf")
    return float(piece.time[outside[-1] + 1] - piece.time[0])


def settling_time(piece: Piece) -> float:
    """Time (s) from a step at the window's start until the true speed stays within 2 % of the step."""
    return _last_outside(piece, SETTLED * abs(piece.target - piece.initial))


def recovery_time(piece: Piece) -> float:
    """Time (s) from a load step at the window's start until the true speed stays within 2 % of the target."""
    return _last_outside(piece, SETTLED * abs(piece.target))


def dip(piece: Piece) -> float:
    """How far the true speed falls short of the target in the window (at standstill: moves at all), rpm."""
    short = piece.target - piece.speed
    if piece.target == 0.0:
        return float(np.max(np.abs(short)))
    return max(0.0, float(np.max(short * np.sign(piece.target))))


def position_drift(piece: Piece) -> float:
    """Largest distance of the shaft from where it was when the last second began, degrees el."""
    angle = np.unwrap(as_floats(piece.last().signals["true_angle"]))
    return float(np.degrees(np.max(np.abs(angle - angle[0]))))


def position_offset(piece: Piece) -> float:
    """Distance of the shaft at the window's end from where it was at its start, degrees el."""
    angle = np.unwrap(as_floats(piece.signals["true_angle"]))
    return float(np.degrees(abs(angle[-1] - angle[0])))


def tracking_error_rms(piece: Piece) -> float:
    """Root mean square of commanded minus true speed over the window, rpm."""
    return float(np.sqrt(np.mean(np.square(piece.command - piece.speed))))


def tracking_error_peak(piece: Piece) -> float:
    """Largest magnitude of commanded minus true speed in the window, rpm."""
    return float(np.max(np.abs(piece.command - piece.speed)))


def current_vector(signals: Signals) -> tuple[Floats, Floats]:
    """True stator current in the stationary frame, amplitude invariant: i_α, i_β (A)."""
    a, b, c = (as_floats(signals[name]) for name in ("i_a", "i_b", "i_c"))
    return (2.0 * a - b - c) / 3.0, (b - c) / np.sqrt(3.0)


def radius_deviation(piece: Piece) -> float:
    """Rms deviation of the current vector's length from its mean over the last second, percent of the mean."""
    radius = np.hypot(*current_vector(piece.last().signals))
    mean = float(np.mean(radius))
    return 100.0 * float(np.std(radius)) / mean if mean > 0.0 else float("inf")


def current_peak(piece: Piece) -> float:
    """Largest true phase current in the window, A."""
    return max(float(np.max(np.abs(piece.signals[name]))) for name in ("i_a", "i_b", "i_c"))


def link_peak(piece: Piece) -> float:
    """Highest true voltage of the DC link in the window, V."""
    return float(np.max(piece.signals["v_dc"]))


def hold_position_error_peak(piece: Piece) -> float:
    """Largest position error while the speed reference is held, degrees el."""
    holds = speed_profile.holds(piece.signals, position_error(piece.signals))
    return max((hold.peak for hold in holds), default=float("inf"))


def hold_bound_ratio(piece: Piece) -> float:
    """Rms position error while the speed reference is held over the Cramér-Rao bound of its windows."""
    least = bound.angle_bound(piece.signals, bound.Expected.of(piece.extras.machine, piece.extras.observer))
    held = speed_profile.holds(piece.signals, position_error(piece.signals))
    possible = speed_profile.holds(piece.signals, least)
    return max((hold.rms / best.rms for hold, best in zip(held, possible, strict=True)), default=float("inf"))


def thd(piece: Piece) -> float:
    """All of the phase current up to 50 kHz but its fundamental and DC, rms in percent of the fundamental."""
    return 100.0 * waveforms.spectrum(_looked(piece, "raster")).distortion


def ripple_rms(piece: Piece) -> float:
    """Rms of the phase currents above 1 kHz, mean of the phases, A."""
    return ripple.rms(_looked(piece, "raster"), ripple.LOWEST, ripple.HIGHEST)


def ripple_peak_to_peak(piece: Piece) -> float:
    """Largest peak-to-peak of a phase current within one PWM period, A."""
    return ripple.peak_to_peak(_looked(piece, "raster"))


def ripple_subharmonic(piece: Piece) -> float:
    """Rms of the phase currents from 1 kHz to below the switching frequency (9.5 kHz), A."""
    return ripple.rms(_looked(piece, "raster"), ripple.LOWEST, ripple.SUBHARMONIC)


def ripple_audible(piece: Piece) -> float:
    """Rms of the phase currents from 1 kHz to 16 kHz, A."""
    return ripple.rms(_looked(piece, "raster"), ripple.LOWEST, ripple.AUDIBLE)


def ripple_torque(piece: Piece) -> float:
    """Rms of the torque above 1 kHz, from the true currents and angle, N m."""
    return ripple.torque(_looked(piece, "raster"), piece.extras.machine)


def ripple_copper_loss(piece: Piece) -> float:
    """Loss of the ripple in the DC resistance of the three phases and their devices, W; no skin effect, no iron."""
    return 3.0 * float(piece.extras.machine["resistance"]) * ripple_rms(piece) ** 2


def switching_frequency(piece: Piece) -> float:
    """Mean over the legs of how often the upper gate is switched on, seen at the pins, kHz."""
    time = _looked(piece, "raster")["time"]
    return waveforms.switching_frequency(_looked(piece, "edges"), float(time[-1] - time[0])) * 1e-3


def pattern_voltage_error(piece: Piece) -> float:
    """Largest departure of a period's mean phase voltage at the gates from what was asked, ticks of 10 ns."""
    _looked(piece, "edges")
    return float(np.max(np.abs(waveforms.voltage_errors(piece.extras.waveform, piece.signals))))


def pattern_mismatch(piece: Piece) -> float:
    """Share of the periods with two short vectors that do not extend and compensate both, percent."""
    _looked(piece, "edges")
    found = [waveforms.is_extended(pattern) for pattern in waveforms.patterns(piece.extras.waveform)]
    judged = [good for good in found if good is not None]
    return 100.0 * judged.count(False) / len(judged) if judged else float("inf")


def _looked(piece: Piece, table: str) -> Signals:
    """A table of the waveform."""
    found = piece.extras.waveform.get(table, {})
    if not found or found["time"].size < 2:
        raise ValueError("the run was not looked into here")
    return found


def sweep(piece: Piece) -> deviation_sweep.Sweep:
    """The q-axis deviation over the angle error."""
    return deviation_sweep.sweep(position_error(piece.signals), piece.signals, piece.extras.machine)


def deviation_gain_error(piece: Piece) -> float:
    """Fitted gain of the q-axis current deviation against the one derived from the true machine, percent."""
    return 100.0 * abs(sweep(piece).gain - 1.0)


def deviation_distortion(piece: Piece) -> float:
    """What of the q-axis current deviation is no sine of twice the angle error, rms in percent of the sine's rms."""
    found = sweep(piece)
    rest = float(np.mean(np.square(found.deviation - found.sine)))
    return 100.0 * float(np.sqrt(rest / np.mean(np.square(found.sine))))


def deviation_wrong_polarity(piece: Piece) -> float:
    """Share of the angle errors at which deviation over Kq has not the sign of the error, percent."""
    found = sweep(piece)
    current = float(np.mean(piece.signals["i_d_ref"]))
    kq = deviation_sweep.gain(current, piece.extras.machine)
    clear = (np.abs(found.error) > 10.0) & (np.abs(found.error) < 80.0)  # between them the sine is no smaller than 0.34
    return 100.0 * float(np.mean(found.deviation[clear] / kq * found.error[clear] < 0.0))


FUNCTIONS: dict[str, Callable[[Piece], float]] = {
    function.__name__: function
    for function in (
        position_error_peak,
        position_error_rms,
        speed_ripple,
        speed_error,
        mean_speed_error,
        speed_error_share,
        overshoot,
        settling_time,
        recovery_time,
        dip,
        position_drift,
        position_offset,
        tracking_error_rms,
        tracking_error_peak,
        radius_deviation,
        current_peak,
        link_peak,
        hold_position_error_peak,
        hold_bound_ratio,
        thd,
        ripple_rms,
        ripple_peak_to_peak,
        ripple_subharmonic,
        ripple_audible,
        ripple_copper_loss,
        ripple_torque,
        switching_frequency,
        pattern_voltage_error,
        pattern_mismatch,
        deviation_gain_error,
        deviation_distortion,
        deviation_wrong_polarity,
        *flux_metrics.FUNCTIONS,
    )
}
"""What each kind of figure is (cases/vocabulary.py): of a piece of a run a number in its unit."""
