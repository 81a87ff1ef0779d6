"""Scenario files: those that ship say what the bench is committed to; wrong ones are refused in one line."""

import json
import tomllib

import numpy as np
import pytest

import fake_core
from stillspin import core, resources
from stillspin.cases import profile, scenario_file
from stillspin.errors import InputError
from stillspin.measure import figures
from stillspin.runs import execute, variant

# Scenario, figure, the paper's number, the goal in `bench`, the goal in `ideal`: the project's commitments. A change of
# any of them is a decision, not a slip; the same numbers stand in the book.
COMMITMENTS = [
    ("A09", "id_3_deviation_gain_error", None, 5.0, 5.0),
    ("A09", "id_8_deviation_gain_error", None, 5.0, 5.0),
    ("A12", "thd_ratio", 1.0, 1.0, 1.0),
    ("A13", "pattern_voltage_error", None, 1.0, 1.0),
    ("A10", "position_error_peak", 2.0, 0.8, 0.5),
    ("A10", "position_error_rms", None, 0.3, 0.3),
    ("A10", "speed_ripple", 1.0, 0.8, 0.5),
    ("A11", "position_error_peak", 2.0, 1.5, 1.0),
    ("A11", "position_error_rms", None, 0.6, 0.6),
    ("A11", "ramp_position_error_peak", 2.0, 3.0, 3.0),
    ("A11", "step_position_error_peak", None, 6.0, 6.0),
    ("A15", "transition_position_error_peak", 6.0, 3.0, 2.0),
    ("A15", "steady_position_error_peak", 2.0, 1.5, 1.0),
    ("A16", "position_error_peak", 4.0, 2.5, 1.5),
    ("A17", "load_1nm_position_error_peak", 2.0, 1.2, 1.2),
    ("A17", "load_4nm_position_error_peak", 3.0, 1.8, 1.8),
    ("A18a", "overshoot", 3.0, 1.0, 1.0),
    ("A18a", "pi_overshoot", 10.0, None, None),
    ("A18a", "pi_settling_time", 0.3, None, None),
    ("A18b", "dip", 60.0, 35.0, 35.0),
    ("A18b", "pi_dip", 150.0, None, None),
]

EXAMPLE = """
id = "T1"
title = "test"
motor = "A"

[defaults]
duration = 2.0
parameters = { speed_law = 0, speed_ramp = 0 }
reached = [{ window = [1.0, 2.0], band = 5.0 }]

[[runs]]
name = "one"
commands = [[0.5, "speed_ref_rpm", 100.0]]
parameters = { speed_law = 1 }

[[runs]]
name = "two"
duration = 3.0
reference = { shape = "points", points = [[0.0, 0.0], [0.2, 20.0]], interval = 0.1 }

[[figures]]
name = "speed_ripple"
window = [0.0, 2.0]

[[plots]]
panels = ["speed"]
"""


def read(tmp_path, text=EXAMPLE):
    path = tmp_path / "T1.toml"
    path.write_text(text, encoding="utf-8")
    return scenario_file.read(path)


@pytest.mark.parametrize(("scenario", "figure", "paper", "bench", "ideal"), COMMITMENTS)
def test_the_commitments_stand_in_the_files(scenario, figure, paper, bench, ideal):
    found = next(item for item in scenario_file.load(scenario).figures if item.name == figure)
    assert (found.paper, found.goal.of("bench"), found.goal.of("ideal")) == (paper, bench, ideal)


@pytest.mark.parametrize("identifier", scenario_file.ids())
def test_every_scenario_that_ships_can_be_prepared(identifier):
    scenario = scenario_file.load(identifier)
    bench = profile.Profile("bench", "", {})
    jobs = execute.prepare(scenario, execute.Settings(bench, profile.Changes(), 1, "r"), fake_core)
    assert [job.run.name for job in jobs] == [run.name for run in scenario.runs]
    json.dumps([job.about for job in jobs])


@pytest.mark.parametrize("identifier", scenario_file.ids())
def test_evaluation_begins_after_the_start_and_peaks_are_taken_over_stated_windows(identifier):
    """The start procedure and the 0.2 s after it are not evaluated."""
    for figure in scenario_file.load(identifier).figures:
        assert all(first >= 0.2 for first, _ in figure.windows)


@pytest.mark.parametrize("identifier", ["A18a", "A18b", "A18c", "A19"])
def test_no_scenario_tunes_the_controller(identifier):
    """Only what a scenario compares, and the ramp where a step is said, may differ from the drive's parameters."""
    assert {name for run in scenario_file.load(identifier).runs for name in run.parameters} <= {
        "speed_law",
        "speed_ramp",
    }


@pytest.mark.parametrize("identifier", scenario_file.ids())
@pytest.mark.parametrize("turning", [0.0, -1.0, 0.5], ids=["stalled", "reversed", "half as fast"])
def test_no_run_counts_whose_shaft_does_something_else(identifier, turning):
    for run in scenario_file.load(identifier).runs:
        time = np.arange(0.0, run.duration + 5e-4, 1e-3)
        command = run.speed_command(time)
        follows = {"time": time, "true_speed": command}
        assert figures.shaft_problem(follows, run) is None
        # At standstill the opposite of doing what was commanded is to run away.
        other = command * turning if command.any() else np.full(time.shape, 20.0)
        assert (figures.shaft_problem({"time": time, "true_speed": other}, run) is None) == (
            # At 5 rpm half the speed is still creeping forward; the speed ripple tells.
            identifier == "A10" and turning == 0.5
        )


