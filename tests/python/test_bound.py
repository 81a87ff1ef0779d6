"""The Cramér-Rao bound against closed forms, and how near to it the drive's observer comes."""

import importlib

import numpy as np
import pytest

from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.measure import bound, metrics, pieces, speed_profile
from stillspin.report import special_plots

ACCELERATION = 4 / 0.00455  # rad/s² per N m, motor A
EXPECTED = bound.Expected(ACCELERATION, rate=0.6, quiet=0.05)


def told(angle=0.0, cross=0.0, speed=0.0, rpm=1000.0, records=5000):
    one = np.ones(records)
    return {
        "time": np.arange(records) * bound.PERIOD,
        "true_speed": rpm * one,
        "told_angle": angle * one,
        "told_cross": cross * one,
        "told_speed": speed * one,
    }


def test_the_angle_alone_gives_the_triple_integrators_bound():
    """In continuous time its variance is 2 r^(5/6) q^(1/6), r and q noise of the angle and of the load per second."""
    information = 10.0
    r = bound.PERIOD / information
    q = (ACCELERATION * 0.6) ** 2 / 100.0 / bound.PERIOD
    expected = np.degrees(np.sqrt(2.0 * r ** (5.0 / 6.0) * q ** (1.0 / 6.0)))
    found = bound.angle_bound(told(angle=information), EXPECTED)[-1]
    assert found == pytest.approx(expected, rel=0.01)  # a period is 1 % of its time constant


def test_it_is_what_a_textbook_filter_expects_of_itself():
    """Another form of the update: gains of two scalar measurements, one after the other."""
    h = np.array([[60.0, 0.2, 0.0], [-15.0, 0.7, 0.0]])  # per unit of noise
    information = h.T @ h
    signals = told(information[0, 0], information[0, 1], information[1, 1], records=300)
    t = bound.PERIOD
    move = np.array([[1.0, t, t * t / 2.0], [0.0, 1.0, t], [0.0, 0.0, 1.0]])
    p = np.diag([np.radians(10.0) ** 2, 20.0**2, (3.0 * ACCELERATION) ** 2])
    found = bound.angle_bound(signals, EXPECTED)
    for row in range(300):
        p = move @ p @ move.T
        p[2, 2] += EXPECTED.walk(signals["true_speed"][:1])[0]
        for one in h:
            p = p - np.outer(p @ one, one @ p) / (1.0 + one @ p @ one)
        assert found[row] == pytest.approx(np.degrees(np.sqrt(p[0, 0])), rel=1e-6)


def test_more_information_never_makes_it_worse():
    less, more = (bound.angle_bound(told(angle=a, speed=0.01), EXPECTED) for a in (1e3, 2e3))
    assert np.all(more < less)


def test_a_quiet_load_is_expected_at_a_crawl_only():
    walk = EXPECTED.walk(np.array([0.0, -10.0, 20.0, 30.0, -3000.0]))
    assert walk[0] == walk[1] == pytest.approx((ACCELERATION * 0.05) ** 2 / 100.0)
    assert walk[3] == walk[4] == pytest.approx((ACCELERATION * 0.6) ** 2 / 100.0)
    assert walk[2] == pytest.approx((walk[1] + walk[3]) / 2.0)


def test_records_that_skip_periods_count_for_those_between():
    every = told(angle=1e3, speed=0.01)
    found = bound.angle_bound(every, EXPECTED)
    skipped = bound.angle_bound({name: data[::5] for name, data in every.items()}, EXPECTED)
    assert skipped[:-1] == pytest.approx(found[4::5][: skipped.size - 1])


def test_a_record_without_what_it_needs_is_refused():
    with pytest.raises(ValueError, match="told"):
        bound.angle_bound({"time": np.arange(5.0)}, EXPECTED)
    with pytest.raises(ValueError, match="inertia"):
        bound.Expected.of({"pole_pairs": 4.0}, {"observer_load_rate": 0.6, "observer_load_quiet": 0.05})


def held_at_twice_the_bound():
    signals = told(angle=1e3, speed=0.01, records=10_000)
    least = bound.angle_bound(signals, EXPECTED)
    used = np.radians(2.0 * least) * np.where(np.arange(least.size) % 2 == 0, 1.0, -1.0)
    zero = np.zeros(least.size)
    return {
        **signals,
        "speed_ref": signals["true_speed"],
        "true_angle": zero,
        "est_angle": used,
    }


EXTRAS = pieces.Extras(
    machine={"pole_pairs": 4.0, "inertia": 0.00455},
    observer={"observer_load_rate": 0.6, "observer_load_quiet": 0.05},
)


