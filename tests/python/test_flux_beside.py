"""A stator-flux method that looks on while the encoder has the shaft."""

import importlib

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile
from stillspin.measure import metrics, pieces

pytest.importorskip("stillspin._core", reason="the native module is not built")


def run(**parameters):
    """Motor B up to 600 rpm under 3 N m, profile `ideal`."""
    native = importlib.import_module("stillspin._core")
    loaded = profile.load("ideal", core.plant_schema(native), core.parameters(native), "B")
    result = native.run(
        plant=loaded.plant,
        parameters={**loaded.parameters, "position_source": 0, "flux_low": 50, **parameters},
        commands=[(0.0, "speed_ref_rpm", 600.0)],
        load=[(0.2, 0.0), (0.3, 3.0)],
        duration=1.2,
        max_start=2.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed, result.reason
    signals = dict(result.signals)
    settled = np.asarray(signals["time"]) > 0.9
    return {name: np.asarray(data, dtype=float)[settled] for name, data in signals.items()}


@pytest.mark.parametrize("method", [1, 2, 3, 4])
def test_it_sees_the_shaft_and_nobody_uses_it(method):
    signals = run(flux_beside=method)
    beside = pieces.wrap_degrees(signals["true_angle"] - signals["angle_avv"])
    load = pieces.wrap_degrees(signals["true_load_angle"] - signals["load_angle"])
    assert 1e-4 < np.max(np.abs(beside)) < 0.5
    assert np.max(np.abs(load)) < 0.5
    assert np.degrees(np.mean(signals["load_angle"])) > 5.0
    # A drive that is told a wrong inductance: the method beside is off, what is used is not.
    wrong = run(flux_beside=method, inductance_q=2.2)
    beside = pieces.wrap_degrees(wrong["true_angle"] - wrong["angle_avv"])
    assert np.min(np.abs(beside)) > 2.0
    assert np.max(np.abs(metrics.position_error(wrong))) < 1.2  # the alignment of the encoder at the start


def test_it_needs_the_encoder():
    native = importlib.import_module("stillspin._core")
    with pytest.raises(ValueError, match="flux_beside"):
        native.check_parameters({"flux_beside": 1})