def test_most_scenarios_touch_no_parameter_at_all():
    for identifier in ("A10", "A11", "A15", "A16", "A17"):
        assert all(not run.parameters and not run.plant for run in scenario_file.load(identifier).runs)


def test_a_scheme_is_of_the_scenarios_motor() -> None:
    """Read as the files have it: every scenario that names a scheme, for all runs or for one."""
    named = set()
    for identifier in scenario_file.ids():
        data = tomllib.loads(resources.find("scenarios", identifier).read_text(encoding="utf-8"))
        schemes = {part["scheme"] for part in (data.get("defaults", {}), *data["runs"]) if "scheme" in part}
        assert {variant.scheme(name).motor for name in schemes} <= {data["motor"]}, identifier
        named |= schemes
    assert {"paper", "paper_b"} <= named


def test_every_scenario_of_its_motor_can_be_set_up_with_the_flux_papers_scheme() -> None:
    native = core.load()
    known = core.parameters(native)
    plate = profile.load("ideal", core.plant_schema(native), known, "B").parameters
    plate = {**plate, **variant.scheme("paper_flux").checked(known)}
    runs = [run for one in map(scenario_file.load, scenario_file.campaign_ids(["B"])) for run in one.runs]
    assert {"flux_beside", "position_source"} <= set().union(*(run.parameters for run in runs))
    for run in runs:
        native.check_parameters({**plate, **{name: float(value) for name, value in run.parameters.items()}})


def test_defaults_are_joined_with_what_a_run_says(tmp_path):
    one, two = read(tmp_path).runs
    assert one.parameters == {"speed_law": 1.0, "speed_ramp": 0.0}
    assert two.parameters == {"speed_law": 0.0, "speed_ramp": 0.0}
    assert (one.duration, two.duration) == (2.0, 3.0)


def test_a_moving_reference_becomes_set_points(tmp_path):
    run = read(tmp_path).runs[1]
    assert run.commands == ((0.0, "speed_ref_rpm", 0.0), (0.1, "speed_ref_rpm", 10.0), (0.2, "speed_ref_rpm", 20.0))
    assert run.speed_command(np.array([-1.0, 0.0, 0.15, 9.0])).tolist() == [0.0, 0.0, 10.0, 20.0]


