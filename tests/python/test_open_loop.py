"""What a motor without saliency is told of the vector that turns it (cases/open_loop.py)."""

import numpy as np
import pytest

from stillspin.cases import open_loop


def test_the_vector_follows_from_the_nameplate():
    """The share of the EMF, the damping's bound and the slope, by the time and by the swing, each by hand."""
    told = {
        "inductance_d": 1.0,
        "inductance_q": 1.05,
        "magnet_flux": 0.02,
        "pole_pairs": 5.0,
        "inertia": 1e-3,
        "current_limit": 20.0,
        "rated_current": 15.0,
        "speed_limit": 3000.0,
    }
    found = open_loop.following(told, 50.0)
    assert found["start_method"] == 1.0
    assert found["if_current"] == pytest.approx(0.5 * 0.02 / 1.05e-3, abs=0.01)
    assert found["if_speed"] == pytest.approx(5.0 / 0.02 / 5.0 * 30.0 / np.pi, abs=1.0)
    swing = np.sqrt(5.0 * 1.5 * 5.0 * 0.02 * 9.52 / 1e-3)
    assert found["if_acceleration"] == pytest.approx(4.0 * swing / 5.0 * 30.0 / np.pi, abs=1.0)
    light = open_loop.following({**told, "inertia": 1e-4}, 50.0)
    assert light["if_acceleration"] == pytest.approx(light["if_speed"] / 0.6, abs=1.0)
    assert found["spin_speed"] == pytest.approx(0.93 * 0.145 * 50.0 / 0.02 / 5.0 * 30.0 / np.pi, abs=2.0)
    assert "pulse_time" not in found
    tight = open_loop.following({**told, "trip_current": told["current_limit"] + 1.0}, 50.0)
    ripple = 2.0 / 3.0 * 50.0 / told["inductance_d"] * 1e3  # A/s
    assert tight["pulse_time"] * 1e-6 * ripple == pytest.approx(1.0, rel=0.01)
    assert tight["spin_speed"] == pytest.approx(found["spin_speed"] * tight["pulse_time"] / 42.0, abs=1.0)
    least = open_loop.following({**told, "trip_current": told["current_limit"] + 0.1}, 50.0)
    assert least["pulse_time"] == open_loop.PULSE_LEAST
    assert "pulse_time" not in open_loop.following(told, 0.0), "a link that nothing is said of"
    assert open_loop.following({**told, "inductance_q": 1.15}, 50.0) == {}
    assert found["adapt_time"] == 50.0
    assert found["speed_ramp"] == pytest.approx(0.1 * 1.5 * 5.0 * 0.02 * 9.52 / 1e-3 * 30.0 / np.pi, abs=1.0)
    heavy = open_loop.following({**told, "inertia": 0.03}, 50.0)
    assert heavy["if_acceleration"] == heavy["speed_ramp"] == 45.0
