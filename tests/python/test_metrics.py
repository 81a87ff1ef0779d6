"""Figures of merit on signals whose figures are known in closed form.

Where a tolerance is not zero it is the sampling: a peak between two samples 0.1 ms apart is missed by at most the
signal's change in that time, and a time is known to one sample.
"""

import numpy as np
import pytest

from stillspin.cases import vocabulary
from stillspin.cases.scenario import Reached, Run
from stillspin.measure import metrics, pieces

SAMPLE = 1e-4
DURATION = 3.0


def a_run(*commands, duration=DURATION):
    """A run with speed commands (s, rpm)."""
    given = tuple((at, "speed_ref_rpm", value) for at, value in commands)
    return Run("only", "", duration, 1.0, given, (), {}, {}, (Reached((0.0, 1.0), 1.0),))


def piece(window=(0.0, DURATION), commands=((0.0, 600.0),), **signals):
    """The window of a run of 3 s with these signals; functions get the time, numbers are constant."""
    time = np.arange(-0.1, DURATION + SAMPLE / 2, SAMPLE)
    data = {"time": time}
    for name, value in signals.items():
        data[name] = value(time) if callable(value) else np.full(time.shape, float(value))
    return pieces.cut(data, a_run(*commands), window)


def angles(true, used):
    """A piece with these two angles (functions of time or numbers, in degrees)."""

    def radians(value):
        return (lambda time: np.radians(value(time))) if callable(value) else np.radians(value)

    return piece(true_angle=radians(true), est_angle=radians(used))


@pytest.mark.parametrize(
    ("true", "used", "error"),
    [
        (10, 8, 2),
        (8, 10, -2),
        (179, -179, -2),
        (-179, 179, 2),
        (1, 359, 2),
        (720 + 1, -1, 2),
        (90, 271, 179),
        (0, 0, 0),
    ],
)
def test_position_error_takes_the_short_way_round(true, used, error):
    signals = {"true_angle": np.radians([float(true)]), "est_angle": np.radians([float(used)])}
    assert metrics.position_error(signals)[0] == pytest.approx(error, abs=1e-9)


def test_position_error_stays_small_while_both_angles_wrap_at_different_instants():
    def true(time):
        return (7200.0 * time + 180.0) % 360.0 - 180.0

    def used(time):
        return (7200.0 * time - 1.5) % 360.0

    assert metrics.position_error_peak(angles(true, used)) == pytest.approx(1.5, abs=1e-6)


def test_peak_looks_at_the_whole_window_and_rms_at_its_last_second():
    def error(time):
        return np.where(time < 1.0, 10.0, 2.0 * np.sin(2.0 * np.pi * 5.0 * time))

    early = angles(error, 0)
    assert metrics.position_error_peak(early) == pytest.approx(10.0)
    assert metrics.position_error_rms(early) == pytest.approx(np.sqrt(2.0), rel=1e-3)


def test_rms_counts_a_constant_error():
    assert metrics.position_error_rms(angles(3, 0)) == pytest.approx(3.0)


def test_a_window_shorter_than_a_second_is_taken_whole():
    short = piece(window=(0.5, 0.75), true_angle=lambda t: np.where(t < 0.6, 0.1, 0.0), est_angle=0)
    assert metrics.position_error_rms(short) == pytest.approx(np.degrees(0.1) * np.sqrt(0.4), rel=1e-3)


def test_speed_ripple_is_half_the_peak_to_peak_of_the_last_second():
    def speed(time):
        return np.where(time < 1.9, 50.0, 5.0 + 0.7 * np.cos(2.0 * np.pi * 10.0 * time))

    assert metrics.speed_ripple(piece(true_speed=speed)) == pytest.approx(0.7, rel=1e-4)


def test_speed_error_is_that_of_the_mean():
    def speed(time):
        return 597.0 + 20.0 * np.sin(2.0 * np.pi * 10.0 * time)

    assert metrics.speed_error(piece(true_speed=speed)) == pytest.approx(3.0, abs=0.01)
    assert metrics.speed_error_share(piece(true_speed=speed)) == pytest.approx(0.5, abs=0.002)


def second_order(damping, step, frequency=30.0):
    """Response of a second-order system from t = 0.5 s on, from 100 rpm."""
    root = np.sqrt(1.0 - damping**2)

    def speed(time):
        x = frequency * np.maximum(time - 0.5, 0.0)
        decay = np.exp(-damping * x)
        return 100.0 + step * (1.0 - decay * (np.cos(root * x) + damping / root * np.sin(root * x)))

    return speed


@pytest.mark.parametrize("step", [500.0, -700.0])
def test_overshoot_of_a_second_order_system(step):
    damping = 0.5
    stepped = piece((0.5, 3.0), ((0.0, 100.0), (0.5, 100.0 + step)), true_speed=second_order(damping, step))
    exact = 100.0 * np.exp(-np.pi * damping / np.sqrt(1.0 - damping**2))
    # The maximum is flat: between two samples it changes by (30 rad/s · 0.05 ms)²/2, a millionth.
    assert metrics.overshoot(stepped) == pytest.approx(exact, rel=1e-4)


def test_no_overshoot_is_zero_and_not_negative():
    def speed(time):
        return 600.0 * (1.0 - np.exp(-np.maximum(time, 0.0) / 0.1))

    assert metrics.overshoot(piece(true_speed=speed)) == 0.0


