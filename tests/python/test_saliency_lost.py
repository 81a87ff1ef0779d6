"""A machine whose saliency ends below the limit of the current and comes back with the other sign, under a large load.

It is more than the current bears that leaves the saliency, so it drives the shaft back until the EMF frees as much as
holds it; what is asked is that the drive keeps the angle there, and that it says what happens.
"""

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile

MOTOR, SALIENT = "washer_belt_310v", 2.0  # A, of 4 A, where Lqq is a fifth below Ld


@pytest.fixture(scope="module")
def driven_back():
    """The run with a stall_time, on what a commissioning without errors would have found."""
    native = pytest.importorskip("stillspin._core", reason="the native module is not built")
    chosen = profile.load(MOTOR, core.plant_schema(native), core.parameters(native), MOTOR)
    told, error = chosen.parameters, chosen.plant["parameter_error"]
    rated = chosen.plant["machine"]["rated_peak_current"]
    own = {
        name: told[name] * (1.0 + error[name]) for name in ("inductance_d", "inductance_q", "magnet_flux", "inertia")
    }
    own["stator_resistance"] = told["stator_resistance"] * (1.0 + error["resistance"])
    for point in range(1, 5):
        own[f"lqq_{point}"] = 100.0 / (1.0 + (point / 4.0 * SALIENT / (2.0 * rated)) ** 2)
    own |= {"map_current": SALIENT, "saliency_current": SALIENT, "map_known": 1.0}
    share = (own["inductance_q"] - own["inductance_d"]) / (own["inductance_q"] + own["inductance_d"])
    per_ampere = 1.5 * told["pole_pairs"] * own["magnet_flux"]
    speed = 310.0 * share / 6.0 / own["magnet_flux"] / told["pole_pairs"] * 30.0 / np.pi  # up to which it is SALIENT

    def run(stall_time, swing):
        mean = 0.5 * (SALIENT + told["current_limit"])
        load = [(0.7 + 0.1 * n, per_ampere * (mean + swing * (-1) ** n)) for n in range(34)]
        return native.run(
            plant=profile.merged(chosen.plant, {"solver": {"method": "rk4"}}),
            parameters={**told, **own, "stall_time": stall_time},
            commands=[(0.0, "speed_ref_rpm", speed)],
            load=[(0.0, 0.0), (0.6, 0.0), *load],
            duration=4.0,
            max_start=5.0,
            record_every=10,
            waveform=(0.0, 0.0, 1),
            seed=1,
            progress=None,
        )

    return run


def test_it_keeps_the_angle_at_the_current_that_the_emf_frees(driven_back):
    run = driven_back(0.0, 0.0)
    assert run.completed and not run.faults
    back = run.signals["time"] > run.signals["time"][0] + 1.5
    error = np.angle(np.exp(1j * (run.signals["est_angle"] - run.signals["true_angle"])))
    assert run.signals["true_speed"][back].max() < -200.0, "else this shows nothing"
    assert np.degrees(np.abs(error[back]).max()) < 10.0
    # Held by what was asked of it and no more: the torque is that of the angle.
    assert run.signals["i_q_ref"][back].mean() == pytest.approx(0.5 * (SALIENT + 4.0), rel=0.1)


def test_it_says_that_the_shaft_does_not_follow(driven_back):
    # An uneven load lets the shaft slow down by more than a sixteenth and speed up again, as long as this lasts.
    run = driven_back(1000.0, 0.3)
    ((at, words),) = run.faults
    assert words.startswith("stalled")
    assert at - run.signals["time"][0] < 0.7 + 3.0
