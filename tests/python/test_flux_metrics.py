"""Figures of the stator-flux sources, on records whose values are known."""

from dataclasses import replace

import numpy as np
import pytest

from stillspin.cases.scenario import Figure, Goal, Run, Scenario
from stillspin.measure import figures, flux_metrics
from stillspin.measure.pieces import Extras, Piece

TIME = np.arange(0.0, 4.0, 0.001)
MACHINE = {
    "magnet_flux": 0.07785,
    "nameplate_magnet_flux": 0.0865,
    "nameplate_inductance_d": 0.76e-3,
    "nameplate_inductance_q": 1.63e-3,
}


def a_piece(**signals):
    full = {name: np.broadcast_to(np.asarray(value, dtype=float), TIME.shape) for name, value in signals.items()}
    return Piece({"time": TIME, **full}, np.zeros(TIME.size), 0.0, 0.0, Extras(machine=MACHINE))


def test_angles_are_compared_the_short_way_round():
    piece = a_piece(true_load_angle=3.1, load_angle=-3.1, true_angle=-3.1, angle_avv=3.1)
    around = np.degrees(2.0 * np.pi - 6.2)
    assert flux_metrics.load_angle_error_peak(piece) == pytest.approx(around)
    assert flux_metrics.beside_position_error_peak(piece) == pytest.approx(around)


def test_the_currents_fed_back_are_those_of_the_angle():
    error = np.radians(10.0)
    piece = a_piece(true_angle=error, est_angle=0.0, angle_avv=error, true_i_d=-2.0, true_i_q=15.0)
    turned = (-2.0 + 15.0j) * np.exp(1j * error)  # the same vector, seen in the frame in use
    assert flux_metrics.current_d_error_peak(piece) == pytest.approx(abs(turned.real + 2.0))
    assert flux_metrics.current_q_error_peak(piece) == pytest.approx(abs(turned.imag - 15.0))
    assert flux_metrics.beside_current_d_error_peak(piece) == 0.0
    assert flux_metrics.beside_current_q_error_peak(piece) == 0.0


def steps(error_at_50=0.0, speed_at_50=50.0):
    """100, 50 and 30 rpm, a second each and more."""
    reference = np.select([TIME < 1.3, TIME < 2.6], [100.0, 50.0], 30.0)
    at_50 = reference == 50.0
    return a_piece(
        speed_ref=reference,
        true_speed=np.where(at_50, speed_at_50, reference),
        true_angle=np.where(at_50, error_at_50, 0.0),
        est_angle=0.0,
    )


def test_the_lowest_stable_speed_is_above_the_first_that_fails():
    assert flux_metrics.lowest_stable_speed(steps()) == 30.0
    assert flux_metrics.lowest_stable_speed(steps(error_at_50=1.0)) == 100.0
    assert flux_metrics.lowest_stable_speed(steps(speed_at_50=40.0)) == 100.0


def a_scenario(figure):
    run = Run("one", "", 4.0, 3.0, (), (), {}, {}, (), may_be_lost=True)
    return Scenario("X", "", "B", "", "", "", (run,), (figure,), ())


def test_a_lost_run_tells_how_far_it_got_and_nothing_else():
    lost = dict(steps().signals)
    end = TIME < 3.9  # almost all of 30 rpm
    lost = {name: data[end] for name, data in lost.items()}
    figure = Figure("lowest_stable_speed", "lowest_stable_speed", "rpm", ("one",), ((0.0, 4.0),), None, Goal(60.0))
    result = figures.evaluate(a_scenario(figure), {}, "bench", {}, {"one": lost})[0]
    assert (result.value, result.met) == (50.0, True)
    other = replace(figure, name="position_error_peak", kind="position_error_peak")
    assert figures.evaluate(a_scenario(other), {}, "bench", {}, {"one": lost})[0].value is None


def test_the_magnet_flux_is_measured_by_the_nameplate():
    assert flux_metrics.magnet_detection_error(a_piece(magnet_flux=0.07785 + 0.000865)) == pytest.approx(1.0)


def test_the_limit_of_the_root_is_above_any_flux_without_field_weakening():
    current = np.linspace(0.0, 25.0, TIME.size)
    piece = a_piece(i_d_ref=0.0, i_q_ref=current)
    _, flux, limit = flux_metrics.limit_flux(piece)
    # Where (27) has no root its argument is negative: at the limit it is zero.
    ld, lq, psi = 0.76e-3, 1.63e-3, 0.0865
    argument = (lq**2 - ld**2) * lq**2 * current**2 - (lq**2 - ld**2) * limit**2 + lq**2 * psi**2
    assert np.max(np.abs(argument)) < 1e-18
    assert flux_metrics.flux_limit_share(piece) == pytest.approx(100.0 * np.max(flux / limit))
    assert flux_metrics.flux_limit_share(piece) < 100.0
