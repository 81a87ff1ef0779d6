"""The plant against motulator (Aalto University, MIT licence), a machine model that others wrote and published.

Both get the same sequence of gate edges and loads, open loop: the shaft starts from rest, is loaded and is turned
back. motulator's own right-hand side (inverter, machine and shaft as it joins them) is integrated here from edge to
edge. Nothing but the numbers of the machine and the edges is common to the two.
"""

import importlib
import math

import numpy as np
import pytest
from motulator.common.utils import complex2abc

import motulator_oracle
from motulator_oracle import CURRENTS, TICK
from stillspin import core
from stillspin.cases import profile

PERIOD = 10_000  # ticks: 10 kHz
PERIODS = 2_000
LOOK = 3_700  # ticks into the period, somewhere between the edges
POINTS = [(0, 0.0), (70_000_00, 0.0), (70_000_00, 2.0), (140_000_00, 2.0), (150_000_00, -1.0)]  # tick, N m
KNEES = ((0.0, 0.0), (0.06, 60.0), (0.12, 60.0), (0.2, -20.0))  # s, rad/s

# How far the two may be apart, in A, rad/s and rad: a few times what the integrators leave over. The
# Runge-Kutta methods take one step from edge to edge, of at most 25 us. With 240 rad/s electrical and 13 A such a step
# is wrong by (240 x 25e-6)^5 / 120 x 13 A = 8e-13 A, and a current remembers 900 steps (L/R = 15 ms): 8e-10 A, which is
# also what is measured. CVODE begins anew at first order behind every edge, keeps 1e-10 of 13 A and of 60 rad/s in each
# of several steps; over 12 000 edges that leaves 3e-7 A and 5e-7 rad/s.
RUNGE_KUTTA = (1e-8, 1e-8, 1e-10)
# The drive's shortest dead time is one tick, in which a current of less than 4e-4 A (200 V on Ld for 10 ns) may come to
# zero and stay there, which motulator does not know. It is forgotten in L/R = 15 ms; until then 0.96 N m/A of it have
# moved 0.00455 kg m^2 by 1.3e-3 rad/s.
DEAD_TICK = 4e-4
DEAD_TICK_SPEED = 1.3e-3
TOLERANCE = {"erkstep": RUNGE_KUTTA, "rk4": RUNGE_KUTTA, "reference": (1e-6, 1e-6, 1e-8)}


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


@pytest.fixture(scope="module")
def ideal(native):
    """Every entry of the plant in profile `ideal`."""
    schema = core.plant_schema(native)
    own = profile.load("ideal", schema, core.parameters(native)).plant
    return {
        section: {key: entry.default for key, entry in keys.items()} | own.get(section, {})
        for section, keys in schema.items()
    }


def wanted(t):
    """Speed (rad/s) and acceleration (rad/s²) of a shaft that follows KNEES."""
    times, speeds = zip(*KNEES, strict=True)
    rising = float(np.interp(t + 1e-6, times, speeds)) - float(np.interp(t - 1e-6, times, speeds))
    return float(np.interp(t, times, speeds)), rising / 2e-6


def voltage(plant, t):
    """The dq voltage that turns an ideal machine like `wanted`, without feedback."""
    m, s = plant["machine"], plant["mechanics"]
    speed, acceleration = wanted(t)
    load = np.interp(t / TICK, *zip(*POINTS, strict=True))
    torque = s["inertia"] * acceleration + s["viscous_friction"] * speed + load
    i_q = torque / (1.5 * m["pole_pairs"] * m["magnet_flux"])
    electrical = m["pole_pairs"] * speed
    return complex(-electrical * m["inductance_q"] * i_q, m["resistance"] * i_q + electrical * m["magnet_flux"])


