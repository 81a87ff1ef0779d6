"""The drive itself: scenarios of the virtual drive, run through the command line as a user runs them.

In profile `ideal` nothing but 12-bit quantisation disturbs, so the paper's errors are bounds that must hold with room.
In `bench` the drive commissions itself and then has to meet the goals; on nameplate parameters the bounds are what it
does today, with a margin for a change of the noise, and are to be tightened, never widened. Every bound has a floor as
well: a figure that is too good means that the plant was made kinder.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile
from stillspin.runs import variant

pytest.importorskip("stillspin._core", reason="the native module is not built")

Figures = dict[str, dict[str, dict[str, float | None]]]
Bounds = dict[tuple[str, str], tuple[float, float]]

# scenario, figure: smallest and largest value that is credible
IDEAL = {
    ("A09", "id_3_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_minus_5_deviation_gain_error"): (0.0, 5.0),
    ("A09", "deviation_distortion"): (1.0, 20.0),
    ("A09", "deviation_wrong_polarity"): (0.0, 0.0),
    ("A12", "svpwm_thd"): (5.0, 25.0),
    ("A12", "hysteresis_thd"): (
        5.0,
        25.0,
    ),  # lower than with SVPWM: no dead time, and vectors extended to 20 us
    ("A12", "switching_frequency_ratio"): (0.98, 1.02),
    ("A13", "pattern_mismatch"): (0.0, 0.0),
    ("A13", "pattern_voltage_error"): (0.1, 1.0),
    ("A10", "position_error_peak"): (0.01, 0.5),
    ("A10", "speed_ripple"): (0.05, 1.0),
    ("A11", "position_error_peak"): (0.01, 1.0),
    ("A11", "ramp_position_error_peak"): (0.02, 2.0),
    ("A11", "step_position_error_peak"): (0.1, 6.0),
    ("A15", "transition_position_error_peak"): (0.02, 2.0),
    ("A15", "steady_position_error_peak"): (0.02, 1.0),
    ("A16", "position_error_peak"): (0.05, 1.5),
    ("A17", "load_1nm_position_error_peak"): (0.05, 1.2),
    ("A17", "load_4nm_position_error_peak"): (0.05, 1.8),
    ("A18a", "overshoot"): (0.0, 1.0),
    ("A18b", "dip"): (5.0, 60.0),
    ("A18c", "speed_error_share"): (0.0, 2.0),
    ("A18c", "loaded_3000_position_error_peak"): (0.1, 3.0),
}
# On commissioned parameters: from the noise's floor to the goal, and where that is short, to what the drive does today.
BENCH = {
    ("A09", "id_3_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_5_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_8_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_minus_5_deviation_gain_error"): (0.0, 5.0),
    ("A09", "deviation_wrong_polarity"): (0.0, 0.0),
    ("A12", "svpwm_thd"): (5.0, 25.0),
    ("A12", "thd_ratio"): (0.5, 1.0),
    ("A12", "switching_frequency_ratio"): (0.98, 1.02),
    ("A13", "pattern_mismatch"): (0.0, 0.0),
    ("A13", "pattern_voltage_error"): (0.1, 1.0),
    ("A10", "position_error_peak"): (0.1, 0.8),
    ("A10", "position_error_rms"): (0.05, 0.3),
    ("A10", "speed_ripple"): (0.3, 0.8),
    ("A11", "position_error_peak"): (0.2, 1.5),
    ("A11", "position_error_rms"): (0.05, 0.6),
    ("A11", "ramp_position_error_peak"): (0.5, 3.0),
    ("A11", "step_position_error_peak"): (1.0, 6.0),
    ("A11", "step_recovered_position_error_peak"): (0.1, 1.5),
    ("A11", "held_position_drift"): (0.2, 12.0),
    ("A15", "transition_position_error_peak"): (0.2, 3.0),
    ("A15", "steady_position_error_peak"): (0.2, 1.5),
    ("A16", "position_error_peak"): (0.2, 2.5),
    ("A17", "load_1nm_position_error_peak"): (0.2, 1.2),
    ("A17", "load_4nm_position_error_peak"): (0.2, 1.8),
    ("A18a", "overshoot"): (0.05, 1.0),
    ("A18b", "dip"): (10.0, 35.0),
    ("A18c", "speed_error_share"): (0.01, 2.0),
    ("A18c", "loaded_3000_position_error_peak"): (0.2, 2.0),
    ("A18c", "loaded_3000_speed_error_share"): (0.0, 2.0),
}
NAMEPLATE = {
    ("A09", "id_3_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_5_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_8_deviation_gain_error"): (0.0, 5.0),
    ("A09", "id_minus_5_deviation_gain_error"): (0.0, 5.0),
    ("A09", "deviation_distortion"): (2.0, 25.0),
    ("A09", "deviation_wrong_polarity"): (0.0, 0.0),
    ("A12", "svpwm_thd"): (5.0, 25.0),
    ("A12", "thd_ratio"): (0.5, 1.0),
    ("A12", "switching_frequency_ratio"): (0.98, 1.02),
    ("A13", "pattern_mismatch"): (0.0, 0.0),
    ("A13", "pattern_voltage_error"): (0.1, 1.0),
    ("A10", "position_error_peak"): (0.1, 2.0),
    ("A10", "position_error_rms"): (0.05, 0.6),
    ("A11", "step_position_error_peak"): (0.3, 6.0),
    ("A15", "transition_position_error_peak"): (0.2, 3.0),
    ("A15", "steady_position_error_peak"): (0.2, 2.0),
    ("A16", "position_error_peak"): (0.5, 4.0),
    ("A18b", "dip"): (10.0, 60.0),
    ("A18c", "loaded_3000_position_error_peak"): (0.2, 6.0),
    ("A18c", "loaded_3000_speed_error_share"): (0.0, 2.0),
}
# Motor B in both profiles: smallest credible value; the largest is the scenario's own goal.
MOTOR_B = {
    ("B18", "pp02_position_error_peak"): 0.005,
    ("B22", "position_error_peak"): 0.3,
    ("B23", "minus_10_detection_error"): 0.01,
    ("B23", "minus_20_detection_error"): 0.01,
}


def stillspin(*words: str) -> subprocess.CompletedProcess[str]:
    """The command line in a process of its own."""
    command = [sys.executable, "-m", "stillspin", *words]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)


@pytest.fixture(scope="module", params=["ideal", "bench"])
def campaign(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of all scenarios with bounds, once in each profile."""
    out = tmp_path_factory.mktemp("campaign") / request.param
    ids = sorted({scenario for scenario, _ in IDEAL})
    done = stillspin(
        "reproduce",
        *ids,
        "--profile",
        request.param,
        "--no-paper-scheme",
        "--out",
        str(out),
    )
    assert ", 0 runs broken off" in done.stdout, f"a run broke off:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    assert done.returncode == (1 if missed(figures(out / "metrics.json")) else 0)
    assert json.loads((out / "metrics.json").read_text())["profile"] == request.param
    return out


