"""Campaigns: what is drawn, how a case is judged, what a failure is shrunk to, and the command as a whole."""

import csv
import functools
import json
import math
import random
import shlex
import tomllib
import xml.etree.ElementTree as ET
from dataclasses import replace
from types import SimpleNamespace

import jsonschema
import numpy as np
import pytest
from typer.testing import CliRunner

from stillspin import cli, core, resources, wilson
from stillspin.campaign import duty, faults, spread, tally, units
from stillspin.campaign.draw import PLAIN_NOISE, Case, Drawer
from stillspin.campaign.judge import CAUGHT, End, Verdict, judged
from stillspin.campaign.results import Results, Row
from stillspin.campaign.shrink import shrink
from stillspin.campaign.written import text as scenario_text
from stillspin.cases import profile, scenario_file
from stillspin.cases.scenario import Reached, Run
from stillspin.commands import campaign
from stillspin.drive import own
from stillspin.errors import InputError
from stillspin.runs import reproduction

pytest.importorskip("stillspin._core", reason="the native module is not built")

HARMLESS = """
[[departures]]
name = "warm"
unit = "K"
uniform = [-20.0, 40.0]
factor = { machine = { resistance = 0.0039, magnet_flux = -0.0011 } }

[[departures]]
name = "gain"
unit = "%"
normal = 0.3
add = { sensor = { gain_a = 0.01 } }

[[departures]]
name = "angle"
unit = "°"
uniform = [0.0, 360.0]
add = { initial = { angle = 0.017453292519943295 } }
"""
HEAVY = """
[[departures]]
name = "heavy"
unit = "% of rated"
uniform = [0.0, 110.0]
load = 0.01
"""
"""Beyond what the current limit holds for most of it: the shaft cannot follow, and stalls."""


