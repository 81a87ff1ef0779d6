"""A plant that drifts behind a commissioned drive's back: what a drift does to a plant, a piece of the campaign."""

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.errors import InputError
from stillspin.options import by_mark
from stillspin.runs import drift, execute
from stillspin.runs.execute import Settings

pytest.importorskip("stillspin._core", reason="the native module is not built")

COMMISSIONED = {
    **{"stator_resistance": 0.3568, "device_drop": 0.959, "inductance_d": 4.710, "inductance_q": 7.489},
    **{"lqq_1": 97.5, "lqq_2": 90.6, "lqq_3": 81.1, "lqq_4": 70.7, "sensor_mismatch": 0.503},
    **{"ldq_1": 0.0367, "ldq_2": 0.0733, "ldq_3": 0.1099, "ldq_4": 0.1465},
    **{"magnet_flux": 0.1567, "inertia": 0.00553, "friction": 0.00316},
}
"""What `stillspin commission` finds on profile bench."""


def known() -> tuple[core.Schema, profile.Profile]:
    native = core.load()
    schema = core.plant_schema(native)
    return schema, profile.load("bench", schema, core.parameters(native))


def test_a_drift_multiplies_what_the_plant_really_is() -> None:
    schema, bench = known()
    scenarios, drifts = drift.load(schema)
    by_mark = {item.mark: item for item in drifts}
    assert set(by_mark) == {"resistance", "drop-more", "drop-less", "flux", "inductance", "inertia"}
    assert all(scenario_file.find(name) for name in scenarios)
    # bench: resistance 10 % above, inertia 20 % above, flux 3 % below the nameplate
    assert by_mark["resistance"].plant(bench.plant)["parameter_error"]["resistance"] == pytest.approx(1.1 * 1.3 - 1)
    assert by_mark["inertia"].plant(bench.plant)["parameter_error"]["inertia"] == pytest.approx(1.4)
    assert by_mark["flux"].plant(bench.plant)["parameter_error"]["magnet_flux"] == pytest.approx(0.97 * 0.9 - 1)
    assert by_mark["drop-less"].plant(bench.plant)["inverter"]["switch_threshold"] == pytest.approx(0.7)
    assert by_mark["inductance"].plant(bench.plant)["parameter_error"]["resistance"] == pytest.approx(0.1)


def test_goals_are_doubled_and_the_drive_keeps_its_parameters() -> None:
    schema, bench = known()
    item = drift.load(schema)[1][0]
    scenario = scenario_file.load("A10")
    assert [figure.goal.default for figure in item.scenario(scenario).figures] == [1.6, 0.6, 1.6]
    settings = Settings(bench, profile.Changes(), 1, "none")
    assert item.settings(settings).profile.parameters == bench.parameters
    assert item.settings(settings).profile.plant != bench.plant


def test_a_drift_that_does_not_exist_is_said() -> None:
    drifts = drift.load(known()[0])[1]
    assert [item.mark for item in by_mark(drifts, ["flux"], "drift")] == ["flux"]
    with pytest.raises(InputError, match="resistance"):
        by_mark(drifts, ["rust"], "drift")


def test_a_factor_is_on_what_the_profile_says_and_the_user_has_the_last_word() -> None:
    scenario = scenario_file.load("B21")
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    for name, true in (("bench", 1.1 * 1.3 - 1.0), ("ideal", 0.3)):
        for words, expected in (([], true), (["parameter_error.resistance=0.2"], 0.2)):
            settings = Settings(
                profile.load(name, schema, known, "B"), profile.changes(words, schema, known), 1, "none"
            )
            plants = {job.run.name: job.plant for job in execute.prepare(scenario, settings, native)}
            assert plants["warm"]["parameter_error"]["resistance"] == pytest.approx(expected)
            assert plants["warm"].get("machine", {}) == plants["normal"].get("machine", {})


@pytest.mark.parametrize("stated", ["{ machine = { resistance = 0.0 } }", "{ machine = { resistence = 1.3 } }"])
def test_a_factor_is_of_an_entry_and_above_0(tmp_path: Path, stated: str) -> None:
    text = scenario_file.find("B21").read_text(encoding="utf-8")
    path = tmp_path / "B21.toml"
    path.write_text(text.replace("{ machine = { resistance = 1.3 } }", stated), encoding="utf-8")
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    ideal = profile.load("ideal", schema, known, "B")
    with pytest.raises(InputError, match="resist"):
        execute.prepare(scenario_file.read(path), Settings(ideal, profile.Changes(), 1, "none"), native)


def step(adapt: int, inertia: float) -> float:
    """Overshoot (%) of a step to 600 rpm on an ideal plant whose inertia is `inertia` times what the drive was told."""
    native = core.load()
    schema, entries = core.plant_schema(native), core.parameters(native)
    ideal = profile.load("ideal", schema, entries)
    changes = profile.changes([f"parameter_error.inertia={inertia - 1.0}", "solver.method=rk4"], schema, entries)
    result = native.run(
        plant=profile.merged(ideal.plant, changes.plant),
        parameters={**ideal.parameters, "speed_ramp": 0.0, "inertia_adapt": float(adapt)},
        commands=[(0.1, "speed_ref_rpm", 600.0)],
        load=[],
        duration=0.6,
        max_start=2.0,
        record_every=1,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed, result.reason
    speed = np.asarray(result.signals["true_speed"])
    assert math.isclose(float(speed[-1]), 600.0, abs_tol=10.0)
    return (float(np.max(speed)) - 600.0) / 6.0


@pytest.mark.parametrize("inertia", [1.6, 2.0])
def test_the_first_run_up_tells_the_inertia(inertia: float) -> None:
    learnt, told = step(1, inertia), step(0, inertia)
    assert learnt < 2.0
    assert told > 4.0  # without it the test could not fail


def test_a_piece_of_the_campaign(tmp_path) -> None:
    """A18a with twice the inertia, on the parameters that commissioning finds."""
    told = tmp_path / "told.toml"
    lines = [f"{name} = {value}\n" for name, value in COMMISSIONED.items()]
    told.write_text("[parameters]\n" + "".join(lines), encoding="utf-8")
    out = tmp_path / "out"
    words = ["drift", "A18a", "--only", "inertia", "--params", str(told), "--jobs", "1", "--out", str(out)]
    command = [sys.executable, "-m", "stillspin", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    drifted = json.loads((out / "inertia.json").read_text(encoding="utf-8"))["scenarios"]["A18a"]["overshoot"]
    own = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["scenarios"]["A18a"]["overshoot"]
    assert drifted["goal"] == 2.0 * own["goal"]
    assert drifted["met"]
    assert drifted["value"] != own["value"]
    assert "J ×2" in (out / "report.html").read_text(encoding="utf-8")