@pytest.mark.parametrize("target", [600.0, -600.0])
def test_settling_time_of_a_first_order_lag(target):
    def speed(time):
        return target * (1.0 - np.exp(-np.maximum(time - 0.5, 0.0) / 0.1))

    settled = metrics.settling_time(piece((0.5, 3.0), ((0.5, target),), true_speed=speed))
    assert settled == pytest.approx(0.1 * np.log(50.0), abs=1.1 * SAMPLE)


def test_settling_counts_the_last_departure():
    def speed(time):
        return np.where((time > 1.0) & (time < 1.2), 650.0, 600.0)

    assert metrics.settling_time(piece((0.5, 3.0), ((0.5, 600.0),), true_speed=speed)) == pytest.approx(0.7, abs=2e-4)


def test_what_never_settles_has_no_settling_time():
    """Not even when it happens to be within the band as the window ends."""
    for phase in (0.0, 0.5 * np.pi):
        wobble = piece(
            (0.5, 3.0),
            ((0.5, 600.0),),
            true_speed=lambda t, phase=phase: 600.0 + 20.0 * np.sin(40.0 * (t - 3.0) + phase),
        )
        assert metrics.settling_time(wobble) == np.inf


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_dip_and_recovery_of_a_load_step(sign):
    def speed(time):
        return sign * (600.0 - 60.0 * np.exp(-np.maximum(time - 1.0, 0.0) / 0.1) * (time >= 1.0))

    loaded = piece((1.0, 3.0), ((0.0, sign * 600.0),), true_speed=speed)
    assert metrics.dip(loaded) == pytest.approx(60.0)
    assert metrics.recovery_time(loaded) == pytest.approx(0.1 * np.log(60.0 / 12.0), abs=1.1 * SAMPLE)


def test_running_ahead_is_no_dip():
    assert metrics.dip(piece(true_speed=610.0)) == 0.0


def test_at_standstill_every_motion_is_a_dip():
    assert metrics.dip(piece(commands=((0.0, 0.0),), true_speed=lambda t: 3.0 * np.sin(t))) == pytest.approx(
        3.0, abs=0.01
    )


def test_drift_follows_the_shaft_through_the_wrap():
    def angle(time):
        return np.remainder(np.radians(175.0 + 12.0 * time) + np.pi, 2.0 * np.pi) - np.pi

    creeping = piece(true_angle=angle)
    assert metrics.position_drift(creeping) == pytest.approx(12.0, abs=12.0 * 2.0 * SAMPLE)
    assert metrics.position_offset(creeping) == pytest.approx(36.0, abs=12.0 * 2.0 * SAMPLE)


def test_tracking_error_is_against_the_command_as_it_was_given():
    commands = tuple((round(0.01 * step, 6), float(step)) for step in range(300))
    tracked = piece((0.5, 2.5), commands, true_speed=lambda t: 100.0 * np.floor(t * 100.0 + 1e-6) / 100.0 - 4.0)
    assert metrics.tracking_error_rms(tracked) == pytest.approx(4.0)
    assert metrics.tracking_error_peak(tracked) == pytest.approx(4.0)


def currents(radius):
    """Phase currents of a vector with this length (a function of the time) turning at 4 Hz."""
    return {
        name: lambda t, shift=shift: radius(t) * np.cos(8.0 * np.pi * t - shift * 2.0 * np.pi / 3.0)
        for shift, name in enumerate(("i_a", "i_b", "i_c"))
    }


def test_a_circle_has_no_radius_deviation():
    assert metrics.radius_deviation(piece(**currents(lambda t: 3.0 + 0.0 * t))) == pytest.approx(0.0, abs=1e-9)


def test_radius_deviation_is_the_rms_in_percent_of_the_mean():
    rippled = piece(**currents(lambda t: 4.0 + 0.4 * np.sin(2.0 * np.pi * 50.0 * t)))
    assert metrics.radius_deviation(rippled) == pytest.approx(10.0 / np.sqrt(2.0), rel=1e-3)


def test_current_peak_is_the_largest_of_the_three_phases():
    signals = currents(lambda t: 3.0 + 0.0 * t)
    signals["i_b"] = lambda t: np.where(np.abs(t - 1.0) < 1e-3, -9.0, 0.0)
    assert metrics.current_peak(piece(**signals)) == 9.0


def test_a_window_beyond_the_record_is_an_error():
    time = np.arange(0.0, 1.0, SAMPLE)
    signals = {"time": time, "true_speed": np.zeros(time.shape)}
    with pytest.raises(ValueError, match="does not cover"):
        pieces.cut(signals, a_run((0.0, 1.0)), (0.5, 1.1))


def test_a_command_at_the_very_end_of_a_window_belongs_to_what_follows():
    held = piece((0.5, 1.5), ((0.2, 100.0), (1.5, 0.0)), true_speed=100.0)
    assert held.target == 100.0
    assert np.all(held.command == 100.0)


def test_a_step_on_the_windows_corner_starts_from_the_command_before_it():
    stepped = piece((0.5, 1.0), ((0.2, 100.0), (0.5, 400.0), (1.5, 0.0)), true_speed=0)
    assert (stepped.initial, stepped.target) == (100.0, 400.0)


def test_every_kind_of_figure_has_a_unit_and_says_what_it_is():
    assert metrics.FUNCTIONS.keys() == vocabulary.KINDS.keys()
    for name, function in metrics.FUNCTIONS.items():
        assert vocabulary.KINDS[name].unit
        assert (function.__doc__ or "").splitlines()[0].endswith(".")