def figures(file: Path) -> Figures:
    """The figures of a file of results."""
    found: Figures = json.loads(file.read_text())["scenarios"]
    return found


def missed(scenarios: Figures) -> list[str]:
    """The figures that do not meet their goals."""
    rows = [(f"{key} {name}", one["value"], one["goal"]) for key, row in scenarios.items() for name, one in row.items()]
    return [name for name, value, goal in rows if goal is not None and (value is None or value > goal)]


def beyond(scenarios: Figures, bounds: Bounds) -> str:
    """What lies outside of its bounds, in words."""
    wrong = []
    for (scenario, figure), (low, high) in bounds.items():
        value = scenarios[scenario][figure]["value"]
        if value is None or not low <= value <= high:
            wrong.append(f"{scenario} {figure} = {value}, expected {low} … {high}")
    return "\n".join(wrong)


def test_figures_lie_within_their_bounds(campaign: Path) -> None:
    ideal = campaign.name == "ideal"
    assert not beyond(figures(campaign / "metrics.json"), IDEAL if ideal else BENCH)
    assert (campaign / "nameplate.json").exists() != ideal
    if not ideal:
        assert not beyond(figures(campaign / "nameplate.json"), NAMEPLATE)


@pytest.mark.parametrize("name", ["ideal", "bench"])
def test_motor_b_meets_its_goals(tmp_path: Path, name: str) -> None:
    """PP-02 at speed under load, what (36) and what (37) learn: the shortest of the scenarios on motor B."""
    ids = sorted({scenario for scenario, _ in MOTOR_B})
    words = [
        "--profile",
        name,
        "--no-paper-scheme",
        "--no-nameplate",
        "--out",
        str(tmp_path / "out"),
    ]
    done = stillspin("reproduce", *ids, *words)
    assert done.returncode == 0, f"a run broke off:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    found = figures(tmp_path / "out" / "metrics.json")
    goals = {(scenario, name): one["goal"] for scenario, row in found.items() for name, one in row.items()}
    committed = {key: goal for key, goal in goals.items() if goal is not None}
    assert committed.keys() == MOTOR_B.keys()  # whatever has a goal has a bound
    assert not beyond(found, {key: (low, committed[key]) for key, low in MOTOR_B.items()})


def test_the_predictive_controller_beats_pi(campaign: Path) -> None:
    scenarios = figures(campaign / "metrics.json")
    assert (scenarios["A18a"]["overshoot"]["value"] or 0.0) < (scenarios["A18a"]["pi_overshoot"]["value"] or 0.0)
    assert (scenarios["A18b"]["dip"]["value"] or 0.0) < (scenarios["A18b"]["pi_dip"]["value"] or 0.0)


def records(out: Path) -> dict[str, bytes]:
    """The recorded runs of a result directory, by name."""
    return {path.name: path.read_bytes() for path in sorted(out.rglob("*.parquet"))}


