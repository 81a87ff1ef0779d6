"""`stillspin motor`: what will work with a motor and what will not; a file from what a nameplate says."""

import importlib
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from test_motors import PUMP
from typer.testing import CliRunner

from stillspin import cli, core, resources
from stillspin.cases import motor_check, profile
from stillspin.cases.motor_told import Finding, Motor
from stillspin.measure import metrics

SALIENT = PUMP.replace("60.0", "300.0").replace("8.0", "20.0").replace("100.0", "450.0") + "speed_limit = 1500\n"
"""A motor that the drive runs."""


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def told(*arguments):
    return CliRunner().invoke(cli.app, ["motor", *map(str, arguments)])


def findings(native, tmp_path: Path, text: str) -> dict[str, Finding]:
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load("bench", schema, known, str(path), checked=False)
    found = motor_check.findings(Motor(chosen, schema, known), native)
    return {finding.title: finding for finding in found}


def test_motor_a_works_and_its_start_is_tried(native):
    result = told("check", "A")
    assert result.exit_code == 0, result.stdout
    assert re.search(r"works  tried: started, 3[23]\d rpm of 330 rpm after 2 s", result.stdout)
    assert "no problem found" in result.stdout


HUB = """
[machine]
pole_pairs = 10
resistance = 0.12
inductance_d = 0.25e-3
inductance_q = 0.27e-3
magnet_flux = 0.03
rated_peak_current = 15.0

[mechanics]
inertia = 0.01

[link]
source_voltage = 24.0

[adc]
current_range = 40.0
voltage_range = 36.0

[parameters]
current_limit = 19.5
speed_limit = 400
"""
"""Of a wheel on 24 V: the switches of a board for 300 V would take a twelfth of that."""


def test_the_bench_of_another_board_is_of_its_size(native, tmp_path):
    found = findings(native, tmp_path, HUB)
    assert all(finding.works for finding in found.values()), found
    assert "rpm after 2 s" in found["tried"].words


def test_motor_b_works_up_to_its_speed_limit_and_not_beyond(native, tmp_path):
    assert told("check", "B").exit_code == 0
    text = (resources.directory("motors") / "B.toml").read_text(encoding="utf-8")
    finding = findings(native, tmp_path, text.replace("speed_limit = 2600", "speed_limit = 3300"))["top speed"]
    assert not finding.works
    assert "the EMF takes the link's voltage at 2151 rpm" in finding.words
    assert "speed_limit is 3300 rpm: lower it to 2610 rpm" in finding.words


