"""The type test of a motor: what is asked of it in its own measure, how it is judged, and what is left behind."""

import functools
import json
import math
from dataclasses import dataclass, replace

import pytest
from typer.testing import CliRunner

from stillspin import cli, core, csv_table
from stillspin.campaign import units
from stillspin.campaign.judge import End, Verdict
from stillspin.cases import profile
from stillspin.cases.motor_told import Motor
from stillspin.commands import type_test
from stillspin.drive import own
from stillspin.runs.commission import Result, Value
from stillspin.type_test import carry_out, duties, findings, ratings
from stillspin.type_test.carry_out import Row
from stillspin.type_test.duties import FLYING, LOAD, REST, REVERSAL, SLOW, START, WEAKENING, Duty

native = pytest.importorskip("stillspin._core", reason="the native module is not built")
FIRMWARE = functools.cache(own.firmware)


DEFAULT = {
    "voltage_use": 100.0, "start_method": 0.0, "if_speed": 0.0, "saliency_current": 0.0, "current_limit": 15.0,
    "inductance_d": 4.0, "inductance_q": 5.0, "map_current": 15.0, "ldd_4": 100.0, "lqq_4": 100.0,
}  # fmt: skip


@dataclass(frozen=True)
class Size:
    """A machine of round numbers on 100 V at the phase, with a drive that takes all of it."""

    machine: dict
    parameters: dict

    def plant(self, section, key):
        return {**self.machine, "source_voltage": 100.0 * math.sqrt(3.0), "cogging_torque": 0.1, "saturation": True}[
            key
        ]

    def told(self, name):
        return {**DEFAULT, **self.parameters}[name]


ROUND = Size(
    {
        "pole_pairs": 2.0,
        "magnet_flux": 0.1,
        "rated_peak_current": 10.0,
        "resistance": 0.5,
        "inductance_d": 4e-3,
        "inductance_q": 5e-3,
        "inertia": 1e-3,
    },
    {"speed_limit": 1e5, "speed_ramp": 1e5, "weakening_limit": 15.0},
)


def told(size, **parameters):
    return ratings.of(replace(size, parameters={**size.parameters, **parameters}))


def of_file(name):
    known = core.parameters(native)
    schema = core.plant_schema(native)
    chosen = profile.load("bench", schema, known, name)
    return ratings.of(Motor(chosen, schema, core.at_scale(known, chosen.parameters)))


def test_the_rated_speed_is_nine_tenths_of_what_the_voltage_allows_at_the_rated_current():
    rated = told(ROUND)
    electrical = rated.speed / 0.9 * math.pi / 30.0 * 2.0
    assert math.hypot(0.5 * 10.0 + electrical * 0.1, electrical * 5e-3 * 10.0) == pytest.approx(100.0)
    assert rated.torque == pytest.approx(1.5 * 2.0 * 0.1 * 10.0)
    assert rated.run_up == pytest.approx(1e-3 * rated.speed * math.pi / 30.0 / 3.0)
    assert rated.electrical == pytest.approx(0.01)
    assert rated.fastest == pytest.approx(0.9 * 100.0 / (0.1 - 4e-3 * 15.0) / 2.0 * 30.0 / math.pi)
    assert rated.ramp == pytest.approx(0.5 * 3.0 / 1e-3 * 30.0 / math.pi)


def test_no_rating_is_beyond_what_the_drive_is_told():
    rated = told(ROUND, speed_limit=100.0, speed_ramp=50.0)
    assert (rated.speed, rated.fastest, rated.ramp) == (100.0, 100.0, 50.0)


def test_all_that_the_book_lists_is_asked_of_a_motor():
    asked = list(duties.duties(of_file("A")))
    kinds = {kind: [duty for duty in asked if duty.kind == kind] for kind in duties.DUTIES}
    starts = kinds[START]
    assert len(starts) == 24 * 2 * 3
    assert len({(duty.run.plant["initial"]["angle"], duty.run.commands[0][2] > 0.0) for duty in starts}) == 24 * 2
    assert [duty.of for duty in kinds[SLOW]] == ["0.5 %", "5 %"]
    assert [duty.of for duty in kinds[LOAD]] == ["0 %", "10 %", "50 %", "100 %"]
    assert [len(kinds[kind]) for kind in (REVERSAL, FLYING, REST)] == [1, 8, 1]
    assert kinds[REST][0].run.duration == 30.0


