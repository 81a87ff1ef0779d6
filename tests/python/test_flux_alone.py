"""A stator-flux method alone at low speed, where dead time and resistance are as large as the EMF."""

import importlib

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile
from stillspin.measure import metrics

pytest.importorskip("stillspin._core", reason="the native module is not built")


def worst_error(motor, source, speeds, load):
    """Largest position error, degrees, of the last 0.2 s at each speed; profile `bench`, a nameplate's parameters."""
    native = importlib.import_module("stillspin._core")
    loaded = profile.load("bench", core.plant_schema(native), core.parameters(native), motor)
    held = 0.8
    result = native.run(
        plant=loaded.plant,
        parameters={
            **loaded.parameters,
            **{"position_source": source, "start_method": 1, "flux_low": 1.0, "flux_high": 2.0},
        },
        commands=[(held * step, "speed_ref_rpm", speed) for step, speed in enumerate(speeds)],
        load=[(0.1, 0.0), (0.2, load)],
        duration=held * len(speeds),
        max_start=5.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed and not result.faults, (result.reason, result.faults)
    signals = dict(result.signals)
    time, error = np.asarray(signals["time"]), np.abs(metrics.position_error(signals))
    ends = held * np.arange(1, len(speeds) + 1)
    return [float(np.max(error[(time > end - 0.2) & (time <= end)])) for end in ends]


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
