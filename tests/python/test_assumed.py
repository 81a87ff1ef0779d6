"""What no nameplate says: rules have it in the place of a motor's file, as for the motors of the catalogue."""

import importlib
import math
import tomllib

import pytest

from stillspin import core, resources
from stillspin.cases import profile, questions, similarity
from stillspin.runs import startup


def crossed():
    """Names and data of those that state their cross-saturation: where the fluxes are a table it is in there."""
    for path in sorted(resources.directory(resources.CATALOGUE).glob("*.toml"), key=lambda path: path.name):
        machine = tomllib.loads(path.read_text(encoding="utf-8"))["machine"]
        if "flux_map" not in machine:
            yield pytest.param(path.stem, machine, id=path.stem)


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


@pytest.mark.parametrize(("name", "machine"), crossed())
def test_the_axis_turns_as_that_of_the_catalogues_motors(native, name, machine):
    plant = profile.load("ideal", core.plant_schema(native), core.parameters(native), name).plant
    bare = {key: value for key, value in machine.items() if key != "cross_inductance"}
    found = similarity.assumed({**plant, "machine": bare})
    stated = pytest.approx(machine["cross_inductance"], rel=5e-3, abs=1e-12)
    assert found == {"machine": {"cross_inductance": stated}}


NAMEPLATE = {
    "pole_pairs": 3, "resistance": 0.45, "inductance_d": 5.5, "inductance_q": 9.8, "emf": 61.5, "rated_current": 10.6,
    "inertia": 6e-4, "voltage": 400, "current_range": 40, "speed": 4000,
}  # fmt: skip


@pytest.mark.parametrize("angle", [0.0, 100.0, 230.0])
def test_a_motor_of_a_nameplate_starts_against_a_brake_once_it_is_known(native, tmp_path, angle):
    """Its file states nothing of the cross-saturation, which alone tells the polarity there."""
    path = tmp_path / "mine.toml"
    path.write_text(questions.file_text("mine", NAMEPLATE), encoding="utf-8")
    schema = core.plant_schema(native)
    chosen = profile.load("bench", schema, core.parameters(native), str(path))
    assert "machine.cross_inductance is not stated; by rule it is 0.000206 H" in chosen.not_stated
    held = {"mechanics": {"brake_until_run": True}, "initial": {"angle": math.radians(angle)}}

    def faults(extra):
        plant = profile.merged(chosen.plant, held, extra)
        return native.run(
            plant=plant,
            parameters={**chosen.parameters, **startup.saturation_map(plant, schema)},
            commands=[(0.0, "speed_ref_rpm", 200.0)],
            load=[],
            duration=0.2,
            max_start=5.0,
            record_every=10,
            waveform=(0.0, 0.0, 1),
            seed=1,
            progress=None,
        ).faults

    assert not faults({})
    ((_, words),) = faults({"machine": {"cross_inductance": 0.0}})
    assert words.startswith("polarity of the magnet ambiguous")