@pytest.mark.parametrize("wanted", [2600.0, 3300.0])
def test_the_virtual_drive_agrees_about_motor_b(native, wanted):
    """Unloaded and on the true machine: up to its speed limit, and not to the one of motor A."""
    chosen = profile.load("ideal", core.plant_schema(native), core.parameters(native), "B")
    result = native.run(
        plant=profile.merged(chosen.plant, {"solver": {"method": "rk4"}}),
        parameters={**chosen.parameters, "speed_limit": 3300.0},
        commands=[(0.0, "speed_ref_rpm", wanted)],
        load=[],
        duration=4.0,
        max_start=5.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed and not result.faults
    assert (abs(float(result.signals["true_speed"][-1]) - wanted) < 10.0) == (wanted == 2600.0)


def test_a_saliency_that_ends_within_the_current_limit_is_said_with_what_is_left(native, tmp_path):
    found = findings(native, tmp_path, SALIENT.replace("current_limit = 5.0", "current_limit = 14.0"))
    assert found["start at rest"].works
    assert found["start at rest"].words.endswith("no more than saliency_current, 7 A, while it is slow")
    small = findings(native, tmp_path, SALIENT)
    assert small["start at rest"].works and "saliency_current" not in small["start at rest"].words


def test_a_ripple_that_the_formula_lets_pass_is_found_by_the_start(native, tmp_path):
    """Half the pulse on top of the limit is below the trip, but what the pulses of a start add up to is not."""
    low = SALIENT.replace("11e-3", "0.5e-3").replace("14e-3", "0.8e-3").replace("resistance = 2.5", "resistance = 0.3")
    found = findings(native, tmp_path, low)
    assert found["ripple"].works
    assert not found["tried"].works and "over-current" in found["tried"].words


def test_a_motor_without_saliency_is_turned_by_a_vector(native):
    result = told("check", "B-SPM")
    assert result.exit_code == 0, result.stdout
    assert "at rest the angle is not known; below" in result.stdout
    assert "works  tried: started" in result.stdout


def test_without_a_vector_it_is_said_how_to_start_it(native, tmp_path):
    found = findings(native, tmp_path, SALIENT.replace("14e-3", "11e-3") + "start_method = 0\n")
    assert not found["start at rest"].works and "start_method = 1" in found["start at rest"].words
    assert not found["tried"].works


def test_a_vector_longer_than_can_be_damped_is_said(native, tmp_path):
    text = SALIENT.replace("14e-3", "11e-3").replace("current_limit = 5.0", "current_limit = 12.0\nif_current = 11.0")
    found = findings(native, tmp_path, text)
    assert not found["start at rest"].works and "lower if_current below 10 A" in found["start at rest"].words


def catalogue_motor(native, name):
    schema, known = core.plant_schema(native), core.parameters(native)
    return profile.load(name, schema, known, name)


@pytest.mark.parametrize("name", ["gimbal_10v", "hub_36v", "fan_310v"])
@pytest.mark.parametrize("angle", [0.3, -2.0])
def test_a_surface_magnet_motor_starts_against_a_load_and_carries_it(native, name, angle):
    """What follows from the nameplate, and a brake of a third of what the vector carries."""
    chosen = catalogue_motor(native, name)
    told = chosen.parameters
    brake = 0.33 * 1.5 * told["pole_pairs"] * told["magnet_flux"] * told["if_current"]
    wanted = 1.3 * told["if_speed"]
    own = {"initial": {"angle": angle}, "mechanics": {"coulomb_friction": brake, "stiction": brake}}
    result = native.run(
        plant=profile.merged(chosen.plant, own),
        parameters=told,
        commands=[(0.0, "speed_ref_rpm", wanted)],
        load=[],
        duration=1.5,
        max_start=8.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed and not result.faults, result.reason
    signals = dict(result.signals)
    late = np.asarray(signals["time"]) > 1.0
    assert np.max(np.abs(metrics.position_error(signals)[late])) < 12.0
    assert np.abs(np.mean(np.asarray(signals["true_speed"])[late]) - wanted) < 0.1 * wanted


@pytest.mark.parametrize(
    ("change", "title", "words"),
    [
        (
            ("current_limit = 5.0", "current_limit = 88.0"),
            "start at rest",
            "an eighth of that is there up to 10.5 A; current_limit is 88 A: choose current_limit below 79.5 A",
        ),
        (("magnet_flux = 0.11", "magnet_flux = 0.9"), "gates off", "link_maximum is 420 V"),
        (("magnet_flux = 0.11", "magnet_flux = 0.9"), "top speed", "speed_limit is 1500 rpm"),
        (
            ("magnet_flux = 0.11", "magnet_flux = 0.9"),
            "drive's rules",
            "beyond link_maximum; speed_limit = 1500 rpm: at most 857 rpm with link_maximum = 420 V",
        ),
        (
            ("current_limit = 5.0", "current_limit = 5.0\ntrip_current = 4.0"),
            "drive's rules",
            "current_limit; trip_current = 4 A: at least 5.00 A with current_limit = 5 A; or current_limit = 5 A: at",
        ),
        (
            ("current_limit = 5.0", "current_limit = 5.0\ncurrent_divider = 2\ncurrent_bandwidth = 2600"),
            "drive's rules",
            "current_divider 2; current_bandwidth = 2600 rad/s: at most 2080 rad/s with current_divider = 2",
        ),
        (
            ("inductance_d = 11e-3", "inductance_d = 0.15e-3"),
            "drive's rules",
            "inductances, map, speed_limit; inductance_d = 0.15 mH: at least",
        ),
        (
            ("current_limit = 5.0", "current_limit = 21.0\ncurrent_bandwidth = 2600"),
            "current loop",
            "lower current_bandwidth to 2501 rad/s",
        ),
        (
            ("[adc]", "[mechanics]\ninertia = 1e-5\n[adc]"),
            "swing",
            "swing at 1080 rad/s; current_bandwidth is 1800 rad/s, at least 2160 rad/s are needed",
        ),
        (
            (
                "current_limit = 5.0",
                "current_limit = 5.0\nspeed_law = 1\nspeed_pi_bandwidth = 100\nspeed_pi_damping = 0.3",
            ),
            "speed loop",
            "with 29° of phase left (30° are needed)",
        ),
        (
            ("current_limit = 5.0", "current_limit = 5.0\ninertia = 0.02"),
            "speed loop",
            "tell the right inertia",
        ),
        (
            ("inductance_d = 11e-3", "inductance_d = 0.3e-3"),
            "ripple",
            "by 28 A, up to 19 A at current_limit; trip_current is 18 A",
        ),
        (("source_voltage = 300.0", "source_voltage = 20.0"), "polarity", "asks for 5 A; the link drives up to 4.62 A"),
        (("pole_pairs = 3", "pole_pairs = 40"), "range", "pole_pairs: 40 is out of range; 1 … 30"),
        (("pole_pairs = 3", "pole_pairs = 20\n"), "periods per turn", ""),
    ],
)
def test_what_will_not_work_is_said_with_its_numbers(native, tmp_path, change, title, words):
    assert change[0] in SALIENT
    text = SALIENT.replace(*change)
    if title == "periods per turn":
        text = text.replace("speed_limit = 1500", "speed_limit = 4000")
    finding = findings(native, tmp_path, text)[title]
    assert not finding.works
    assert words in finding.words


def test_a_current_loop_that_may_not_be_slower_gets_less_current(native, tmp_path):
    light = SALIENT.replace("[adc]", "[mechanics]\ninertia = 7e-6\n[adc]")
    fast = light.replace("current_limit = 5.0", "current_limit = 21.0\ncurrent_bandwidth = 2600")
    words = findings(native, tmp_path, fast)["current loop"].words
    remedy = re.search(r"lower current_limit to ([\d.]+) A; a current_bandwidth of \d+ rad/s is too slow", words)
    assert remedy, words
    found = findings(native, tmp_path, fast.replace("21.0", remedy[1]))
    assert found["current loop"].works and found["swing"].works


def test_what_is_not_stated_is_noted(native, tmp_path):
    (tmp_path / "pump.toml").write_text(SALIENT, encoding="utf-8")
    assert "note   mechanics.inertia is not stated; the drive keeps" in told("check", tmp_path / "pump.toml").stdout


LEFT = "start_current 10 A", "if_current 8 A", "polarity_current 3 A", "speed_alpha 200 A2s2", "observer_load_step 2 Nm"


def test_what_neither_follows_nor_is_stated_is_named_with_the_default_that_holds(native, tmp_path):
    """By unit: no list of names to forget one in; what is off by default, or follows from a parameter, is not named."""
    (tmp_path / "pump.toml").write_text(SALIENT + "start_current = 4\n", encoding="utf-8")
    lines = told("check", tmp_path / "pump.toml").stdout.splitlines()
    (note,) = (line for line in lines if "by the machine's size" in line)
    assert note.startswith("note   no rule says")
    assert [words in note for words in LEFT] == [False, True, True, True, True]
    (other,) = (line for line in lines if "nor implied" in line)
    assert other.startswith("note   ") and "hysteresis_band 0.4 A" in other
    assert not any(words in other for words in LEFT)  # once is enough
    note += other
    for name in ("observer_noise", "map_current", "weakening_limit", "id_low_speed", "overload_current", "drift_time"):
        assert f" {name} " not in note


def test_what_a_rule_says_of_a_motor_of_another_size_is_named_with_its_value(native):
    lines = told("check", "pmsyrm_15kw", "--profile", "pmsyrm_15kw").stdout.splitlines()
    (note,) = (line for line in lines if "by rules" in line)
    assert "start_current 40 A" in note and "speed_ramp" not in note  # the latter is what it is by default
    (note,) = (line for line in lines if "nor implied" in line)
    assert "hysteresis_band 0.8 A" in note and "drop_band" not in note and "speed_ramp" not in note


def test_a_bad_file_is_bad_input(native, tmp_path):
    (tmp_path / "bad.toml").write_text("[machine]\nresistanze = 1\n", encoding="utf-8")
    result = told("check", tmp_path / "bad.toml")
    assert result.exit_code == 2
    assert "did you mean 'resistance'" in result.stderr


ANSWERS = {
    "--pole-pairs": "4", "--resistance": "0.32", "--inductance-d": "4.9", "--inductance-q": "7.8", "--emf": "82.07",
    "--rated-current": "7.7", "--inertia": "4.55e-3", "--voltage": "300", "--current-range": "20", "--speed": "3e3",
}  # fmt: skip


def test_a_new_motor_is_written_from_a_nameplate_and_works(native, tmp_path):
    path = tmp_path / "new.toml"
    made = told("new", path, *(part for pair in ANSWERS.items() for part in pair))
    assert made.exit_code == 0, made.stderr
    assert "hysteresis_band 0.4 A" in made.stdout
    assert not any(words in made.stdout for words in LEFT)  # these follow, and are what they are by default
    machine = tomllib.loads(path.read_text(encoding="utf-8"))["machine"]
    assert machine["magnet_flux"] == pytest.approx(0.16, rel=1e-3)
    assert machine["rated_peak_current"] == pytest.approx(10.89, rel=1e-3)
    assert machine["inductance_d"] == 4.9e-3
    checked = told("check", path)
    assert checked.exit_code == 0, checked.stdout
    said = [line for line in checked.stdout.splitlines() if "is not stated" in line]
    assert said == [
        "note   machine.cross_inductance is not stated; by rule it is 0.000118 H",
        "note   mechanics.viscous_friction is not stated; by rule it is 0.00137 Nms",
    ]
    again = told("new", path, *(part for pair in ANSWERS.items() for part in pair))
    assert again.exit_code == 2 and "exists already" in again.stderr


def test_the_questions_are_asked_one_by_one(native, tmp_path):
    path = tmp_path / "asked.toml"
    answers = "\n".join(ANSWERS.values()) + "\n"
    result = CliRunner().invoke(cli.app, ["motor", "new", str(path)], input=answers)
    assert result.exit_code == 0, result.output
    assert result.stdout.count(":") >= len(ANSWERS)
    assert tomllib.loads(path.read_text(encoding="utf-8"))["link"]["source_voltage"] == 300


def test_a_wrong_answer_is_asked_for_again_at_once(native, tmp_path):
    path = tmp_path / "asked.toml"
    result = CliRunner().invoke(
        cli.app, ["motor", "new", str(path)], input="2.5\n" + "\n".join(ANSWERS.values()) + "\n"
    )
    assert result.exit_code == 0, result.output
    assert result.output.count("Pole pairs") == 2 and "2.5 is not a whole number" in result.output
    assert tomllib.loads(path.read_text(encoding="utf-8"))["machine"]["pole_pairs"] == 4


@pytest.mark.parametrize(("ctrl_c", "status", "words"), [(False, 2, "the input ended"), (True, 130, "interrupted")])
def test_who_gives_up_at_a_question_is_told_that_nothing_was_done(tmp_path, ctrl_c, status, words):
    path = tmp_path / "asked.toml"
    with subprocess.Popen(
        [sys.executable, "-m", "stillspin", "motor", "new", str(path)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as asking:  # fmt: skip
        assert asking.stdout and asking.stdin
        assert asking.stdout.read(10) == "Pole pairs"
        if ctrl_c:
            asking.send_signal(signal.SIGINT)
            asking.wait(10)
        said = asking.communicate(timeout=10)[1]
    assert asking.returncode == status
    assert said.split("\n")[-2] == f"stillspin: {words} before the last question; nothing was done"
    assert not path.exists()


@pytest.mark.parametrize(
    ("flag", "typed", "words"),
    [
        ("--pole-pairs", "2.5", "not a whole number"),
        ("--emf", "1,5", "no comma"),
        ("--rated-current", "0.01", "machine.rated_peak_current: 0.0141421 A is out of range; 0.1 … 1000 A"),
    ],
)
def test_a_wrong_answer_is_bad_input_and_writes_nothing(native, tmp_path, flag, typed, words):
    path = tmp_path / "new.toml"
    answers = ANSWERS | {flag: typed}
    result = told("new", path, *(part for pair in answers.items() for part in pair))
    assert result.exit_code == 2 and words in result.stderr
    assert not path.exists()
