"""Other people's motors: each file says what it is and where it is from, and what the drive says of it is on record."""

import importlib
import json
import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

from stillspin import catalogue, cli, core, json_schema, resources
from stillspin.cases import file_schema, nameplate, profile
from stillspin.drive.own import firmware
from stillspin.errors import InputError
from stillspin.revision import revision

ROOT = Path(__file__).resolve().parents[2]
NAMES = [entry.name for entry in catalogue.entries()]
STATED = {
    "machine": {"pole_pairs", "resistance", "inductance_d", "inductance_q", "magnet_flux", "rated_peak_current",
                "cross_inductance"},
    "mechanics": {"inertia", "viscous_friction"},
    "link": {"source_voltage", "brake_on_voltage", "brake_off_voltage", "brake_resistance"},
    "adc": {"current_range", "voltage_range"},
    "parameters": {"current_limit", "speed_limit"},
}  # fmt: skip
"""What every file has: a key that is left out would be the plant's default, which is motor A's."""


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def table(kind, name):
    return tomllib.loads(resources.find(kind, name).read_text(encoding="utf-8"))


def without_ranges(schema):
    """The drive's parameters by name and type alone: their ranges are what a verdict is about."""
    kept = {"type": "object", "additionalProperties": False}
    named = {name: {"type": "number"} for name in schema["properties"]["parameters"]["properties"]}
    return schema | {"properties": schema["properties"] | {"parameters": kept | {"properties": named}}}


def test_the_catalogue_goes_from_a_gimbal_to_a_traction_machine():
    motors = catalogue.entries()
    assert len(motors) >= 20
    assert min(motor.volts for motor in motors) <= 10 and max(motor.volts for motor in motors) >= 800
    assert min(motor.amperes for motor in motors) < 1
    assert max(table("motors", name)["parameters"]["current_limit"] for name in NAMES) >= 600
    assert {motor.pole_pairs for motor in motors} >= {1, 21}
    assert min(motor.saliency for motor in motors) < 1 and max(motor.saliency for motor in motors) > 6
    assert {"hub_36v", "compressor_12a", "pm_2k2_540v"} <= set(NAMES)
    assert not set(NAMES) & set(resources.names("motors"))


@pytest.mark.parametrize("name", NAMES)
def test_a_file_states_all_that_is_asked_of_a_motor_and_passes_the_schema(native, name):
    motor = table("motors", name)
    for section, keys in STATED.items():
        assert keys <= set(motor[section]), section
    schema, known = core.plant_schema(native), core.parameters(native)
    json_schema.check(motor, without_ranges(file_schema.schema("motor", schema, known)), name)
    json_schema.check(table("profiles", name), file_schema.schema("profile", schema, known), name)
    plant = {section: motor[section] for section in ("machine", "mechanics", "link", "adc")}
    assert nameplate.not_stated(plant, motor["parameters"], known) == ()


@pytest.mark.parametrize("name", NAMES)
def test_a_file_says_where_its_data_are_from_and_what_is_assumed(name):
    entry, motor = catalogue.read(resources.find("motors", name)), table("motors", name)
    assert re.search(r"\b(19|20)\d\d\b", entry.source), "a year"
    assert set(entry.assumed) <= {key for section in ("machine", "mechanics", "link") for key in motor[section]}
    crossed = 2.0 * motor["machine"]["cross_inductance"]
    left = 0.8 * motor["machine"]["inductance_q"] - motor["machine"]["inductance_d"]
    assert crossed == pytest.approx(0.1763 * max(left, 0.0), rel=0.01)  # tan 10°: the axis turns by half of it
    assert ("cross_inductance" in entry.assumed) == (crossed > 0.0)


@pytest.mark.parametrize("name", NAMES)
def test_its_nameplate_is_one(name):
    """Power and speed are such that the current makes them, and the top speed is not below them."""
    entry, machine = catalogue.read(resources.find("motors", name)), table("motors", name)["machine"]
    flux, current = machine["magnet_flux"], entry.amperes
    torque = entry.kilowatts * 1e3 / (entry.speed * 0.1047)
    reluctance = abs(machine["inductance_q"] - machine["inductance_d"]) * current / 2.0
    most = 1.5 * entry.pole_pairs * (flux + reluctance) * current
    limit = table("motors", name)["parameters"]["current_limit"]
    assert 0.2 * most < torque < 1.1 * most * limit / current
    assert entry.speed <= table("motors", name)["parameters"]["speed_limit"]


