"""The panels a plot can be stacked from: which signals each shows, in which unit and under which words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stillspin.cases.scenario import Run
from stillspin.core import Signals
from stillspin.measure import metrics, pieces
from stillspin.measure.pieces import Floats

Compute = Callable[[Signals, Run], Floats]


@dataclass(frozen=True)
class Line:
    """One line: its word in the legend, how it is computed, and the role that gives it its colour."""

    label: str
    compute: Compute
    role: str


@dataclass(frozen=True)
class Panel:
    """One set of axes over time. `wraps`: lines jump at ±180° and are not joined across the jump.

    When several runs share a panel only the first line is drawn, one colour per run, and a common reference once.
    """

    label: str
    lines: tuple[Line, ...]
    wraps: bool = False
    symmetric: bool = False


def _signal(name: str, scale: float = 1.0) -> Compute:
    return lambda signals, run: scale * pieces.as_floats(signals[name])


def _command(signals: Signals, run: Run) -> Floats:
    return run.speed_command(pieces.as_floats(signals["time"]))


def _error(signals: Signals, run: Run) -> Floats:
    return metrics.position_error(signals)


def _wrapped(name: str) -> Compute:
    return lambda signals, run: pieces.wrap_degrees(pieces.as_floats(signals[name]))


def _travel(name: str) -> Compute:
    """Angle in degrees, unwrapped, counted from the first true angle shown: for a shaft that should stand still."""

    def compute(signals: Signals, run: Run) -> Floats:
        start = pieces.as_floats(signals["true_angle"])[:1]
        angle = pieces.as_floats(signals[name])
        first = start + np.remainder(angle[:1] - start + np.pi, 2.0 * np.pi) - np.pi
        unwrapped: Floats = np.degrees(np.unwrap(angle) - angle[:1] + first - start)
        return unwrapped

    return compute


def _deviation(signals: Signals, run: Run) -> Floats:
    return pieces.as_floats(signals["true_speed"]) - _command(signals, run)


def _beside_error(signals: Signals, run: Run) -> Floats:
    return pieces.wrap_degrees(pieces.as_floats(signals["true_angle"]) - pieces.as_floats(signals["angle_avv"]))


def _load_angle_error(signals: Signals, run: Run) -> Floats:
    return pieces.wrap_degrees(pieces.as_floats(signals["true_load_angle"]) - pieces.as_floats(signals["load_angle"]))


PANELS: dict[str, Panel] = {
    "speed": Panel(
        "speed (rpm)",
        (
            Line("true", _signal("true_speed"), "true"),
            Line("estimated", _signal("est_speed"), "estimate"),
            Line("reference", _signal("speed_ref"), "reference"),
        ),
    ),
    "tracking": Panel("tracking error (rpm)", (Line("error", _deviation, "true"),), symmetric=True),
    "position_error": Panel("position error (° el)", (Line("true − used", _error, "error"),), symmetric=True),
    "angle": Panel(
        "angle (° el)",
        (Line("true", _wrapped("true_angle"), "true"), Line("used", _wrapped("est_angle"), "estimate")),
        wraps=True,
    ),
    "travel": Panel(
        "shaft travel (° el)",
        (Line("true", _travel("true_angle"), "true"), Line("used", _travel("est_angle"), "estimate")),
    ),
    "beside_error": Panel("error, beside (° el)", (Line("true − beside", _beside_error, "error"),), symmetric=True),
    "load_angle": Panel(
        "load angle (° el)",
        (Line("true", _wrapped("true_load_angle"), "true"), Line("estimated", _wrapped("load_angle"), "estimate")),
    ),
    "load_angle_error": Panel(
        "load-angle error (° el)", (Line("true − estimated", _load_angle_error, "error"),), symmetric=True
    ),
    "magnet_flux": Panel("magnet flux (mVs)", (Line("learnt", _signal("magnet_flux", 1e3), "estimate"),)),
    "torque": Panel(
        "torque (N m)",
        (
            Line("motor", _signal("torque"), "true"),
            Line("load estimate", _signal("load_estimate"), "estimate"),
            Line("load", _signal("load_torque"), "reference"),
        ),
    ),
    "currents": Panel(
        "rotor-frame current (A)",
        (
            Line("$i_q$ true", _signal("true_i_q"), "q"),
            Line("$i_d$ true", _signal("true_i_d"), "d"),
            Line("$i_q$*", _signal("i_q_ref"), "setpoint"),
            Line("$i_d$*", _signal("i_d_ref"), "setpoint"),
        ),
    ),
    "phases": Panel(
        "phase current (A)",
        (
            Line("$i_a$", _signal("i_a"), "a"),
            Line("$i_b$", _signal("i_b"), "b"),
            Line("$i_c$", _signal("i_c"), "c"),
        ),
    ),
    "weight": Panel("low-speed share", (Line("weight", _signal("weight"), "true"),)),
    "link": Panel("DC link (V)", (Line("measured", _signal("v_dc"), "true"),)),
    "trajectory": Panel("$i_β$ (A)", ()),
    "deviation_sweep": Panel("q-axis current deviation (A/s)", ()),
    "spectrum": Panel("% of the fundamental", ()),
    "ripple": Panel("A rms", ()),
    "gates": Panel("gates", ()),
    "error_over_speed": Panel("position error (° el)", ()),
    "flux_limit": Panel("stator flux (Vs)", ()),
    "load_angles": Panel("load angle (° el)", ()),
    "error_map": Panel("position error (° el)", ()),
}
"""Every panel. Those without lines fill a drawing of their own, see special_plots.py."""
