"""Motors: what ships is consistent, a profile is laid over it, and the drive of each is told what its plant is."""

import importlib
import json

import pytest

import fake_core
from stillspin import core, resources
from stillspin.cases import profile, similarity
from stillspin.errors import InputError

SCHEMA = core.plant_schema(fake_core)
KNOWN = core.parameters(fake_core)
MOTORS = resources.names("motors")

TOLD = {
    "pole_pairs": ("machine", "pole_pairs", 1.0),
    "stator_resistance": ("machine", "resistance", 1.0),
    "inductance_d": ("machine", "inductance_d", 1e3),
    "inductance_q": ("machine", "inductance_q", 1e3),
    "magnet_flux": ("machine", "magnet_flux", 1.0),
    "inertia": ("mechanics", "inertia", 1.0),
    "friction": ("mechanics", "viscous_friction", 1.0),
    "current_full_scale": ("adc", "current_range", 1.0),
    "link_full_scale": ("adc", "voltage_range", 1.0),
}
"""Firmware parameter -> plant entry, and how many of its units make one of the plant's."""


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


@pytest.mark.parametrize("motor", MOTORS)
def test_the_drive_is_told_the_nameplate_of_its_plant(native, motor):
    known, schema = core.parameters(native), core.plant_schema(native)
    loaded = profile.load("ideal", schema, known, motor)
    for name, (section, key, units) in TOLD.items():
        told = loaded.parameters.get(name, known[name].default)
        assert told == pytest.approx(loaded.plant[section].get(key, schema[section][key].default) * units), name


@pytest.mark.parametrize("motor", MOTORS)
def test_the_firmware_takes_what_it_is_told(native, motor):
    for name in ("ideal", "bench"):
        native.check_parameters(
            profile.load(name, core.plant_schema(native), core.parameters(native), motor).parameters
        )


@pytest.mark.parametrize("motor", MOTORS)
def test_every_motor_states_the_same(motor):
    """What one leaves out would be the plant's default, which is another motor. The sensors' ranges are the board's."""

    def stated(name):
        plant = profile.load("ideal", SCHEMA, KNOWN, name).plant
        return {section: set(keys) - {"current_range", "voltage_range"} for section, keys in plant.items()}

    assert stated(motor) == stated(MOTORS[0])


def test_the_axis_of_every_salient_motor_turns_by_the_same_angle():
    """Five degrees at rated current, where the incremental Lqq has lost a fifth."""
    for motor in ("A", "B"):
        machine = profile.load("bench", SCHEMA, KNOWN, motor).plant["machine"]
        assert machine["saturation"]
        saliency = 0.8 * machine["inductance_q"] - machine["inductance_d"]
        assert 2.0 * machine["cross_inductance"] / saliency == pytest.approx(0.176, abs=0.002)  # tan 10°


def test_a_profile_is_laid_over_the_motor(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("[adc]\ncurrent_range = 60\n[parameters]\ncurrent_full_scale = 60\n", encoding="utf-8")
    loaded = profile.load(str(path), SCHEMA, KNOWN, "B")
    assert (loaded.name, loaded.motor) == ("mine", "B")
    assert loaded.plant["adc"] == {"current_range": 60.0, "voltage_range": 225.0}
    assert loaded.plant["machine"]["inductance_d"] == 0.76e-3
    assert (loaded.parameters["current_full_scale"], loaded.parameters["current_limit"]) == (60.0, 25.0)


def test_a_motor_can_be_a_file_and_is_checked(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text("[machine]\nresistance = 2.5\n", encoding="utf-8")
    loaded = profile.load("ideal", SCHEMA, KNOWN, str(path))
    assert (loaded.motor, loaded.plant["machine"]["resistance"]) == ("small", 2.5)
    with pytest.raises(InputError, match="there is no motor 'C'"):
        profile.load("ideal", SCHEMA, KNOWN, "C")
    path.write_text("[machine]\nresistence = 2.5\n", encoding="utf-8")
    with pytest.raises(InputError, match="did you mean 'resistance'"):
        profile.load("ideal", SCHEMA, KNOWN, str(path))


def test_a_scenario_runs_on_another_motor(call, tmp_path):
    assert call("run", "A10", "--motor", "B", "--no-plots", "--out", "r").exit_code == 0
    page = (tmp_path / "r" / "report.html").read_text(encoding="utf-8")
    assert "Runs on motor B" in page
    assert "0.00163" in page


def test_a_campaign_keeps_the_motors_apart(call, tmp_path):
    """Two of one motor in one call and one of the other: each on its own plant, with its own commissioning."""
    words = ("--jobs", 1, "--no-paper-scheme", "--out", "r")
    assert call("reproduce", "A10", "--motor", "B", *words).exit_code == 0
    read = json.loads((tmp_path / "r" / "metrics.json").read_text(encoding="utf-8"))
    assert list(read["scenarios"]) == ["A10"]
    assert (tmp_path / "r" / "params.toml").read_text(encoding="utf-8").startswith("# Motor B, commissioned in")


def test_what_cannot_be_is_said(call, tmp_path):
    assert "there is no motor 'C'" in call("run", "A10", "--motor", "C").stderr
    assert "name only one motor" in call("reproduce", "A10", "--motor", "A", "--motor", "B").stderr
    assert "there is no scenario for it" in call("reproduce", "--motor", "C").stderr


PUMP = """
[machine]
pole_pairs = 3
resistance = 2.5
inductance_d = 11e-3
inductance_q = 14e-3
magnet_flux = 0.11
[link]
source_voltage = 60.0
[adc]
current_range = 8.0
voltage_range = 100.0
[parameters]
current_limit = 5.0
"""


def pump(tmp_path, text=PUMP):
    path = tmp_path / "pump.toml"
    path.write_text(text)
    return path


def test_a_quantity_is_stated_once_and_the_drives_parameters_follow(native, tmp_path):
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), str(pump(tmp_path)))
    expected = {
        "pole_pairs": 3, "stator_resistance": 2.5, "inductance_d": 11.0, "inductance_q": 14.0, "magnet_flux": 0.11,
        "current_full_scale": 8.0, "trip_current": 7.2, "observer_noise": 40.0, "link_full_scale": 100.0,
        "link_minimum": 30.0, "link_regulation": 81.0, "link_maximum": 84.0, "map_current": 5.0,
        "weakening_limit": 4.0,
    }  # fmt: skip
    assert {name: loaded.parameters.get(name) for name in expected} == pytest.approx(expected)
    assert "inertia" not in loaded.parameters
    native.check_parameters({**loaded.parameters, "speed_limit": 1300})