def test_a_sine_starts_at_its_zero_and_keeps_its_amplitude():
    run = scenario_file.load("A19").runs[0]
    times, speeds = np.array([command[0] for command in run.commands]), [command[2] for command in run.commands]
    assert speeds[0] == 0.0
    assert max(speeds) == pytest.approx(600.0)
    assert np.diff(times) == pytest.approx(0.001)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('id = "T1"', 'id = "T2"', "must be the file's name"),
        ('motor = "A"', 'motor = "C"', "known: A, B, B-SPM"),
        ('title = "test"', "", "'title' is missing"),
        ('title = "test"', "title = 5", "must be text"),
        ('title = "test"', 'titel = "test"', "unknown key 'titel'; did you mean 'title'"),
        ('motor = "A"', 'motor = "A"\nmotro = 1', "unknown key 'motro'; did you mean 'motor'"),
        ("duration = 2.0", "duration = 0", "duration: 0 s is out of range; 0.001"),
        ("duration = 2.0", "duration = '2'", "defaults.duration = '2': must be a number, 0.001 … ∞ s"),
        ("duration = 2.0", "duration = nan", "nan s is no number"),
        ("duration = 2.0", "", "'duration' is missing"),
        ('name = "one"', 'name = "One"', "lower case"),
        ('name = "one"', 'name = "two"', "used twice"),
        ('[[0.5, "speed_ref_rpm", 100.0]]', '[[2.5, "speed_ref_rpm", 100.0]]', "not within 0 … 2 s"),
        ('[[0.5, "speed_ref_rpm", 100.0]]', '[[0.5, "speed_ref_rpm"]]', "[a number, 0 … ∞ s, a command, a number]"),
        ('[[0.5, "speed_ref_rpm", 100.0]]', "[[0.5, 7, 8]]", "runs[0].commands[0][1] = 7: must be a command"),
        ('[[0.5, "speed_ref_rpm", 100.0]]', '[[-0.5, "start", 0]]', "commands[0][0]: -0.5 s is out of range; 0 … ∞ s"),
        ("speed_law = 1 }", "sped_law = 1 }", "runs[0].parameters: unknown key 'sped_law'; did you mean 'speed_law'"),
        ("speed_law = 1 }", "speed_law = 7 }", "speed_law: 7 is out of range; 0 … 1"),
        ("speed_law = 1 }", "speed_law = [1] }", "must be a whole number, 0 … 1 or true or false"),
        ('shape = "points"', 'shape = "square"', "shape = 'square': not a choice; known: points, sine"),
        (
            "points = [[0.0, 0.0], [0.2, 20.0]]",
            "points = [[0.0, 0.0]]",
            "must be a list of at least 2 of [a number, a number]",
        ),
        ("reached = [{ window = [1.0, 2.0], band = 5.0 }]", "", "'reached' is missing"),
        ("window = [1.0, 2.0]", "window = [1.0, 2.5]", "≤ 2"),
        ("window = [0.0, 2.0]", "window = [2.0, 0.0]", "0 ≤ from < to"),
        ("window = [0.0, 2.0]", "window = [0.0, 2.5]", "to ≤ 2"),
        ("window = [0.0, 2.0]", "", "'window' is missing"),
        ("window = [0.0, 2.0]", "window = [-1, 2.0]", "figures[0].window[0]: -1 s is out of range"),
        ('name = "speed_ripple"', 'name = "speed_riple"', "did you mean 'speed_ripple'"),
        ('name = "speed_ripple"', 'name = "r"\nkind = "ratio"', "unknown key 'window'"),
        ('name = "speed_ripple"\nwindow = [0.0, 2.0]', 'name = "r"\nkind = "ratio"', "'of' is missing"),
        (
            'name = "speed_ripple"\nwindow = [0.0, 2.0]',
            'name = "r"\nkind = "ratio"\nof = "a"',
            "of = 'a': must be the names of two figures",
        ),
        (
            "[[figures]]",
            '[[figures]]\nname = "r"\nkind = "ratio"\nof = ["speed_ripple", "b"]\n[[figures]]',
            "no figure 'speed_ripple' before it",
        ),
        ('name = "speed_ripple"', 'name = "speed_ripple"\nruns = "tow"', "did you mean 'two'"),
        (
            'name = "speed_ripple"',
            'name = "speed_ripple"\ngoal = { ideal = "x" }',
            "goal.ideal = 'x': must be a number",
        ),
        ('name = "speed_ripple"', 'name = "speed_ripple"\ngoal = "low"', "goal = 'low': must be a number"),
        ('panels = ["speed"]', 'panels = ["sped"]', "did you mean 'speed'"),
        ('panels = ["speed"]', "", "'panels' is missing"),
        ("[[figures]]", "[[figure]]", "unknown key 'figure'; did you mean 'figures'"),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(tmp_path, old, new, said):
    assert old in EXAMPLE
    with pytest.raises(InputError) as caught:
        read(tmp_path, EXAMPLE.replace(old, new))
    message = str(caught.value)
    assert said in message
    assert "T1.toml" in message
    assert "\n" not in message


def test_load_corners_must_rise(tmp_path):
    with pytest.raises(InputError, match="times must rise"):
        read(tmp_path, EXAMPLE.replace("duration = 3.0", "duration = 3.0\nload = [[1.0, 0.0], [0.5, 1.0]]"))


def test_a_file_that_is_not_text_is_refused(tmp_path):
    path = tmp_path / "T1.toml"
    path.write_bytes(b"id = '\xff'")
    with pytest.raises(InputError, match="not UTF-8"):
        scenario_file.read(path)


@pytest.mark.parametrize(("given", "near"), [("A18d", "A18"), ("a1o", "A1"), ("", "known: A09, A10")])
def test_unknown_scenarios_are_refused_with_what_there_is(given, near):
    with pytest.raises(InputError, match=near):
        scenario_file.load(given)


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("set:speed_rmp", "did you mean 'set:speed_ramp'"),
        ("set:dead_time", "0 … 5 us"),
        ("speed_ref", "commands[0][1] = 'speed_ref': not a choice; did you mean 'speed_ref_rpm'"),
    ],
)
def test_commands_are_checked_before_anything_runs(tmp_path, command, said):
    settings = execute.Settings(profile.Profile("bench", "", {}), profile.Changes(), 1, "r")
    with pytest.raises(InputError) as caught:
        execute.prepare(
            read(tmp_path, EXAMPLE.replace('"speed_ref_rpm", 100.0', f'"{command}", 100.0')), settings, fake_core
        )
    assert said in str(caught.value)


def test_the_users_change_wins_over_the_scenario_and_that_over_the_profile():
    settings = execute.Settings(
        profile.Profile("mine", "", {"adc": {"noise": 1.0, "inl": 1.0}}, {"speed_ramp": 5.0, "dead_time": 1.0}),
        profile.Changes({"adc": {"noise": 2.0}}, {"speed_law": 1.0}, []),
        1,
        "r",
    )
    predictive = execute.prepare(scenario_file.load("A18a"), settings, fake_core)[0]
    assert predictive.parameters == {"speed_law": 1.0, "speed_ramp": 0.0, "dead_time": 1.0}
    assert predictive.plant == {"adc": {"noise": 2.0, "inl": 1.0}}


def test_no_title_promises_what_the_usual_position_source_does_not_show():
    """One estimator for all speeds has no blend; what shows the paper's says with which setting."""
    for scenario in map(scenario_file.load, scenario_file.ids()):
        assert "blend" not in scenario.title.lower()
        if "blend" in scenario.description.lower():
            assert "position_source" in scenario.description, scenario.id
