"""The command `stillspin campaign`: what it runs, keeps, shrinks, goes on with and refuses."""

import functools
import json
import shlex
import tomllib
import xml.etree.ElementTree as ET
from dataclasses import replace

import jsonschema
import pytest
from campaign_files import HARMLESS, HEAVY, schema, written
from typer.testing import CliRunner

from stillspin import cli, csv_table, resources
from stillspin.campaign import faults, spread, units
from stillspin.campaign.draw import Case, Drawer
from stillspin.campaign.written import text as scenario_text
from stillspin.cases import scenario_file
from stillspin.commands import campaign
from stillspin.drive import own
from stillspin.studies import reproduction

pytest.importorskip("stillspin._core", reason="the native module is not built")

FIRMWARE = functools.cache(own.firmware)
"""Asked once: each time a board is switched on for it."""


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Calls the command line in an empty directory, with the real native module."""
    monkeypatch.chdir(tmp_path)
    for caller in (campaign, reproduction):
        monkeypatch.setattr(caller, "firmware", FIRMWARE)
    return lambda *words: CliRunner().invoke(cli.app, [str(word) for word in words])


def test_a_planted_cause_is_what_a_failure_is_shrunk_to(call, tmp_path):
    """A load beyond what the current holds, among departures that do no harm; the file fails without the campaign."""
    mine = written(tmp_path, HARMLESS + HEAVY)
    source = Drawer(spread.load(mine, schema()), faults.Faults(), 1)
    number = next(n for n in range(1, 100) if source.case(n).drawn["heavy"] > 95.0)
    words = ("campaign", "--profile", "ideal", "--spread", mine, "--case", str(number), "--jobs", "1")
    done = call(*words, "--out", "r", "--junit", "j.xml")
    assert done.exit_code == 1, done.output
    assert "A: 1 of 1 case failed" in done.stdout
    found = json.loads((tmp_path / "r/metrics.json").read_text())
    (left,) = found["shrunk"]
    assert left["needs"].startswith("heavy +"), left
    assert "," not in left["needs"]
    (case,) = list(ET.parse(tmp_path / "j.xml").getroot().iter("testcase"))
    assert case.find("failure") is not None

    file = tmp_path / f"r/A-case-{number}.toml"
    command = shlex.split(left["command"])
    assert file.read_text().splitlines()[0] == f"# {left['command']}"
    again = call(*command[1:], "--no-plots", "--out", "again")
    assert again.exit_code == 1, again.output
    assert "broken off" in again.stderr
    torque = tomllib.loads(file.read_text())["runs"][0]["load"][1][1]
    rated = 1.5 * 4 * 0.16 * 10.8894
    less = rated * (0.5 + (torque / rated - 0.5) / 2.0)  # half of the departure
    file.write_text(file.read_text().replace(repr(torque), repr(less)))
    assert call(*command[1:], "--no-plots", "--out", "again").exit_code == 0


def test_a_campaign_that_was_broken_off_goes_on(call, tmp_path):
    mine = written(tmp_path, HARMLESS)
    words = ["campaign", "--profile", "ideal", "--spread", mine, "--json", "c.jsonl", "--jobs", "1", "--out", "r"]
    assert call(*words, "-n", "1").exit_code == 0
    before = (tmp_path / "c.jsonl").read_text()
    assert call(*words, "-n", "3").exit_code == 2
    done = call(*words, "-n", "3", "--resume")
    assert done.exit_code == 0, done.output
    assert "A: 0 of 3 cases failed (0.0 to 56.2 % at 95 %)" in done.stdout
    after = (tmp_path / "c.jsonl").read_text()
    assert after.startswith(before)
    assert len(after.splitlines()) == 4
    about, rows = csv_table.read(tmp_path / "r/cases.csv")
    assert about["firmware"] == own.firmware()
    assert [each["number"] for each in rows] == ["1", "2", "3"]
    other = call(*words, "-n", "3", "--resume", "--set", "mechanics.inertia=0.01")
    assert other.exit_code == 2
    assert "of another campaign: units" in other.stderr


def test_a_fault_that_the_drive_says_is_counted_apart_and_a_motor_that_it_refuses_is_refused(call, tmp_path):
    mine = written(tmp_path, HARMLESS)
    broken = 'share = 1.0\nwindow = [0.4, 0.5]\n[[faults]]\nname = "wire"\nset = { stuck_sensor = "a", '
    broken += 'stuck_sensor_value = 15.0 }\nat = "stuck_sensor_at"\n'
    words = [
        "campaign",
        "--profile",
        "ideal",
        "--spread",
        mine,
        "--jobs",
        "1",
        "-n",
        "1",
        "--shrink",
        "0",
        "--out",
        "r",
    ]
    call(*words, "--faults", written(tmp_path, broken, "faults.toml"))
    found = json.loads((tmp_path / "r/metrics.json").read_text())
    assert found["motors"]["A"]["plain"]["cases"] == 0
    assert found["motors"]["A"]["with_fault"]["cases"] == 1
    assert found["motors"]["A"]["with_fault"]["good"] == 0
    # Told to look for an axis that is not there, the start says that it cannot tell the polarity.
    told = (resources.find("motors", "B-SPM")).read_text(encoding="utf-8") + "start_method = 0\n"
    other = written(tmp_path, told, "SPM.toml")
    words += ["--motors", f"A,{other}", "--json", "c.jsonl"]
    done = call(*words)
    found = json.loads((tmp_path / "r/metrics.json").read_text())
    assert done.exit_code == 1, done.output
    assert (found["motors"]["A"]["plain"]["good"], found["motors"][other]["plain"]["refused"]) == (1, 1)
    assert any("polarity" in reason for reason in found["refusals"])
    assert "all of them: 0 of 1 case failed" in done.stdout
    assert call(*words, "--resume", "--may-refuse", "50").exit_code == 0


def test_editors_get_the_schemas_and_the_list_has_the_names(call):
    """The delivered files keep to what `stillspin schema` says."""
    listed = call("list").stdout
    for kind, folder, name in (("spread", "spreads", "manufacturing"), ("faults", "faults", "usual")):
        made = json.loads(call("schema", kind).stdout)
        jsonschema.validate(tomllib.loads(resources.find(folder, name).read_text()), made)
        assert f"{folder}: {name}" in listed
    assert "did you mean 'spread'?" in call("schema", "spred").stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--motors", "A,"), "has a comma with no motor beside it"),
        (("--motors", "C"), "there is no motor 'C'"),
        (("--spread", "manufactoring"), "there is no spread 'manufactoring'; did you mean 'manufacturing'?"),
        (("--faults", "usal"), "there is no fault 'usal'; did you mean 'usual'?"),
        (("--resume",), "--resume: goes on with the file of --json"),
        (("--may-refuse", "101"), "--may-refuse: 101 % is out of range; 0 … 100 %"),
        (("--motors", "A,B", "--params", "p.toml"), "is of one motor"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(call, words, said):
    done = call("campaign", *words)
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1), done.output
    assert said in done.stderr


def test_a_departure_that_leads_out_of_the_plant_is_refused_before_anything_runs(call, tmp_path):
    mine = written(tmp_path, HEAVY + HARMLESS.replace("gain_a = 0.01", "gain_a = 1.0"))
    done = call("campaign", "--spread", mine)
    assert done.exit_code == 2
    assert "motor A, gain -0.9 %, an end of what may be drawn, moves sensor.gain_a" in done.stderr
    assert "0.5 … 1.5" in done.stderr


def test_what_a_case_is_written_as_is_what_was_run(tmp_path):
    """The scenario of a case, read back from its file, is the scenario that the campaign ran."""
    source = Drawer(spread.load("manufacturing", schema()), faults.load("usual", schema()), 4)
    (unit,) = units.nominal(units.Wish(["B"], 1, "bench"))
    offset = unit.scenario(Case(1, {"sensor_offset_a": 0.1}), source).runs[0].plant["sensor"]["offset_a"]
    assert offset == pytest.approx(0.030 + 0.001 * 40.0)  # of bench, and a thousandth of what B's sensors measure
    case = next(source.case(n) for n in range(1, 50) if source.case(n).fault)
    path = tmp_path / "B-case-1.toml"
    path.write_text(scenario_text(path, unit, case, source, "lost"))
    (read,) = scenario_file.read(path).runs
    (ran,) = unit.scenario(case, source).runs
    assert replace(read, parameters=ran.parameters) == ran
    assert read.parameters == unit.told