FIRMWARE = functools.cache(own.firmware)
"""Asked once: each time a board is switched on for it."""


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Calls the command line in an empty directory, with the real native module."""
    monkeypatch.chdir(tmp_path)
    for caller in (campaign, reproduction):
        monkeypatch.setattr(caller, "firmware", FIRMWARE)
    return lambda *words: CliRunner().invoke(cli.app, [str(word) for word in words])


def schema():
    return core.plant_schema(core.load())


def written(folder, text, name="mine.toml"):
    (folder / name).write_text(text)
    return str(folder / name)


def drawer(folder, text=HARMLESS, seed=1, broken=None):
    return Drawer(spread.load(written(folder, text), schema()), broken or faults.Faults(), seed)


# ---- what is drawn


def test_a_case_is_of_its_seed_and_number_alone(tmp_path):
    one = drawer(tmp_path)
    again, other = drawer(tmp_path), drawer(tmp_path, seed=2)
    assert [one.case(n) for n in (7, 3)] == [again.case(7), again.case(3)]
    assert one.case(7).drawn != other.case(7).drawn
    assert one.case(7).noise != one.case(8).noise
    more = drawer(tmp_path, HEAVY + HARMLESS)
    assert {key: more.case(7).drawn[key] for key in one.case(7).drawn} == one.case(7).drawn


def test_draws_have_the_distribution_that_the_file_says(tmp_path):
    source = drawer(tmp_path)
    drawn = {name: np.array([source.case(n).drawn[name] for n in range(1, 801)]) for name in ("warm", "gain")}
    assert np.min(drawn["warm"]) >= -20.0
    assert np.max(drawn["warm"]) <= 40.0
    # Bounds of five standard errors of 800 draws.
    assert np.mean(drawn["warm"]) == pytest.approx(10.0, abs=5.0 * 60.0 / math.sqrt(12.0 * 800.0))
    assert np.max(np.abs(drawn["gain"])) <= 0.9  # three standard deviations where no limit is said
    assert np.std(drawn["gain"]) == pytest.approx(0.3, abs=5.0 * 0.3 / math.sqrt(2.0 * 800.0))


def test_the_delivered_spread_moves_what_its_departures_say():
    source = Drawer(spread.load("manufacturing", schema()), faults.load("usual", schema()), 1)
    moved = {
        f"{section}.{key}"
        for row in source.spread.departures
        for pulls in (row.factor, row.add, row.add_of_range)
        for section, keys in pulls.items()
        for key in keys
    }
    wanted = "resistance inductance_d inductance_q magnet_flux"
    assert {f"machine.{key}" for key in wanted.split()} < moved
    assert {"mechanics.inertia", "mechanics.viscous_friction", "sensor.gain_a", "sensor.offset_b"} < moved
    assert {"adc.voltage_gain", "link.source_voltage", "initial.angle"} < moved
    drawn = [source.case(n) for n in range(1, 401)]
    broken = [case for case in drawn if case.fault]
    assert {case.fault for case in broken} == {fault.name for fault in source.faults.faults}
    assert len(broken) == pytest.approx(200, abs=50)  # five standard deviations
    assert all(0.1 <= case.at <= 0.9 for case in broken)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            '[[departures]]\nname = "x"\nnormal = 1.0\n',
            "(x): moves nothing; give one of factor, add, add_of_range, load",
        ),
        ('[[departures]]\nname = "x"\nload = 1.0\n', "(x): give one of 'normal', with 'limit', and 'uniform'"),
        ('[[departures]]\nname = "x"\nload = 1\nuniform = [1.0, 2.0]\n', "from ≤ 0 ≤ to; 0 is nominal"),
        ('[[departures]]\nname = "x"\nload = 1\nnormal = -1.0\n', "normal = -1: must be above 0"),
        (HEAVY + HEAVY, "the name 'heavy' is used twice"),
        (HARMLESS.replace("resistance", "resistanc"), "unknown key 'resistanc'; did you mean 'resistance'?"),
        (HARMLESS.replace("gain_a", "count"), "unknown key 'count'"),
        (
            HARMLESS.replace("0.0039", "0.06"),
            "factor.machine.resistance = 0.06: at an end of the draw the entry is -0.2",
        ),
        ("departures = []\n", "must be a list of at least 1"),
    ],
)
def test_a_wrong_spread_is_said_to_be_wrong_where_it_is(tmp_path, text, words):
    with pytest.raises(InputError) as said:
        spread.load(written(tmp_path, text), schema())
    assert words in str(said.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("share = 2.0\nfaults = []\n", "share: 2 is out of range; 0 … 1"),
        ('share = 1.0\n[[faults]]\nname = "x"\nset = { open_phase = "d" }\nat = "open_phase_at"\n', "not a choice"),
        ('share = 1.0\n[[faults]]\nname = "x"\nset = {}\nat = "open_phas_at"\n', "did you mean 'open_phase_at'?"),
        (
            'share = 1.0\nwindow = [0.9, 0.1]\n[[faults]]\nname = "x"\nset = {}\nat = "link_sag_at"\n',
            "0 ≤ from < to ≤ 1",
        ),
        (
            'share = 1.0\n[[faults]]\nname = "x"\nset = { link_sag_at = 1.0 }\nat = "link_sag_at"\n',
            "set.link_sag_at: is drawn, as 'at' says; leave it out",
        ),
    ],
)
def test_wrong_faults_are_said_to_be_wrong_where_they_are(tmp_path, text, words):
    with pytest.raises(InputError) as said:
        faults.load(written(tmp_path, text), schema())
    assert words in str(said.value)


def test_the_duty_is_scaled_to_its_motor():
    native = core.load()
    known = core.parameters(native)
    found = {name: duty.of(profile.load("bench", schema(), known, name), schema(), known) for name in ("A", "B")}
    assert found["A"].torque == pytest.approx(1.5 * 4 * 0.16 * 10.8894)
    assert found["B"].torque == pytest.approx(1.5 * 4 * 0.0865 * 15.0)
    for each in found.values():
        run = each.run("case", 0.5)
        assert run.reached[0].window[1] < run.commands[1][0] < run.reached[1].window[0] - 2.0 * each.ramp
        assert run.load[-1][1] == pytest.approx(0.5 * each.torque)


# ---- how it is judged

TIME = np.arange(0.0, 1.0, 0.001)
ASKED = Run("case", "", 1.0, 3.0, ((0.0, "speed_ref_rpm", 100.0),), (), {}, {}, (Reached((0.5, 1.0), 10.0),))


def ended(*, speed=100.0, off=0.0, fault=None, until=None, reason="", unfinished=None):
    """A run whose true speed and true angle less the one in use (degrees) are constants, or (s, value) from then on."""

    def over(value):
        at, after = value if isinstance(value, tuple) else (0.0, value)
        return np.where(at <= TIME, after, 100.0 if value is speed else 0.0)

    signals = {"time": TIME, "true_speed": over(speed), "true_angle": np.radians(over(off)), "est_angle": 0.0 * TIME}
    if unfinished is not None:
        signals["est_angle"][unfinished] = math.nan
    if until is not None:
        signals = {name: data[until > TIME] for name, data in signals.items()}
    return SimpleNamespace(
        signals=signals, faults=[fault] if fault else [], reason=reason, completed=not (fault or reason), stats={}
    )


@pytest.mark.parametrize(
    ("result", "end", "off", "words"),
    [
        (ended(), End.GOOD, None, ""),
        (ended(off=59.0), End.GOOD, None, ""),
        (ended(speed=(0.3, 80.0)), End.FAILED, None, "the shaft turned at 80 rpm instead of 100; the drive ran on"),
        (ended(speed=math.nan), End.FAILED, None, "ran on"),
        (ended(off=(0.2, 180.0)), End.FAILED, None, "the rotor was 180° el. from where"),
        (ended(off=(0.2, 180.0), fault=(0.215, "lost")), End.FAILED, 0.015, "; lost"),
        (ended(off=(0.2, 180.0), fault=(0.3, "lost")), End.FAILED, 0.1, "; lost"),
        (ended(off=(0.2, 180.0), fault=(0.15, "lost"), until=0.16), End.REFUSED, None, "lost"),
        (ended(off=(0.2, 180.0), fault=(0.15, "lost")), End.REFUSED, None, "lost"),
        (ended(unfinished=149, fault=(0.15, "lost")), End.REFUSED, None, "lost"),
        (ended(unfinished=148, fault=(0.15, "lost")), End.FAILED, 0.002, "; lost"),
        (ended(until=0.0, reason="fault during the start: polarity"), End.REFUSED, None, "polarity"),
        (ended(until=0.0, reason="the start procedure took longer than 3 s"), End.FAILED, None, "took longer"),
        (ended(reason="the watchdog reset the chip"), End.FAILED, None, "the watchdog reset the chip"),
    ],
)
def test_the_true_shaft_and_who_was_first_decide(result, end, off, words):
    found = judged(result, ASKED)
    assert found.end is end
    assert found.off == (off if off is None else pytest.approx(off, abs=1e-9))
    assert words in found.words
    assert found.caught == (off is not None and off <= CAUGHT)


# ---- what a failure is shrunk to


def test_only_what_a_failure_needs_is_left_and_no_more_of_it_than_it_needs():
    rolls = random.Random(3)
    for _ in range(50):
        names = [f"d{k}" for k in range(rolls.randint(1, 12))]
        case = Case(5, {name: rolls.choice((-1, 1)) * rolls.uniform(1.0, 9.0) for name in names}, 77, "open", 0.4)
        needed = set(rolls.sample([*names, "fault", "noise"], k=rolls.randint(0, 3)) if len(names) > 1 else ["fault"])
        least = {name: rolls.uniform(0.05, 1.0) * abs(case.drawn[name]) for name in names if name in needed}

        def fails(other, needed=needed, least=least):
            return (
                ("fault" not in needed or other.fault == "open")
                and ("noise" not in needed or other.noise == 77)
                and all(abs(other.drawn.get(name, 0.0)) >= bound for name, bound in least.items())
            )

        found = shrink(case, fails)
        assert fails(found.case)
        assert set(found.case.drawn) == set(least)
        assert (found.case.fault is None) == ("fault" not in needed)
        assert (found.case.noise == PLAIN_NOISE) == ("noise" not in needed)
        assert all(abs(found.case.drawn[name]) < 2.0 * bound for name, bound in least.items())


# ---- numbers


def row(number, end, fault=None, off=None):
    return Row("A", Case(number, {"x": 1.5}, 9, fault, 0.3 if fault else 0.0), Verdict(end, "so", 0.2, off, 3.0))


def test_shares_are_of_what_they_are_said_to_be_of():
    rows = [row(1, End.GOOD), row(2, End.REFUSED), row(3, End.FAILED, off=0.01), row(4, End.FAILED, off=0.5)]
    rows += [row(5, End.REFUSED, "open"), row(6, End.GOOD, "open")]
    found = tally.tally(tally.plain(rows))
    assert (found.cases, found.run, found.failed, found.caught, found.refused) == (4, 3, 2, 1, 1)
    assert found.published()["failed_share"] == wilson.interval(2, 3)
    assert found.published()["refused_share"] == wilson.interval(1, 4)
    first, second = tally.lines(rows, ["A"])
    assert first.startswith(
        "A: 2 of 3 cases failed (20.8 to 93.9 % at 95 %), 1 of them off within 20 ms and in words; 1 of"
    )
    assert second.startswith(
        "A, with a fault: 0 of 1 case failed (0.0 to 79.3 % at 95 %); 1 of 2 ended by the drive in"
    )
    assert tally.lines(rows[1:2], ["A"]) == ["A: no case ran; 1 of 1 refused (20.7 to 100.0 % at 95 %)"]


def test_a_motor_that_the_drive_cannot_be_set_up_for_is_refused_beside_others_and_bad_input_alone(tmp_path):
    nameplate = resources.find("motors", "A").read_text()
    light = written(tmp_path, nameplate.replace("inertia = 0.00455", "inertia = 2e-6"), "light.toml")
    first, second = units.nominal(units.Wish(["A", light], 1))
    assert not first.refusal
    assert "inertia, which follows from its file: 2e-06 kgm2 is out of range" in second.refusal
    with pytest.raises(InputError, match="2e-06 kgm2 is out of range"):
        units.nominal(units.Wish([light], 1))
    with pytest.raises(InputError, match="two of them are called A"):
        units.nominal(units.Wish(["A", written(tmp_path, nameplate, "A.toml")], 1))
    (own,) = units.nominal(units.Wish(["compressor_12a"], 1))
    assert (own.profile, first.profile) == ("compressor_12a", "bench")


def test_a_file_goes_on_behind_its_last_whole_line_and_only_for_its_own_campaign(tmp_path):
    file = tmp_path / "c.jsonl"
    about = {"seed": 1, "units": {"A": "x"}}
    first = Results(file, about, False)
    rows = [row(1, End.GOOD), row(2, End.FAILED, "open", 0.01)]
    for each in rows:
        first.add(each)
    with file.open("a") as behind:
        behind.write('{"motor": "A", "num')
    again = Results(file, about, True)
    assert list(again.rows.values()) == rows
    again.add(row(3, End.GOOD))
    assert list(Results(file, about, True).rows) == [("A", 1), ("A", 2), ("A", 3)]
    with pytest.raises(InputError, match="is there already; go on with it by --resume"):
        Results(file, about, False)
    with pytest.raises(InputError, match="of another campaign: seed was 1, now 2"):
        Results(file, {**about, "seed": 2}, True)
    with pytest.raises(InputError, match="--resume: goes on with the file of --json"):
        Results(None, about, True)
    file.write_text("[1]\n")
    with pytest.raises(InputError, match="holds no cases"):
        Results(file, about, True)


# ---- the command


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
    with (tmp_path / "r/cases.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
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
    # Without saliency the start's test says that it cannot tell the polarity.
    words += ["--motors", "A,B-SPM", "--json", "c.jsonl"]
    done = call(*words)
    found = json.loads((tmp_path / "r/metrics.json").read_text())
    assert done.exit_code == 1, done.output
    assert (found["motors"]["A"]["plain"]["good"], found["motors"]["B-SPM"]["plain"]["refused"]) == (1, 1)
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
