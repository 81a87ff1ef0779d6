"""Evaluation of a scenario: the worst of runs and windows, ratios, goals per profile, the check of the true shaft."""

import numpy as np
import pytest

from stillspin.cases.scenario import Figure, Goal, Reached, Run, Scenario
from stillspin.measure import figures

TIME = np.arange(-0.05, 2.0005, 1e-3)


def a_run(name, reached=()):
    return Run(name, "", 2.0, 1.0, ((0.0, "speed_ref_rpm", 100.0),), (), {}, {}, reached)


def a_scenario(*wanted):
    return Scenario("T1", "", "A", "", "", "", (a_run("one"), a_run("two")), wanted, ())


def a_figure(name="ripple", runs=("one",), windows=((0.0, 1.0),), goal=None, **more):
    return Figure(name, more.pop("kind", "speed_ripple"), "rpm", runs, windows, None, goal or Goal(), **more)


def signals(amplitude):
    return {"time": TIME, "true_speed": 100.0 + np.where(TIME < 1.0, 1.0, 2.0) * amplitude * np.sin(60.0 * TIME)}


RECORDED = {"one": signals(1.0), "two": signals(3.0)}


def value_of(figure, recorded=RECORDED, profile="bench"):
    return figures.evaluate(a_scenario(figure), recorded, profile)[0]


def test_the_largest_of_runs_and_windows_counts():
    both = a_figure(runs=("one", "two"), windows=((0.0, 0.9), (1.0, 2.0)))
    assert value_of(a_figure()).value == pytest.approx(1.0, abs=0.01)
    assert value_of(both).value == pytest.approx(6.0, abs=0.01)


def test_a_goal_is_met_when_it_is_just_reached():
    value = value_of(a_figure()).value
    assert value_of(a_figure(goal=Goal(value))).met is True
    assert value_of(a_figure(goal=Goal(value * 0.999))).met is False


def test_goals_go_by_profile_and_the_default_holds_elsewhere():
    goal = Goal(2.0, {"ideal": 0.5})
    assert [value_of(a_figure(goal=goal), profile=name).goal for name in ("bench", "mine", "ideal")] == [2.0, 2.0, 0.5]
    assert value_of(a_figure(goal=goal), profile="ideal").met is False


def test_without_a_goal_nothing_is_met_or_missed():
    assert value_of(a_figure()).met is None


def test_a_run_that_does_not_count_leaves_no_value_and_misses_the_goal():
    result = value_of(a_figure(runs=("one", "two"), goal=Goal(100.0)), {"one": RECORDED["one"]})
    assert (result.value, result.met) == (None, False)
    assert "two" in result.note


def test_what_is_not_within_the_window_has_no_value():
    result = value_of(a_figure(kind="settling_time", windows=((0.0, 2.0),), goal=Goal(1.0)), {"one": signals(50.0)})
    assert (result.value, result.met, result.note) == (None, False, "not within the window")


def test_a_ratio_is_taken_of_two_figures():
    wanted = (
        a_figure("a", ("one",)),
        a_figure("b", ("two",)),
        a_figure("r", (), (), Goal(1.0), kind="ratio", of=("a", "b")),
    )
    ratio = figures.evaluate(a_scenario(*wanted), RECORDED, "bench")[2]
    assert ratio.value == pytest.approx(1.0 / 3.0, rel=1e-3)
    assert ratio.met is True


def test_a_ratio_without_one_of_its_figures_has_no_value():
    wanted = (a_figure("a", ("one",)), a_figure("b", ("two",)), a_figure("r", (), (), kind="ratio", of=("a", "b")))
    assert figures.evaluate(a_scenario(*wanted), {"one": RECORDED["one"]}, "bench")[2].value is None


def shaft(turning, **check):
    """What is said about a shaft that turns at this speed (function of time) when it should be at 100 rpm ± 5."""
    run = a_run("one", (Reached(check.pop("window", (1.0, 2.0)), 5.0, **check),))
    return figures.shaft_problem({"time": TIME, "true_speed": turning(TIME)}, run)


def test_a_shaft_that_follows_is_fine():
    assert shaft(lambda t: np.where(t < 0.9, 0.0, 104.0)) is None


@pytest.mark.parametrize("speed", [94.0, 106.0, -100.0, 0.0, np.nan])
def test_a_shaft_that_does_something_else_is_not(speed):
    problem = shaft(lambda t: np.where(t > 1.5, speed, 100.0))
    assert problem is not None
    assert "100.0 ± 5 rpm" in problem


def test_a_shaft_can_be_held_against_a_speed_of_its_own():
    assert shaft(lambda t: 0.0 * t, speed=0.0) is None


def test_a_record_that_ends_early_did_not_reach_anything():
    run = a_run("one", (Reached((1.0, 2.0), 5.0),))
    early = TIME < 1.4
    assert "does not cover" in figures.shaft_problem({"time": TIME[early], "true_speed": 100.0 + TIME[early]}, run)
