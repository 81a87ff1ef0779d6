"""Plots keep every peak of a long record, survive records that are cut short, and are the same every time."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure

from stillspin.cases import scenario_file, vocabulary
from stillspin.cases.scenario import Plot
from stillspin.report import panels, plots
from stillspin.report.special_plots import SPECIAL
from stillspin.report.style import PANEL_HEIGHT, STYLE


def recorded(duration=1.0, first=-0.05):
    time = np.arange(first, duration, 1e-3)
    names = (
        "true_angle",
        "est_angle",
        "true_speed",
        "est_speed",
        "speed_ref",
        "torque",
        "load_torque",
        "load_estimate",
    )
    names += ("angle_avv", "true_load_angle", "load_angle", "magnet_flux")
    names += ("true_i_d", "true_i_q", "i_d_ref", "i_q_ref", "i_a", "i_b", "i_c", "weight", "v_dc", "deviation_q")
    return {"time": time, **{name: np.sin(20.0 * time + number) for number, name in enumerate(names)}}


def test_thinning_keeps_the_extremes_and_their_order():
    time = np.arange(100_000) * 1e-4
    values = np.random.default_rng(1).normal(size=time.size)
    values[41_234], values[41_237] = 50.0, -60.0
    thin_time, thin = plots.thinned(time, values, columns=500)
    assert thin.size <= 1000
    assert (thin.max(), thin.min()) == (50.0, -60.0)
    assert np.all(np.diff(thin_time) > 0.0)
    assert thin_time[thin.argmax()] == time[41_234]


def test_thinning_keeps_gaps():
    values = np.zeros(10_000)
    values[5_000] = np.nan
    assert np.isnan(plots.thinned(np.arange(10_000.0), values, columns=100)[1]).sum() == 1


def test_short_lines_are_left_alone():
    time = np.arange(10.0)
    assert plots.thinned(time, time)[0] is time


def test_travel_starts_near_the_true_angle_and_unwraps():
    line_true, line_used = panels.PANELS["travel"].lines
    turns = np.linspace(3.0, 20.0, 500)
    wrapped = np.remainder(turns + np.pi, 2 * np.pi) - np.pi
    signals = {"time": turns, "true_angle": wrapped, "est_angle": np.remainder(turns + 0.1, 2 * np.pi)}
    run = scenario_file.load("A10").runs[0]
    assert line_true.compute(signals, run) == pytest.approx(np.degrees(turns - 3.0))
    assert line_used.compute(signals, run) == pytest.approx(np.degrees(turns - 2.9))


def test_every_panel_that_a_file_may_name_can_be_drawn():
    assert tuple(panels.PANELS) == vocabulary.PANELS


@pytest.mark.parametrize("panel", panels.PANELS)
@pytest.mark.parametrize("runs", [("predictive",), ("predictive", "pi")])
def test_every_panel_draws_one_run_and_several(panel, runs):
    plot = Plot("", (panel,), runs, None)
    svg = plots.draw(plot, scenario_file.load("A18a"), {name: recorded() for name in runs})
    assert svg.startswith("<?xml")
    assert svg == plots.draw(plot, scenario_file.load("A18a"), {name: recorded() for name in runs})


@pytest.mark.parametrize("panel", [name for name in panels.PANELS if name not in SPECIAL])
def test_a_label_is_no_longer_than_its_panel_is_high(panel):
    with mpl.rc_context(STYLE):
        size = mpl.rcParams["axes.labelsize"]
        figure = Figure()
        label = figure.text(0, 0, panels.PANELS[panel].label, rotation=90, fontsize=size)
        assert label.get_window_extent().height / figure.dpi < PANEL_HEIGHT


@pytest.mark.parametrize("panel", panels.PANELS)
@pytest.mark.parametrize("records", [{}, {"pi": recorded(0.1)}, {"pi": recorded(-0.01)}])
def test_a_run_that_ended_before_the_window_is_left_out(panel, records):
    plot = Plot("", (panel,), ("predictive", "pi"), (0.5, 0.9))
    assert "</svg>" in plots.draw(plot, scenario_file.load("A18a"), records)


def test_a_map_shows_what_was_held():
    time = np.arange(0.0, 2.6, 1e-3)
    reference = np.where(time < 1.3, 100.0, 50.0)
    still = {"time": time, "speed_ref": reference, "true_speed": reference, "true_angle": 0.0 * time}
    good = {**still, "est_angle": 0.0 * time + np.radians(7.5)}
    left_behind = {**good, "true_speed": np.where(time < 1.3, 100.0, 0.0)}
    plot = Plot("", ("error_map",), ("predictive", "pi"), None)
    svg = plots.draw(plot, scenario_file.load("A18a"), {"predictive": good, "pi": left_behind})
    assert svg.count("<!-- 7.5 -->") == 3
    assert svg.count("<!-- – -->") == 1
