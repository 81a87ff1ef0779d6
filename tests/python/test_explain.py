"""Effects of the plant switched off and on one by one: what becomes of the plant and of the drive's parameters."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest

from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.drive import own
from stillspin.errors import InputError
from stillspin.measure.figures import Result
from stillspin.options import by_mark
from stillspin.report.explain_report import content
from stillspin.report.explanation import Explanation
from stillspin.runs import effects, records
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.effects import ALONE, WITHOUT, Effect, Worlds
from stillspin.runs.execute import Settings, prepare
from stillspin.studies import explain

pytest.importorskip("stillspin._core", reason="the native module is not built")


def worlds() -> Worlds:
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    return Worlds(profile.load("bench", schema, known), profile.load("ideal", schema, known), schema, known)


def listed(both: Worlds) -> dict[str, Effect]:
    return {item.mark: item for item in effects.load(both.schema, both.known)}


def settings(where: profile.Profile) -> Settings:
    return Settings(where, profile.Changes(), 1, "none")


def test_the_effects_are_all_that_bench_has_over_ideal() -> None:
    both = worlds()
    named = {entry for item in listed(both).values() for entry in (*item.entries, *item.needs)}
    sections = {section for section, _ in named} | {"machine", "link", "sensor", "adc"}
    differing = {
        (section, key)
        for section in sections
        for key in both.schema[section]
        if both.value(both.own, (section, key)) != both.value(both.ideal, (section, key))
    }
    assert differing <= named
    assert all(both.differs(item) for item in listed(both).values())


def test_without_an_effect_the_plant_is_ideal_in_it_and_in_nothing_else() -> None:
    both = worlds()
    case = effects.case(WITHOUT, listed(both)["drops"], settings(both.own), both)
    assert case.settings.changes.plant == {
        "inverter": dict.fromkeys(("switch_threshold", "switch_resistance", "diode_threshold", "diode_resistance"), 0.0)
    }
    assert case.settings.profile.plant == both.own.plant
    assert case.settings.profile.parameters["device_drop"] == 0.0  # the drive knows that there are none


def test_alone_an_effect_is_what_the_profile_has() -> None:
    both = worlds()
    case = effects.case(ALONE, listed(both)["dead-time"], settings(both.ideal), both)
    assert case.settings.changes.plant == {"inverter": {"turn_on_delay": 30, "turn_off_delay": 60}}
    assert case.settings.profile.parameters["dead_time"] == 2.0
    cross = effects.case(ALONE, listed(both)["cross-saturation"], settings(both.ideal), both)
    assert cross.settings.changes.plant["machine"]["saturation"] is True  # else there is nothing to couple


def test_a_scenarios_own_plant_does_not_bring_an_effect_back() -> None:
    both = worlds()
    scenario = scenario_file.load("A09")  # asks for noise itself
    case = effects.case(WITHOUT, listed(both)["adc-noise"], settings(both.own), both)
    jobs = prepare(case.scenario(scenario), case.settings, core.load())
    assert {job.plant["adc"]["noise"] for job in jobs} == {0.0}


def test_the_exact_parameters_are_the_plants() -> None:
    told = effects.exact(worlds())
    # bench: resistance 10 % above the nameplate, inductances 5 % and flux 3 % below, inertia 20 % above
    assert told["stator_resistance"] == pytest.approx(0.352)
    assert told["inductance_q"] == pytest.approx(7.41)
    assert told["magnet_flux"] == pytest.approx(0.1552)
    assert told["inertia"] == pytest.approx(0.00546)
    assert told["sensor_mismatch"] == pytest.approx(0.5)
    assert told["device_drop"] == pytest.approx(0.95)


def test_an_effect_that_does_not_exist_is_said() -> None:
    with pytest.raises(InputError, match="adc-noise"):
        by_mark(list(listed(worlds()).values()), ["gremlins"], "effect")


def made_up(values: dict[str, float]) -> Explanation:
    """A10's ripple by case: as it is, and without each of some effects."""
    scenario = scenario_file.load("A10")
    known = listed(worlds())

    def result(value: float) -> ScenarioResult:
        figure = Result("speed_ripple", value, "rpm", None, 0.8, None, "", "")
        return ScenarioResult(replace(scenario, plots=()), [], [figure], [])

    chosen = [known[mark] for mark in values if mark in known]
    return Explanation(scenario, chosen, {f"{WITHOUT}-{mark}": result(v) for mark, v in values.items()}, False)


def test_the_effect_without_which_the_figure_is_smallest_dominates() -> None:
    found = made_up({"nothing": 1.0, "adc-noise": 0.6, "cogging": 0.4, "drops": 1.2})
    assert content(found, settings(worlds().own))["figures"]["speed_ripple"]["dominating"] == "cogging"
    # a few percent less is the course of the noise
    assert made_up({"nothing": 1.0, "adc-noise": 0.95, "cogging": 0.97}).dominating(found.figures[0]) is None


def test_commissioning_is_repeated_only_for_what_it_measures(monkeypatch: pytest.MonkeyPatch) -> None:
    both = worlds()
    asked: list[str] = []

    def pretend(cases: list[effects.Case], _: object) -> list[dict[str, float]]:
        asked.extend(case.mark for case in cases)
        return [{"device_drop": 0.123} for _ in cases]

    monkeypatch.setattr(explain, "_found", pretend)
    chosen = [listed(both)[mark] for mark in ("drops", "adc-noise", "commissioning")]
    options = explain.Options("bench", 1, explain.Path("unused"))
    cases = {case.mark: case for case in explain._cases(both, chosen, None, options)}
    assert asked == ["without-nothing", "without-drops", "alone-drops"]
    assert cases["without-adc-noise"].settings.profile.parameters["device_drop"] == 0.123
    assert cases["without-commissioning"].settings.profile.parameters["device_drop"] == pytest.approx(0.95)
    assert "device_drop" in cases["alone-nothing"].settings.profile.parameters
    assert "alone-commissioning" not in cases


def test_noise_explains_the_error_of_an_ideal_plant_with_noise(tmp_path) -> None:
    """The command, on a plant that has one effect only."""
    plant = tmp_path / "noisy.toml"
    ideal = (profile.resources.directory("profiles") / "ideal.toml").read_text(encoding="utf-8")
    plant.write_text(ideal.replace("noise = 0.0", "noise = 1.2"), encoding="utf-8")
    out = tmp_path / "out"
    words = ["explain", "A10", "--profile", str(plant), "--jobs", "1", "--out", str(out)]
    command = [sys.executable, "-m", "stillspin", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    told = json.loads((out / "metrics.json").read_text(encoding="utf-8"))
    recorded = {records.read(path).about["firmware"] for path in (out / "runs").glob("*.parquet")}
    assert recorded == {told["firmware"]} == {own.firmware()}
    assert "compiled with this package" in told["firmware"]
    rms = told["figures"]["position_error_rms"]
    assert set(told["effects"]) == {"adc-noise", "commissioning"}  # that is all there is
    assert rms["dominating"] == "adc-noise"
    assert rms["without"]["adc-noise"] == rms["ideal"] < rms["value"]
    assert rms["alone"]["adc-noise"] == rms["value"]
    assert "noise of the converter" in done.stdout
    assert "<svg" in (out / "explain.svg").read_text(encoding="utf-8")