def test_the_figure_is_the_error_over_the_bound():
    signals = held_at_twice_the_bound()
    piece = pieces.Piece(signals, signals["speed_ref"], 1000.0, 1000.0, EXTRAS)
    assert metrics.FUNCTIONS["hold_bound_ratio"](piece) == pytest.approx(2.0)


def test_it_is_drawn_below_the_error():
    shown = special_plots.Shown(scenario_file.load("S01"), {"drive": held_at_twice_the_bound()}, {"drive": EXTRAS})
    lines = {line.get_label(): line for line in special_plots.errors_over_speed(shown).axes[0].get_lines()}
    peak, least = lines["this drive"].get_ydata()[0], lines["least rms: Cramér-Rao bound"].get_ydata()[0]
    assert peak == pytest.approx(2.0 * least, rel=1e-3)


WALK_STEP = 2e-4  # s
WALK_REACH = 2.0  # N m


def wandering(rate, duration):
    """A load that changes by `rate` (N m) in 10 ms as a random walk, thrown back at ±2 N m."""
    steps = np.random.default_rng(3).normal(0.0, rate * np.sqrt(WALK_STEP / 0.01), round(duration / WALK_STEP))
    folded = np.abs(np.mod(np.cumsum(steps) - WALK_REACH, 4.0 * WALK_REACH) - 2.0 * WALK_REACH) - WALK_REACH
    return [(0.0, 0.0)] + [(0.3 + k * WALK_STEP, float(torque)) for k, torque in enumerate(folded)]


def efficiency(rpm, rate, parameters, seed=1):
    """Rms error over the bound while the speed is held: profile ideal and the converter's noise of `bench`.

    The load wanders by the named rate, or is 1 N m without one.
    """
    pytest.importorskip("stillspin._core", reason="the native module is not built")
    native = importlib.import_module("stillspin._core")
    schema, table = core.plant_schema(native), core.parameters(native)
    expects = {name: float(table[name].default) for name in ("observer_load_rate", "observer_load_quiet")}
    ideal = profile.load("ideal", schema, table)
    plant = {**ideal.plant, "adc": {**ideal.plant["adc"], "noise": 1.2}}
    result = native.run(
        plant=plant,
        parameters={**ideal.parameters, **parameters},
        commands=[(0.0, "speed_ref_rpm", rpm)],
        load=wandering(expects[rate], 2.1) if rate else [(0.0, 1.0)],
        duration=2.4,
        max_start=2.0,
        record_every=1,
        waveform=(0.0, 0.0, 1),
        seed=seed,
        progress=None,
    )
    assert result.completed, result.reason
    machine = {key: float(schema[section][key].default) for section, key in MACHINE}
    signals = dict(result.signals)
    least = bound.angle_bound(signals, bound.Expected.of(machine, expects))
    held = speed_profile.holds(signals, metrics.position_error(signals))[-1]
    assert held.followed
    return held.rms / speed_profile.holds(signals, least)[-1].rms


MACHINE = (("machine", "pole_pairs"), ("mechanics", "inertia"))


HELD = [(0.0, 1), (60.0, 1), *((rpm, seed) for rpm in (600.0, 3000.0) for seed in range(1, 6))]


@pytest.mark.parametrize(("rpm", "seed"), HELD)
def test_told_the_true_noise_the_observer_is_near_the_bound(rpm, seed):
    """The load wanders as both expect it, so the bound holds: nobody is better, but for chance.

    The error forgets within some 5 ms, so 1.4 s are some 300 errors: their rms is within 4 % or so of the truth, of
    which the floor leaves two and a half. The ceiling is the aim. What keeps the observer off the bound: fixed point,
    10 mA for both axes where alpha has 9 mA and beta 12 mA, the torque by a noisy current, steps that it looks out for
    at a crawl. What is learnt of the machine on the way to the speed is not forgotten within 5 ms: hence five seeds.
    """
    rate = "observer_load_quiet" if rpm == 0.0 else "observer_load_rate"
    assert 0.9 < efficiency(rpm, rate, {"observer_noise": 10.0}, seed) < 1.5


@pytest.mark.parametrize("rpm", [5.0, 60.0, 600.0, 3000.0])
def test_as_delivered_the_observer_is_near_the_bound_under_a_constant_load(rpm):
    """Told 100 mA it trusts the load more than the bound does, and this load obliges: it may be better than that.

    It cannot be much better, or the plant would have lost its noise.
    """
    assert 0.4 < efficiency(rpm, None, {}) < 1.5