def test_a_run_ends_when_its_last_window_does_and_every_load_comes_in_the_machines_own_time():
    rated = of_file("A")
    for duty in duties.duties(rated, duties.FEW):
        run = duty.run
        assert all(0.0 <= check.window[0] < check.window[1] <= run.duration for check in run.reached), duty
        if duty.kind in (SLOW, LOAD):
            (begin, _), (there, torque), (gone, _), (end, _) = run.load
            assert there - begin == pytest.approx(rated.run_up + rated.electrical, abs=2e-4)
            assert torque == pytest.approx(rated.torque)
            assert there < run.reached[0].window[0] < run.reached[0].window[1] <= gone < end


def test_where_nothing_shows_the_angle_at_rest_nothing_is_asked_below_the_vectors_speed():
    rated = of_file("B-SPM")
    asked = list(duties.duties(rated))
    assert rated.slowest > 0.05 * rated.speed, "else this motor shows nothing"
    assert not [duty for duty in asked if duty.kind in (SLOW, REST)]
    assert all(abs(command[2]) >= rated.slowest for duty in asked for command in duty.run.commands)
    assert not any(duty.run.load for duty in asked if duty.kind == START)


def test_a_vector_is_told_which_way_to_turn_the_shaft_when_it_starts():
    # Told later it has turned the shaft forwards by then: no start would be a backward one.
    starts = [duty for duty in duties.duties(of_file("B-SPM"), 2) if duty.kind == duties.START]
    assert {duty.run.commands[0][0] for duty in starts} == {0.0}
    assert {duty.run.commands[0][2] > 0.0 for duty in starts} == {True, False}


def test_a_shaft_is_held_at_its_start_where_saturation_tells_the_polarity():
    for saturates in (True, False):
        asked = duties.duties(replace(told(ROUND), saturates=saturates))
        held = [duty for duty in asked if duty.run.plant.get("mechanics", {}).get("brake_until_run")]
        assert bool(held) == saturates


def test_where_the_saliency_ends_the_load_is_what_the_drive_gives_there():
    rated = told(ROUND, saliency_current=5.0)
    # The speed at which the EMF is a sixth of what the saliency, a ninth, leaves of the link.
    even = 100.0 * math.sqrt(3.0) / 9.0 / 6.0 / 0.1 / 2.0 * 30.0 / math.pi
    assert rated.even == pytest.approx(even)
    assert rated.freed == pytest.approx(2.0 * even)
    # Four fifths of what is given at four fifths of the speed: 5 A, 5 A, 7 A, all
    loads = [rated.load_at(share * even) for share in (0.0, -1.25, 1.5, 2.6)]
    assert loads == pytest.approx([1.2, 1.2, 1.68, rated.torque])
    assert told(ROUND).load_at(0.0) == rated.torque
    (slow,) = [duty for duty in duties.duties(rated) if (duty.kind, duty.of) == (LOAD, "0 %")]
    assert (slow.load, slow.run.load[1][1]) == pytest.approx((0.4, 1.2))
    # A map that ends at 4.5 mH: by 13.5 A they are 2.5 mH, and the EMF balances that at 7.8 times the speed.
    ended = told(ROUND, saliency_current=5.0, map_current=5.0, lqq_4=90.0, current_limit=15.0)
    assert ended.freed == pytest.approx(4.0 / 3.0 * 54.0 * even * math.sqrt((4.5 / 4.0 - 1.0) * (1.0 - 2.5 / 4.0)))


@pytest.mark.parametrize(("motor", "of"), [("vehicle_35kw", "-5 %"), ("vehicle_35kw", "+5 %"), ("servo_48v", "-100 %")])
def test_a_shaft_that_turns_already_is_taken_over_with_its_polarity(motor, of):
    """A heavy one whose EMF is too small to be seen, and one without saliency."""
    (unit,) = units.nominal(units.Wish([motor], 1))
    (duty,) = [duty for duty in carry_out.asked(unit, 1) if (duty.kind, duty.of) == (FLYING, of)]
    found = carry_out.verdict(unit, duty)
    assert found.end is End.GOOD, found.words
    assert found.error < 10.0


