"""What a scenario file can ask for: kinds of figures with their units, and panels of a drawing.

What a figure is in truth says measure/metrics.py, how a panel looks report/panels.py.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Kind:
    """A kind of figure. `of_lost`: says something of a run that was lost, up to the last change of its reference."""

    unit: str
    of_lost: bool = False


KINDS: dict[str, Kind] = {
    "position_error_peak": Kind("deg el"),
    "position_error_rms": Kind("deg el"),
    "speed_ripple": Kind("rpm"),
    "speed_error": Kind("rpm"),
    "mean_speed_error": Kind("rpm"),
    "speed_error_share": Kind("%"),
    "overshoot": Kind("%"),
    "settling_time": Kind("s"),
    "recovery_time": Kind("s"),
    "dip": Kind("rpm"),
    "position_drift": Kind("deg el"),
    "position_offset": Kind("deg el"),
    "tracking_error_rms": Kind("rpm"),
    "tracking_error_peak": Kind("rpm"),
    "radius_deviation": Kind("%"),
    "current_peak": Kind("A"),
    "link_peak": Kind("V"),
    "hold_position_error_peak": Kind("deg el"),
    "hold_bound_ratio": Kind("× bound"),
    "thd": Kind("%"),
    "ripple_rms": Kind("A"),
    "ripple_peak_to_peak": Kind("A"),
    "ripple_subharmonic": Kind("A"),
    "ripple_audible": Kind("A"),
    "ripple_copper_loss": Kind("W"),
    "ripple_torque": Kind("N m"),
    "switching_frequency": Kind("kHz"),
    "pattern_voltage_error": Kind("ticks"),
    "pattern_mismatch": Kind("%"),
    "deviation_gain_error": Kind("%"),
    "deviation_distortion": Kind("%"),
    "deviation_wrong_polarity": Kind("%"),
    "load_angle_error_peak": Kind("deg el"),
    "beside_position_error_peak": Kind("deg el"),
    "current_d_error_peak": Kind("A"),
    "current_q_error_peak": Kind("A"),
    "beside_current_d_error_peak": Kind("A"),
    "beside_current_q_error_peak": Kind("A"),
    "lowest_stable_speed": Kind("rpm", of_lost=True),
    "stable_position_error_peak": Kind("deg el", of_lost=True),
    "magnet_detection_error": Kind("%"),
    "flux_limit_share": Kind("%"),
}
"""Every kind of figure; besides these there is the ratio of two other figures."""

PANELS = (
    "speed",
    "tracking",
    "position_error",
    "angle",
    "travel",
    "beside_error",
    "load_angle",
    "load_angle_error",
    "magnet_flux",
    "torque",
    "currents",
    "phases",
    "weight",
    "link",
    "trajectory",
    "deviation_sweep",
    "spectrum",
    "ripple",
    "gates",
    "error_over_speed",
    "flux_limit",
    "load_angles",
    "error_map",
)
"""Every panel."""