@pytest.mark.parametrize("name", NAMES)
def test_the_flaws_of_its_profile_are_shares_of_its_own_ratings(name):
    motor, flaws = table("motors", name), table("profiles", name)
    volts, amperes = motor["link"]["source_voltage"], motor["machine"]["rated_peak_current"]
    span = motor["adc"]["current_range"]
    assert motor["parameters"]["current_limit"] / span == pytest.approx(0.7, abs=0.01)
    assert motor["adc"]["voltage_range"] / volts == pytest.approx(1.5)
    for leg, share in (("offset_a", 0.0015), ("offset_b", -0.001), ("offset_c", 0.0005)):
        assert flaws["sensor"][leg] == pytest.approx(share * span, rel=0.1)
    assert flaws["sensor"]["ring_amplitude"] == pytest.approx(min(0.015 * span, 10.0), rel=0.1)
    drop = flaws["inverter"]["switch_threshold"] + flaws["inverter"]["switch_resistance"] * amperes
    assert 0.0015 * volts < drop < 0.0075 * volts
    assert flaws["link"]["source_resistance"] * amperes == pytest.approx(0.011 * volts, rel=0.1)
    torque = 1.5 * motor["machine"]["pole_pairs"] * motor["machine"]["magnet_flux"] * amperes
    assert flaws["mechanics"]["cogging_torque"] == pytest.approx(min(0.01 * torque, 10.0), rel=0.1)
    bench = table("profiles", "bench")
    assert flaws["parameter_error"] == bench["parameter_error"]
    assert flaws["adc"] == bench["adc"]
    told = flaws["parameters"]
    assert told["turn_on_delay"] == pytest.approx(flaws["inverter"]["turn_on_delay"] / 100)
    assert told["turn_off_delay"] == pytest.approx(flaws["inverter"]["turn_off_delay"] / 100)
    between = sorted((flaws["inverter"]["switch_threshold"], flaws["inverter"]["diode_threshold"]))
    assert between[0] <= told["device_drop"] <= between[1]


def test_a_verdict_is_the_first_thing_that_motor_check_finds(native):
    said = CliRunner().invoke(cli.app, ["motor", "check", "inrunner_12v", "--profile", "inrunner_12v"])
    first = next(line for line in said.stdout.splitlines() if line.startswith("WRONG"))
    verdict = catalogue.verdict("inrunner_12v", native)
    assert (verdict.word, first) == ("will not work", f"WRONG  {verdict.reason}")
    assert catalogue.verdict("heavy_350kw", native).word == "refused"


def test_a_motor_that_works_has_no_reason(native, monkeypatch):
    monkeypatch.setattr(profile, "load", lambda _name, schema, known, *_, load=profile.load, **__: load(
        "bench", schema, known, "A"))  # fmt: skip
    assert catalogue.verdict("compressor_12a", native) == catalogue.Verdict("works", "")


def test_it_is_listed_with_its_sources(native):
    said = CliRunner().invoke(cli.app, ["motor", "list"], env={"COLUMNS": "250"})
    assert said.exit_code == 0
    assert "TI Motor Control SDK" in said.stdout and "motor check" not in said.stdout


def test_what_the_drive_says_of_each_is_listed_and_on_record(native, tmp_path):
    """A drive that takes more of them makes the record stale: `make catalogue` renews it, and the table of the book."""
    on_record = json.loads((ROOT / "docs/figures/catalogue.json").read_text(encoding="utf-8"))["figures"]
    said = CliRunner().invoke(cli.app, ["motor", "list", "--json", str(tmp_path / "said.json")])
    assert "refused" in said.stdout
    written = json.loads((tmp_path / "said.json").read_text(encoding="utf-8"))
    assert written.pop("motors") == on_record
    assert written == {"revision": revision(), "firmware": firmware()}
    assert set(on_record) == set(NAMES)


def test_a_name_that_is_nearly_one_of_them_is_found():
    with pytest.raises(InputError, match="did you mean 'compressor_12a'"):
        resources.find("motors", "compressor_12")
    with pytest.raises(InputError, match="did you mean 'hub_36v'"):
        resources.find("profiles", "hub36v")


@pytest.mark.parametrize(
    "words", ["", "A motor.", "Pump: 1 kW at 10 rpm.\nSource: X.\n", "Pump: 1 kW at 10 rpm.\nAssumed: nothing.\n"]
)
def test_a_file_that_does_not_say_its_source_is_none_of_the_catalogue(tmp_path, words):
    path = tmp_path / "pump.toml"
    path.write_text(f'description = """\n{words}"""\n[machine]\npole_pairs = 3\n', encoding="utf-8")
    with pytest.raises(InputError, match=r"'Source: WHERE\.'"):
        catalogue.read(path)