def test_field_weakening_is_asked_for_where_the_drive_may_go_a_tenth_beyond_the_rated_speed():
    for limit, is_asked in ((1.05, False), (1.2, True)):
        rated = told(ROUND)
        rated = told(ROUND, speed_limit=limit * rated.speed)
        assert any(duty.kind == WEAKENING for duty in duties.duties(rated)) == is_asked


def row(kind, of, end, words="", error=None):
    (some,) = [duty for duty in duties.duties(of_file("A"), 1) if duty.kind == REVERSAL]
    return Row("A", Duty(kind, of, some.run), Verdict(end, words, error=error))


def test_a_kind_says_what_went_wrong_before_what_was_refused_and_else_the_largest_error():
    wrong = row(START, "30°", End.FAILED, "lost")
    refused = row(START, "15°", End.REFUSED, "no")
    well = [row(START, "0°", End.GOOD, error=2.0), row(START, "45°", End.GOOD, error=3.14)]
    kind = findings.kind_of(START, [refused, *well, wrong])
    assert (kind.runs, kind.good, kind.refused, kind.failed, kind.error) == (4, 2, 1, 1, 3.14)
    assert (kind.words(), kind.first) == ("1 of 4 failed", "30°: lost")
    assert findings.kind_of(START, [*well, refused]).words() == "1 of 3 refused"
    assert findings.kind_of(START, well).words() == "3.1°"


@pytest.fixture
def call(tmp_path, monkeypatch):
    """Calls the command line in an empty directory."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(type_test, "firmware", FIRMWARE)
    return lambda *words: CliRunner().invoke(cli.app, ["type-test", *map(str, words)])


def only(monkeypatch, *kinds, change=lambda run: run):
    """Of all duties those of some kinds, and of the starts the first."""
    whole = duties.duties

    def some(rated, angles):
        chosen = [duty for duty in whole(rated, 1) if duty.kind in kinds]
        return [replace(duty, run=change(duty.run)) for duty in chosen]

    monkeypatch.setattr(carry_out.duties, "duties", some)


def test_a_motor_that_does_what_is_asked_of_it(call, monkeypatch, tmp_path):
    only(monkeypatch, START, FLYING)
    done = call("A", "--profile", "ideal", "--few", "--jobs", 1, "--out", "r", "--junit", "j.xml")
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "r/metrics.json").read_text(encoding="utf-8"))["motors"]["A"]
    assert {name: (kind["runs"], kind["good"]) for name, kind in found["duties"].items()} == {
        START: (2, 2),
        FLYING: (8, 8),
    }
    assert all(0.0 <= kind["angle_error_deg"] < 10.0 for kind in found["duties"].values())
    about, rows = csv_table.read(tmp_path / "r/duties.csv")
    assert about["firmware"] == own.firmware()
    assert [each["end"] for each in rows] == ["good"] * 10
    assert 'tests="10"' in (tmp_path / "j.xml").read_text(encoding="utf-8")


def test_what_goes_wrong_is_said_and_the_exit_status_is_1(call, monkeypatch, tmp_path):
    def twice(run):
        (check,) = run.reached
        return replace(run, reached=(replace(check, speed=2.0 * check.speed),))

    only(monkeypatch, FLYING, change=twice)
    done = call("A", "--profile", "ideal", "--jobs", 1, "--out", "r")
    assert done.exit_code == 1, done.output
    assert "A, flying start, -100 %: failed: the shaft turned at" in done.stderr
    found = json.loads((tmp_path / "r/metrics.json").read_text(encoding="utf-8"))["motors"]["A"]["duties"][FLYING]
    assert (found["failed"], found["words"]) == (8, "8 of 8 failed")


def test_values_are_compared_with_the_true_machine_in_the_drives_units():
    (unit,) = units.nominal(units.Wish(["A"], 1, "ideal"))
    machine = {"stator_resistance": 0.32, "inductance_d": 4.9, "inductance_q": 7.8, "magnet_flux": 0.16}
    values = tuple(Value(name, "", 8, 0.0, 1.1 * value, True, "") for name, value in machine.items())
    found = findings.of(unit, Result(values, 30.0), [])
    assert found.errors == pytest.approx(dict.fromkeys(machine, 0.1), abs=1e-4)
    assert (found.values, found.seconds) == ((4, 4), 30.0)
