"""A stator-flux method alone at low speed, where dead time and resistance are as large as the EMF."""

import importlib
from pathlib import Path

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile
from stillspin.measure import metrics
from stillspin.runs import variant

pytest.importorskip("stillspin._core", reason="the native module is not built")


LOW_PASS = Path(__file__).resolve().parents[2] / "toolchain/book/cases/paper_flux_low_pass.toml"
HELD = 0.8  # s, each speed


def errors_of(plate, plant, parameters, speeds, load):
    """The position error, degrees, of the last 0.2 s at each speed."""
    native = importlib.import_module("stillspin._core")
    result = native.run(
        plant=profile.merged(plate.plant, plant),
        parameters={**plate.parameters, "start_method": 1, "flux_low": 1.0, "flux_high": 2.0, **parameters},
        commands=[(HELD * step, "speed_ref_rpm", speed) for step, speed in enumerate(speeds)],
        load=[(0.1, 0.0), (0.2, load)],
        duration=HELD * len(speeds),
        max_start=5.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed and not result.faults, (result.reason, result.faults)
    signals = dict(result.signals)
    time, error = np.asarray(signals["time"]), metrics.position_error(signals)
    ends = HELD * np.arange(1, len(speeds) + 1)
    return [error[(time > end - 0.2) & (time <= end)] for end in ends]


def nameplate(name, motor):
    """A profile with a nameplate's parameters."""
    native = core.load()
    return profile.load(name, core.plant_schema(native), core.parameters(native), motor)


def worst_error(motor, source, speeds, load):
    """Of profile `bench`."""
    errors = errors_of(nameplate("bench", motor), {}, {"position_source": source}, speeds, load)
    return [float(np.max(np.abs(each))) for each in errors]


@pytest.mark.parametrize("source", [5, 6, 7, 8])
@pytest.mark.parametrize("motor", ["A", "B"])
def test_a_shaft_without_load_does_not_swing(motor, source):
    errors = worst_error(motor, source, [300.0, 200.0, -200.0, -120.0], 0.0)
    assert max(errors) < 2.5, errors


@pytest.mark.parametrize("source", [5, 6, 7, 8])
@pytest.mark.parametrize("motor", ["A", "B"])
def test_thirty_revolutions_under_little_load(motor, source):
    errors = worst_error(motor, source, [300.0, 100.0, 30.0], 1.0)
    assert errors[-1] < 3.0, errors


def test_on_the_low_pass_the_papers_conv_and_pp01_are_off_by_the_same_under_little_load():
    """With drops that nobody takes off: both by less than 45 degrees at 300 rpm, as the paper has CONV, and by more at
    200, where it has PP-01 stable."""
    case = variant.scheme(str(LOW_PASS)).checked(core.parameters(core.load()))
    drops = {"inverter": {"switch_threshold": 0.7, "diode_threshold": 0.7}}
    means = []
    for source in (5, 6):
        parameters = {**case, "position_source": source, "flux_cutoff": 78.0}
        errors = errors_of(nameplate("ideal", "B"), drops, parameters, [300.0, 200.0], 1.0)
        means.append([abs(float(np.mean(each))) for each in errors])
    conv, pp01 = means
    assert max(conv[0], pp01[0]) < 45.0 < min(conv[1], pp01[1])
    assert np.allclose(conv, pp01, rtol=0.0, atol=3.0)