def pulses(plant, vector):
    """Ticks in a period at which the legs rise and fall: centred pulses for the mean of `vector` over the period."""
    phases = complex2abc(vector)
    middle = 0.5 * (phases.max() + phases.min())
    half = np.clip(0.5 + (phases - middle) / plant["link"]["source_voltage"], 0.05, 0.95) * PERIOD / 2
    return [(PERIOD // 2 - round(h), PERIOD // 2 + round(h)) for h in half]


@pytest.fixture(scope="module")
def edges(ideal):
    """(tick, leg, upper, lower) in the order of time; at every instant one switch of each leg conducts."""
    sequence = [(0, leg, False, True) for leg in range(3)]
    angle = 0.3  # rad electrical: where the plant's rotor lies at power-on
    for n in range(PERIODS):
        middle = (n + 0.5) * PERIOD * TICK
        turn = ideal["machine"]["pole_pairs"] * wanted(middle)[0] * PERIOD * TICK
        vector = voltage(ideal, middle) * np.exp(1j * (angle + 0.5 * turn))
        angle += turn
        for leg, (rise, fall) in enumerate(pulses(ideal, vector)):
            sequence += [(n * PERIOD + rise, leg, True, False), (n * PERIOD + fall, leg, False, True)]
    return sorted(sequence)


def looks():
    return [n * PERIOD + offset for n in range(PERIODS) for offset in (0, LOOK)]


def replayed(native, plant, edges):
    return native.replay(plant=plant, edges=edges, load=POINTS, at=looks())


@pytest.fixture(scope="module")
def published(native, ideal, edges):
    """The same by motulator, from the state of the first look on."""
    first = {name: float(values[0]) for name, values in replayed(native, ideal, edges).items()}
    return motulator_oracle.published(ideal, first, edges, POINTS, looks())


def apart(ours, published):
    """Greatest distances of currents (A), speed (rad/s) and mechanical angle (rad)."""
    distance = {name: np.abs(ours[name] - published[name]) for name in ours}
    turn = np.angle(np.exp(1j * distance["angle"]))
    return max(distance[name].max() for name in CURRENTS), distance["speed"].max(), np.abs(turn).max()


def test_the_sequence_is_worth_comparing(native, ideal, edges):
    ours = replayed(native, ideal, edges)
    assert np.ptp(ours["i_d"]) > 1.0
    assert np.ptp(ours["i_q"]) > 5.0
    assert ours["speed"].max() > 50.0
    assert ours["speed"].min() < 0.0
    assert np.ptp(ours["angle"]) > 2.0 * math.pi / 4
    assert all(np.isfinite(values).all() for values in ours.values())


@pytest.mark.parametrize("method", TOLERANCE)
def test_the_plant_agrees_with_motulator(native, ideal, edges, published, method):
    ours = replayed(native, ideal | {"solver": ideal["solver"] | {"method": method}}, edges)
    amperes, speed, angle = apart(ours, published)
    limit = TOLERANCE[method]
    assert amperes < limit[0]
    assert speed < limit[1]
    assert angle < limit[2]


def moved(edges, ticks):
    """The sequence with one rising edge, in the middle of the acceleration, later by `ticks`."""
    k = next(k for k, (tick, leg, upper, _) in enumerate(edges) if tick > 300 * PERIOD and leg == 0 and upper)
    tick, *rest = edges[k]
    return sorted([*edges[:k], (tick + ticks, *rest), *edges[k + 1 :]])


@pytest.mark.parametrize("entry", ["resistance", "inductance_d", "inductance_q", "magnet_flux", "inertia"])
def test_one_percent_of_a_machine_constant_shows(native, ideal, edges, published, entry):
    other = ideal | {"parameter_error": ideal["parameter_error"] | {entry: 0.01}}
    assert apart(replayed(native, other, edges), published)[0] > 1e5 * RUNGE_KUTTA[0]


def test_one_tick_of_one_edge_shows(native, ideal, edges, published):
    assert apart(replayed(native, ideal, moved(edges, 1)), published)[0] > 1e3 * RUNGE_KUTTA[0]


def drive_record(signals, pole_pairs):
    """The true values of a run's record, named and scaled like those of `replay`."""
    names = {"i_a": "i_a", "i_b": "i_b", "i_c": "i_c", "i_d": "true_i_d", "i_q": "true_i_q"}
    record = {name: signals[column] for name, column in names.items()}
    electrical = np.unwrap(signals["true_angle"])
    return record | {"speed": signals["true_speed"] * math.pi / 30.0, "angle": electrical / pole_pairs}


def test_a_run_of_the_drive_agrees_with_motulator(native, ideal):
    """The edges that the drive itself has made, from the end of its start procedure on, and what was recorded then."""
    duration, load = 0.05, [(0.0, 0.0), (0.03, 0.0), (0.03, 2.0)]
    result = native.run(
        plant=ideal,
        parameters=profile.load("ideal", core.plant_schema(native), core.parameters(native)).parameters,
        commands=[(0.01, "speed_ref_rpm", 300.0)],
        load=load,
        duration=duration,
        max_start=2.0,
        record_every=1,
        waveform=(0.0, duration, PERIOD),
        seed=1,
        progress=None,
    )
    assert result.completed, result.reason
    table = result.waveform["edges"]
    columns = (np.rint(table["time"] / TICK), table["leg"], table["upper"], table["lower"])
    made = [(int(t), int(leg), bool(on), bool(off)) for t, leg, on, off in zip(*columns, strict=True)]
    record = drive_record(result.signals, ideal["machine"]["pole_pairs"])
    at = [n * PERIOD for n in range(round(duration / TICK) // PERIOD)]
    ours = {name: values[: len(at)] for name, values in record.items()}
    first = {name: float(values[0]) for name, values in ours.items()}
    points = [(round(t / TICK), torque) for t, torque in load]
    amperes, speed, _ = apart(ours, motulator_oracle.published(ideal, first, made, points, at))
    assert np.ptp(ours["speed"]) > 5.0
    assert amperes < DEAD_TICK
    assert speed < DEAD_TICK_SPEED


@pytest.mark.parametrize(
    ("edges", "at"), [([(5, 0, True, False), (4, 0, False, True)], []), ([(5, 3, True, False)], []), ([], [7, 6])]
)
def test_what_cannot_be_replayed_is_refused(native, ideal, edges, at):
    with pytest.raises(ValueError, match=r"decrease|leg"):
        native.replay(plant=ideal, edges=edges, load=[], at=at)