def test_what_the_file_states_of_a_parameter_goes_before_what_follows(native, tmp_path):
    text = PUMP + "trip_current = 6.5\nstator_resistance = 2.6\n"
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), str(pump(tmp_path, text)))
    assert (loaded.parameters["trip_current"], loaded.parameters["stator_resistance"]) == (6.5, 2.6)
    assert loaded.plant["machine"]["resistance"] == 2.5


def test_what_is_not_stated_is_said_and_what_the_drive_keeps_instead(native, tmp_path):
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), str(pump(tmp_path)))
    assert "mechanics.inertia is not stated; the drive keeps inertia = 0.000284375 kgm2" in loaded.not_stated
    assert "parameters.speed_limit is not stated; the drive keeps speed_limit = 3300 rpm" in loaded.not_stated
    assert len(loaded.not_stated) == 5  # and friction, the rated current, and what goes by the size
    needed, _, kept = loaded.not_stated[-1].partition("; the drive keeps ")
    assert needed.endswith("without machine.rated_peak_current, mechanics.inertia")
    named = {row.split()[0]: float(row.split()[1]) for row in kept.split(", ")}
    known = core.at_scale(core.parameters(native), loaded.parameters)  # of a board whose sensors read up to 8 A
    assert named == pytest.approx({name: known[name].default for name in similarity.RULES}, rel=1e-5)
    assert not set(named) & set(loaded.parameters)  # the drive is told nothing of them
    assert named.items() >= {"start_current": 2.5, "if_current": 2.0, "polarity_current": 0.75}.items()


def test_with_the_size_known_or_the_parameter_stated_nothing_of_the_size_is_left(native, tmp_path):
    text = PUMP + "start_current = 2.0\n"
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), str(pump(tmp_path, text)))
    assert " if_current 2 A" in loaded.not_stated[-1]
    assert " start_current " not in loaded.not_stated[-1]
    text = PUMP.replace("[link]", "rated_peak_current = 4.0\n[mechanics]\ninertia = 1e-3\n[link]")
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), str(pump(tmp_path, text)))
    assert not any("no rule says" in words for words in loaded.not_stated)
    assert not any("if_current" in words for words in loaded.not_stated)
    assert set(loaded.by_rule) >= {"start_current", "if_current", "polarity_current"}


@pytest.mark.parametrize("motor", MOTORS)
def test_the_motors_that_ship_leave_nothing_out(native, motor):
    assert profile.load("bench", core.plant_schema(native), core.parameters(native), motor).not_stated == ()


def test_a_run_says_on_the_terminal_what_is_not_stated(call, tmp_path):
    result = call("run", "A10", "--motor", pump(tmp_path), "--profile", "ideal", "--no-plots")
    assert "stillspin: motor pump: mechanics.inertia is not stated; the drive keeps inertia" in result.stderr
    assert "motor pump: no rule says what goes by the machine's size" in result.stderr
    assert ", speed_alpha 12.5 A2s2" in result.stderr
    page = next(tmp_path.glob("results*/report.html")).read_text(encoding="utf-8")
    assert "mechanics.inertia is not stated" in page