def test_same_seed_same_bytes_other_seed_other_bytes(tmp_path: Path) -> None:
    for name, seed in (("first", "3"), ("again", "3"), ("other", "4")):
        done = stillspin("run", "A17", "--seed", seed, "--no-plots", "--out", str(tmp_path / name))
        assert done.returncode == 0, done.stderr
    first, again, other = (records(tmp_path / name) for name in ("first", "again", "other"))
    assert first
    assert first == again
    assert first != other


@pytest.mark.parametrize("source", [0, 3, 4])
def test_every_full_speed_source_reverses_in_the_ideal_profile(tmp_path: Path, source: int) -> None:
    """0 encoder, 3 AVV alone, 4 deviation observer alone; 2, the blend, is what the campaign runs."""
    words = [
        "--set",
        f"position_source={source}",
        "--no-plots",
        "--out",
        str(tmp_path / "out"),
    ]
    done = stillspin("run", "A16", "--profile", "ideal", *words)
    assert done.returncode == 0, done.stdout + done.stderr


def standstill(parameters: dict[str, float]) -> tuple[float, float]:
    """Two seconds at zero speed in the ideal profile: largest position error (degrees el.) and shaft speed (rpm)."""
    native = core.load()
    plant = profile.load("ideal", core.plant_schema(native), core.parameters(native))
    result = native.run(
        plant=plant.plant,
        parameters={**plant.parameters, **parameters},
        commands=[],
        load=[],
        duration=2.0,
        max_start=2.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    off = np.asarray(result.signals["true_angle"] - result.signals["est_angle"])
    error = np.degrees(np.remainder(off + np.pi, 2 * np.pi) - np.pi)
    after = result.signals["time"] > 0.2
    if not after.any():
        return 180.0, float("nan")
    # From a fault on, in which some of these end, there is no angle in use.
    return float(np.nanmax(np.abs(error[after]))), float(np.max(np.abs(result.signals["true_speed"][after])))


def test_the_papers_zvv_holds_standstill_with_positive_d_current_only() -> None:
    """Physics, section 3: with i_d* > 0 the q-axis form is stable, with i_d* < 0 it is not at these gains."""
    late = {
        "divergence_limit": 90.0,
        "divergence_time": 1000.0,
        "synchronism_time": 1000.0,
    }
    paper = {**variant.paper().checked(core.parameters(core.load())), **late}
    error, speed = standstill(paper)
    assert error < 3.0  # a noiseless converter has a dead zone of some degrees
    assert speed < 4.0
    error, _ = standstill({**paper, "id_low_speed": -8.0})
    assert error > 20.0


def test_the_papers_scheme_brings_a_rotor_through_its_transition_and_back(
    tmp_path: Path,
) -> None:
    """Fig. 15 with its own two estimators, and what becomes of it where ZVV is blind in its own blend."""
    words = [
        "run",
        "A15",
        "--scheme",
        "paper",
        "--profile",
        "ideal",
        "--no-plots",
        "--out",
        str(tmp_path / "out"),
    ]

    def errors(*more: str) -> tuple[float, float]:
        stillspin(*words, *more)
        found = figures(tmp_path / "out" / "metrics.json")["A15"]
        peaks = [found[f"{when}_position_error_peak"]["value"] for when in ("transition", "steady")]
        return tuple(180.0 if peak is None else peak for peak in peaks)  # type: ignore[return-value]

    transition, steady = errors()
    assert 0.3 < transition < 6.0
    assert 0.1 < steady < 4.0  # a noiseless converter has a dead zone of some degrees
    transition, steady = errors("--set", "adc.noise=1.2")
    assert 0.3 < transition < 8.0
    assert 0.3 < steady < 4.0
    _, steady = errors("--set", "adc.noise=0.2")
    assert 0.1 < steady < 2.0  # a fifth of a digit of noise, and it is gone
    blind = stillspin(*words, "--set", "adc.noise=1.2", "--set", "paper_terms=111")
    assert "broken off: the shaft turned at" in blind.stdout + blind.stderr


def test_the_full_vector_form_needs_no_d_current_at_standstill() -> None:
    zero_vectors_only = {
        "position_source": 4.0,
        "observer_windows": 0.0,
        "excitation": 0.0,
    }
    error, speed = standstill(zero_vectors_only)
    assert error < 2.0
    assert speed < 2.0


@pytest.mark.parametrize(
    "fault",
    [
        "machine.magnet_flux=0.0001",  # nothing turns: the polarity test must say so
        "link.source_voltage=100",  # below link_minimum
        "sensor.offset_a=1.5",  # beyond what an offset may be
    ],
)
def test_a_plant_that_cannot_work_ends_in_a_named_fault(tmp_path: Path, fault: str) -> None:
    done = stillspin(
        "run",
        "A10",
        "--profile",
        "ideal",
        "--set",
        fault,
        "--no-plots",
        "--out",
        str(tmp_path / "out"),
    )
    assert done.returncode == 1
    assert "fault" in done.stdout + done.stderr
