"""From standstill to 3000 rpm and back, from initial angles that are drawn."""

import json
import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from stillspin import cli, wilson
from stillspin.commands import round_trips
from stillspin.drive.own import firmware
from stillspin.runs import records

pytest.importorskip("stillspin._core", reason="the native module is not built")


def call(out: Path, *words: str):
    return CliRunner().invoke(cli.app, ["round-trips", "--profile", "ideal", "--out", str(out), *words])


def test_the_seed_draws_the_angles_and_the_directions_take_turns():
    first, again, other = (round_trips.trips(40, seed) for seed in (1, 1, 2))
    angles = [run.plant["initial"]["angle"] for run in first.runs]
    assert first == again
    assert angles != [run.plant["initial"]["angle"] for run in other.runs]
    assert all(0.0 <= angle <= 2.0 * math.pi for angle in angles)
    assert {int(angle // (math.pi / 2.0)) for angle in angles} == {0, 1, 2, 3}  # none of the quarters is left out
    there = [run.commands[0][2] for run in first.runs]
    assert there == [3000.0, -3000.0] * 20


def test_more_trips_begin_with_those_of_fewer():
    assert round_trips.trips(5, 3).runs == round_trips.trips(9, 3).runs[:5]


@pytest.mark.parametrize(("lost", "count"), [(0, 50), (1, 50), (7, 20), (20, 20)])
def test_the_interval_is_where_the_count_is_196_deviations_off(lost, count):
    """Wilson's ends solve (lost/n − p)² = 1.96² p (1 − p)/n."""
    low, high = (end / 100.0 for end in wilson.interval(lost, count))
    assert 0.0 <= low < high <= 1.0
    assert low - 1e-12 <= lost / count <= high + 1e-12
    for end in (low, high):
        assert (lost / count - end) ** 2 == pytest.approx(1.96**2 * end * (1.0 - end) / count, abs=1e-12)


def test_the_papers_scheme_goes_and_comes_back_both_ways(tmp_path):
    out = tmp_path / "r"
    done = call(out, "--runs", "2", "--scheme", "paper", "--junit", str(tmp_path / "j.xml"))
    assert done.exit_code == 0, done.output
    assert "0 of 2 trips lost (0.0 to 65.8 % at 95 %)" in done.stdout
    found = json.loads((out / "trips.json").read_text())
    assert found["firmware"] == firmware()
    assert (found["trips"], found["lost"]) == (2, [])
    assert 0.5 < found["position_error_peak"] < 20.0  # the hybrid's: the observer stays below half a degree
    cases = list(ET.parse(tmp_path / "j.xml").getroot().iter("testcase"))
    assert cases and not any(len(case) for case in cases)
    for number, sign in ((1, 1.0), (2, -1.0)):
        record = records.read(out / "runs" / f"round-trips-trip_{number}.parquet")
        assert np.max(sign * record.signals["true_speed"]) == pytest.approx(3000.0, abs=75.0)
        drawn = round_trips.trips(2, 1).runs[number - 1].plant
        assert record.about["plant"]["initial"]["angle"] == drawn["initial"]["angle"]


def test_a_lost_trip_is_said_and_counts_against_what_may_be_lost(tmp_path):
    words = ("--runs", "1", "--scheme", "paper", "--set", "mechanics.inertia=0.05")
    done = call(tmp_path / "r", *words)
    assert done.exit_code == 1, done.output
    assert "1 of 1 trip lost" in done.stdout
    assert "trip_1" in done.stderr
    found = json.loads((tmp_path / "r" / "trips.json").read_text())
    assert [each["trip"] for each in found["lost"]] == ["trip_1"]
    assert found["position_error_peak"] is None
    assert call(tmp_path / "r", *words, "--may-lose", "1").exit_code == 0
