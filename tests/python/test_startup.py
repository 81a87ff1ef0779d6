"""The start-up matrix: a representative part of it on the virtual drive, and what it says about itself."""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from stillspin import core, csv_table
from stillspin.drive import own
from stillspin.errors import InputError
from stillspin.runs import startup
from stillspin.runs.workers import Where

pytest.importorskip("stillspin._core", reason="the native module is not built")


def call(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "stillspin", "startup-matrix", "--quick", *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, str]]:
    """The quick part of the matrix in profile bench, case by case."""
    out = tmp_path_factory.mktemp("startup") / "out"
    done = call("--out", str(out))
    assert done.returncode in {0, 1}, done.stderr
    about, rows = csv_table.read(out / "startup.csv")
    metrics = json.loads((out / "metrics.json").read_text())
    assert metrics["starts"] == len(rows)
    assert metrics["firmware"] == about["firmware"] == own.firmware()
    assert metrics["failed"] == sum(1 for row in rows if row["problem"])
    assert (done.returncode == 1) == (metrics["failed"] > 0)
    assert (out / "startup.svg").stat().st_size > 10_000
    return rows


def test_no_start_is_lost_and_none_ends_at_a_wrong_angle(table: list[dict[str, str]]) -> None:
    lost = [row for row in table if row["problem"] and "backwards" not in row["problem"]]
    assert not lost, lost[:3]
    assert max(abs(float(row["angle_error_deg"])) for row in table) < 5.0
    # Too good would mean that the plant's flaws are gone.
    assert max(abs(float(row["angle_error_deg"])) for row in table) > 0.3


def test_motion_backwards_stays_below_two_degrees(table: list[dict[str, str]]) -> None:
    """Also with a magnet 30 % weaker than told, when all torque is 30 % short, and a rotor 30 % lighter."""
    for row in table:
        assert float(row["backward_deg"]) < startup.BACKWARD_LIMIT, row
    assert max(float(row["backward_deg"]) for row in table if row["way"] == "brake") > 0.3


def test_half_the_rated_load_falls_on_the_shaft_at_every_angle() -> None:
    """Against the direction, with what makes the hold's loop swing (J -30%, flux +30%) or weak (flux -30%).

    Told 30 % too little flux, the hold lets 1 % of 1440 starts (30 seeds) go beyond the limit of 2 degrees, 2.24 at
    most: of the 144 here, six or more are not this rate (1 in 250). Their mean, 1.34, has a standard error of 0.017
    with as many: that a start goes farther back by a twentieth is seen in it.
    """
    common, _ = startup.bench("bench")
    todo = [
        case
        for case in startup.cases(3, quick=False, linear=False)
        if case.way == "brake"
        and case.load == 0.5 * startup.RATED_TORQUE * case.direction
        and case.error in {"flux -30%", "flux +30%", "J -30%"}
    ]
    assert len(todo) == 24 * 2 * 3 * 3
    outcomes = startup.run_all(common, todo, Where(2), lambda _: None)
    assert not [item for item in outcomes if item.problem and "backwards" not in item.problem]
    weak = [item.backward for item in outcomes if item.case.error == "flux -30%"]
    assert sum(each > startup.BACKWARD_LIMIT for each in weak) < 6
    assert max(weak) < 2.5
    assert sum(weak) / len(weak) < 1.41
    swinging = [item.backward for item in outcomes if item.case.error != "flux -30%"]
    assert max(swinging) < 1.5


def test_polarity_is_told_with_confidence(table: list[dict[str, str]]) -> None:
    """Saturation answers from 5 standard errors on; a rotor at 60 rpm turns 60 degrees, 4 times the EMF's error."""
    standing = [float(row["sigma"]) for row in table if row["way"] != "flying"]
    assert min(standing) >= 5.0 and max(standing) < 16.0
    assert min(float(row["sigma"]) for row in table if row["way"] == "flying") > 3.0


def test_a_free_shaft_of_a_linear_machine_is_told_by_motion() -> None:
    common, linear = startup.bench("ideal")
    assert linear
    for angle in (20.0, 110.0, 200.0, 290.0):
        outcome = startup.run(common, startup.Case("free", angle, 1, 0.0, "none", 1))
        assert outcome.problem is None, outcome


def test_a_held_shaft_of_a_linear_machine_is_a_fault_and_not_a_guess() -> None:
    common, _ = startup.bench("ideal")
    outcome = startup.run(common, startup.Case("brake", 40.0, 1, 0.0, "none", 1))
    assert outcome.problem is not None
    assert "polarity" in outcome.problem


def run_reversed(speed: float) -> core.NativeResult:
    """A drive that was told the slopes of saturation with the wrong sign, and so takes the wrong half turn."""
    common, _ = startup.bench("bench")
    wrong = {name: -value if name.startswith("ldq") else value for name, value in common.parameters.items()}
    return core.load().run(
        plant=common.plant,
        parameters=wrong,
        commands=[(0.0, "speed_ref_rpm", speed)],
        load=[],
        duration=0.2,
        max_start=2.0,
        record_every=1,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )


@pytest.mark.parametrize("speed", [300.0, -1000.0])
def test_a_wrong_polarity_is_found_once_the_shaft_turns(speed: float) -> None:
    result = run_reversed(speed)
    assert not result.completed
    assert "polarity" in result.faults[0][1]
    assert result.faults[0][0] < 0.06


def test_the_full_matrix_has_every_combination() -> None:
    count = Counter(case.way for case in startup.cases(3, quick=False, linear=False))
    assert count["brake"] == 24 * 2 * 5 * len(startup.ERRORS) * 3
    assert count["free"] == 24 * 2 * len(startup.ERRORS) * 3
    assert count["flying"] == 8 * len(startup.FLYING) * len(startup.ERRORS) * 3
    assert not any(case.way == "brake" for case in startup.cases(3, quick=False, linear=True))


def test_a_way_that_does_not_exist_is_said(tmp_path: Path) -> None:
    done = call("--way", "fly", "--out", str(tmp_path / "out"))
    assert done.returncode == 2
    assert "flying" in done.stderr
    with pytest.raises(InputError, match="saturation"):
        startup.chosen(startup.cases(1, quick=True, linear=True), ["brake"])
