"""Campaigns: what is drawn, how a case is judged, what a failure is shrunk to, and what is counted."""

import math
import random
from types import SimpleNamespace

import numpy as np
import pytest
from campaign_files import HARMLESS, HEAVY, schema, written

from stillspin import core, resources, wilson
from stillspin.campaign import duty, faults, spread, tally, units
from stillspin.campaign.draw import PLAIN_NOISE, Case, Drawer
from stillspin.campaign.judge import CAUGHT, End, Verdict, judged
from stillspin.campaign.results import Results, Row
from stillspin.campaign.shrink import shrink
from stillspin.cases import profile
from stillspin.cases.scenario import Reached, Run
from stillspin.errors import InputError

pytest.importorskip("stillspin._core", reason="the native module is not built")


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
START, RUN = 3, 4  # firmware/interfaces/state.h
ASKED = Run("case", "", 1.0, 3.0, ((0.0, "speed_ref_rpm", 100.0),), (), {}, {}, (Reached((0.5, 1.0), 10.0),))


def ended(*, speed=100.0, off=0.0, fault=None, until=None, reason="", unfinished=None, state=RUN):
    """A run whose true speed and true angle less the one in use (degrees) are constants, or (s, value) from then on."""

    def over(value):
        at, after = value if isinstance(value, tuple) else (0.0, value)
        return np.where(at <= TIME, after, 100.0 if value is speed else 0.0)

    signals = {"time": TIME, "true_speed": over(speed), "true_angle": np.radians(over(off)), "est_angle": 0.0 * TIME}
    signals["state"] = state + 0.0 * TIME
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
        (ended(unfinished=148), End.FAILED, None, "the drive had no angle"),
        (ended(unfinished=148, state=START), End.GOOD, None, ""),  # a vector turns the rotor, and the drive says so
        (ended(off=180.0, state=START), End.FAILED, None, "the rotor was 180° el. from where"),
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


def test_a_speed_may_be_judged_by_its_mean():
    def shaken(time):
        return 100.0 + 15.0 * np.sin(2.0 * np.pi * 50.0 * time)

    time = ended().signals["time"]
    shaking = ended()
    shaking.signals["true_speed"] = shaken(time)
    assert judged(shaking, ASKED).end is End.FAILED
    assert judged(shaking, ASKED, 0.1).end is End.GOOD
    shaking.signals["true_speed"] = shaken(time) + 12.0
    assert judged(shaking, ASKED, 0.1).end is End.FAILED


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


def test_a_file_is_the_same_whichever_case_was_done_first(tmp_path):
    rows = [row(number, End.GOOD) for number in (1, 2, 10)]
    for name, done in (("here", rows), ("there", [rows[2], rows[0], rows[1]])):
        kept = Results(tmp_path / name, {"seed": 1}, False)
        for each in done:
            kept.add(each)
        kept.put_in_order()
    assert (tmp_path / "there").read_bytes() == (tmp_path / "here").read_bytes()
    assert list(Results(tmp_path / "there", {"seed": 1}, True).rows.values()) == rows
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "there")
    kept = Results(link, {"seed": 1}, True)
    kept.add(row(3, End.GOOD))
    kept.put_in_order()
    assert link.is_symlink(), "it goes on where it is"
