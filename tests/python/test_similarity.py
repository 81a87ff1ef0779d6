"""What follows for a machine of another size; the reference keeps the drive's defaults, also in other units."""

import dataclasses
import importlib
import math
import re
import tomllib
from pathlib import Path

import pytest
from test_scales import PLANT, larger

from stillspin import core, resources
from stillspin.cases import nameplate, observer_noise, profile, similarity, sized_effects
from stillspin.scales import SCALES

ROOT = Path(__file__).resolve().parents[2]
NAMES = [path.stem for path in resources.directory(resources.CATALOGUE).glob("*.toml")]


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def stated(**changes):
    """The reference as a motor's file states it, with a change or two."""
    size = dataclasses.replace(similarity.REFERENCE, **changes)
    return {
        "machine": {
            "pole_pairs": size.pole_pairs,
            "resistance": 0.32,
            "inductance_d": size.inductance_d,
            "inductance_q": size.inductance_q,
            "magnet_flux": size.magnet_flux,
            "rated_peak_current": size.current,
            "cross_inductance": 1.18e-4,
        },
        "mechanics": {"inertia": size.inertia, "viscous_friction": 0.003},
        "link": {"source_voltage": size.volts},
        "adc": {"current_range": size.current_range, "voltage_range": 450.0},
    }


def followed(native, told=None, **changes):
    return similarity.follow(stated(**changes), told or {}, core.parameters(native))


def times(native, name, **changes):
    default = core.parameters(native)[name].default
    return followed(native, **changes).get(name, default) / default


@pytest.mark.parametrize("name", ["A", "B", "B-SPM"])
def test_the_motors_that_ship_are_of_the_size_of_the_defaults(native, name):
    loaded = profile.load("bench", core.plant_schema(native), core.parameters(native), name)
    assert loaded.by_rule == ()


BENCH = tomllib.loads((resources.directory("profiles") / "bench.toml").read_text(encoding="utf-8"))
SECTIONS = {name: keys for name, keys in BENCH.items() if isinstance(keys, dict) and name != "parameters"}


@pytest.mark.parametrize("name", ["A", "B", "B-SPM"])
def test_the_motors_that_ship_have_the_bench_as_it_is_stated(native, name):
    plant = profile.load("bench", core.plant_schema(native), core.parameters(native), name).plant
    assert {name: {key: plant[name][key] for key in keys} for name, keys in SECTIONS.items()} == SECTIONS


@pytest.mark.parametrize("scales", [(0, -4), (3, -2), (-2, 1), (4, 2)])
def test_the_bench_is_as_bad_for_a_machine_of_another_size(native, scales):
    """The same shares of the link's voltage, of the sensors' range and of the rated torque."""
    amperes, volts = (2.0**scale for scale in scales)
    reference = similarity.REFERENCE
    machine = stated(
        inductance_d=reference.inductance_d * volts / amperes,
        inductance_q=reference.inductance_q * volts / amperes,
        magnet_flux=reference.magnet_flux * volts,
        current=reference.current * amperes,
        inertia=reference.inertia * volts * amperes,
        volts=reference.volts * volts,
        current_range=reference.current_range * amperes,
    )
    pair = dict(zip(SCALES, map(float, scales), strict=True))
    found = sized_effects.of_size(SECTIONS, machine, pair, core.plant_schema(native))
    larger = {
        "inverter": {"switch_threshold": volts, "diode_threshold": volts}
        | dict.fromkeys(("switch_resistance", "diode_resistance"), volts / amperes),
        "link": {"source_resistance": volts / amperes, "capacitance": amperes / volts},
        "sensor": dict.fromkeys(("offset_a", "offset_b", "offset_c", "ring_amplitude"), amperes),
        "mechanics": {"cogging_torque": volts * amperes},
    }
    for section, keys in SECTIONS.items():
        for key, value in keys.items():
            factor = larger.get(section, {}).get(key, 1.0)
            assert found[section][key] == (value * factor if factor != 1.0 else value), (section, key)


def test_pulses_are_as_short_as_the_levels_of_the_staircase_need(native):
    """With twice the ripple below what may flow along d; no shorter than windows, nor where nothing tells an axis."""
    told = {"current_limit": 14.0, "trip_current": 18.0, "weakening_limit": 11.2}

    def pulse(**changes):
        return followed(native, told, **changes).get("pulse_time", 42.0)

    for share, expected in ((1.0, 42.0), (0.25, 18.0 / 1.5 / 2.2 / (200.0 * 1e-6 / 1.225e-3)), (0.1, 24.0)):
        d = 4.9e-3 * share
        assert pulse(inductance_d=d, inductance_q=1.3 * d) == pytest.approx(min(expected, 42.0), rel=1e-3), share
        assert pulse(inductance_d=d, inductance_q=d) == 42.0
    weakened = pulse(inductance_d=1.225e-3, inductance_q=12e-3)  # the reluctance takes the rotor away at 7.4 A
    assert weakened == pytest.approx(11.2 / 2.2 / (200.0 * 1e-6 / 1.225e-3), rel=1e-3)


def test_one_inductance_where_ld_is_hardly_above_lq():
    plant = stated(inductance_d=4.0e-3, inductance_q=3.8e-3)
    found = nameplate.following(plant, {})
    assert found["inductance_d"] == found["inductance_q"] == pytest.approx(3.9)
    for d, q in ((4.0e-3, 4.2e-3), (4.0e-3, 4.0e-3), (4.0e-3, 3.4e-3)):
        found = nameplate.following(stated(inductance_d=d, inductance_q=q), {})
        assert (found["inductance_d"], found["inductance_q"]) == pytest.approx((1e3 * d, 1e3 * q))


def test_a_segment_of_the_polarity_test_is_as_long_as_the_drives():
    source = "".join((ROOT / f"estimators/polarity.{ending}").read_text(encoding="utf-8") for ending in "ch")
    said = {name: int(number) for name, number in re.findall(r"#define (\w+) (\d+)", source)}
    assert said["POLARITY_SEGMENT"] == similarity.SEGMENT
    for name, degrees in (("ACCEL_LEAST_Q8", 1.5), ("ACCEL_MOST_Q8", 10.0)):
        assert said[name] / 256 * similarity.SEGMENT**2 == pytest.approx(degrees / 360 * 2**32)
    size = similarity.REFERENCE
    usual = size.turn(1.0, similarity.SEGMENT)
    for degrees, periods in ((10.1, 20), (9.9, 40), (1.51, 40), (1.49, 80), (0.38, 80), (0.37, 160), (0.01, 160)):
        assert size.segment(math.radians(degrees) / usual) == periods, degrees


def test_the_reference_is_motor_a(native):
    plant = profile.load("ideal", core.plant_schema(native), core.parameters(native), "A").plant
    assert similarity.of(plant) == similarity.REFERENCE


@pytest.mark.parametrize("scales", [(5, 1), (-4, -5), (2, -3)])
def test_the_same_machine_in_other_units_keeps_the_defaults(native, scales):
    """So every rule has the dimensions of what it says: a machine that runs bit for bit alike is told alike."""
    plant = {
        section: {key: larger(value, PLANT.get(section, {}).get(key, (0, 0)), scales) for key, value in keys.items()}
        for section, keys in stated().items()
    }
    told = nameplate.following(plant, {"current_limit": larger(14.0, (1, 0), scales), "speed_limit": 3300})
    told |= dict(zip(SCALES, map(float, scales), strict=True))
    assert similarity.follow(plant, told, core.at_scale(core.parameters(native), told)) == {}


@pytest.mark.parametrize("name", NAMES)
def test_what_follows_for_a_motor_of_the_catalogue_is_within_the_ranges_and_its_file_goes_before(native, name):
    schema, known = core.plant_schema(native), core.parameters(native)
    loaded = profile.load(name, schema, known, name, checked=False)
    entries = core.at_scale(known, loaded.parameters)
    assert loaded.by_rule, "each is of another size"
    for parameter in loaded.by_rule:
        core.parameter(entries, parameter, loaded.parameters[parameter], name)
    told = dict.fromkeys(loaded.by_rule, 1.0)
    assert not set(similarity.follow(loaded.plant, told, entries)) & set(told)


def test_a_nameplate_that_is_not_complete_has_no_size(native):
    plant = stated()
    del plant["mechanics"]["inertia"]
    assert similarity.follow(plant, {}, core.parameters(native)) == {}


def test_speeds_go_by_the_base_speed(native):
    for name in (
        "blend_low",
        "blend_high",
        "flux_low",
        "flux_high",
        "if_speed",
        "spin_speed",
    ):
        assert times(native, name, volts=1200.0) == 4.0
        assert times(native, name, volts=600.0, current_range=40.0) == 2.0
    assert followed(native, {"speed_limit": 900.0}, volts=1200.0)["spin_speed"] == 900.0


def test_the_spin_is_no_faster_than_its_pulses_alternate(native):
    """In size, not in name: what is said of the EMF's share of the link holds for each motor of the catalogue."""
    for name in NAMES:
        loaded = profile.load(name, core.plant_schema(native), core.parameters(native), name, checked=False)
        told = loaded.parameters
        emf = told["pole_pairs"] * told["magnet_flux"] * told.get("spin_speed", 600.0) * math.pi / 30.0
        assert emf <= 0.15 * loaded.plant["link"]["source_voltage"], name
    assert times(native, "spin_speed", magnet_flux=0.19) == pytest.approx(546.6 / 600.0, rel=1e-3)


def test_a_ramp_is_a_share_of_what_the_machine_accelerates_with_but_not_faster_to_its_base_speed(
    native,
):
    assert times(native, "speed_ramp", inertia=4 * 0.00455) == 0.25
    assert times(native, "speed_ramp", inertia=0.00455 / 8) == 1.0
    assert times(native, "if_acceleration", inertia=0.00455 / 8) == 8.0


def test_a_speed_error_asks_for_no_larger_share_of_the_rated_current_than_with_the_reference(
    native,
):
    """Predictive law: of the error so much is closed in a step, by so many amperes for a rad/s."""

    def amperes(inertia):
        step = similarity.REFERENCE.torque_per_ampere * 1e-3 / inertia
        weight = 200.0 * times(native, "speed_alpha", inertia=inertia) * step**2
        return weight / (1.0 + weight) / step

    usual = amperes(0.00455)
    assert amperes(0.00455 * 5.0) == pytest.approx(usual, rel=0.01)
    assert amperes(0.00455 / 5.0) == pytest.approx(usual / 5.0, rel=0.01)


def test_torques_of_the_load_observer_go_by_the_rated_one(native):
    for name in ("observer_load_rate", "observer_load_quiet", "observer_load_step"):
        assert times(native, name, current=4 * 10.8894, inertia=4 * 0.00455) == 4.0


def test_a_load_is_followed_the_slower_the_sharper_the_angle_is_seen(native):
    """What turns with the current would be taken for a load, and fed back as a current."""
    assert times(native, "observer_load_rate", inductance_d=4.9e-4, inductance_q=7.8e-4) == 0.25
    for name in NAMES:
        loaded = profile.load(
            name,
            core.plant_schema(native),
            core.parameters(native),
            name,
            checked=False,
        )
        size = similarity.of(loaded.plant)
        rate = loaded.parameters.get("observer_load_rate")
        if rate and "observer_load_rate" in loaded.by_rule:
            assert size.loop_of_load(rate) <= 2.05 * similarity.REFERENCE.loop_of_load(1.0), name


def told_of(native, **changes):
    """A machine and the current of its polarity test."""
    size = dataclasses.replace(similarity.REFERENCE, **changes)
    return size, followed(native, **changes).get("polarity_current", 3.0)


@pytest.mark.parametrize(
    ("inertia", "periods", "current"),
    [
        (1 / 50, 20, 0.75),
        (0.1, 20, 3.0),
        (1.0, 40, 3.0),
        (1.4, 40, 3.0),
        (2.0, 80, 3.0),
        (5.0, 80, 3.0),
        (20.0, 160, 3.0),
    ],
)
def test_the_polarity_test_of_a_heavy_shaft_lasts_longer_and_a_light_one_has_less_current(
    native, inertia, periods, current
):
    size, told = told_of(native, inertia=inertia * 0.00455)
    assert (size.segment(told), told) == (periods, current)
    assert size.turn(told, periods) < similarity.TURN_MOST


def test_the_polarity_test_has_more_current_where_the_angle_is_seen_less_sharply(
    native,
):
    usual = similarity.REFERENCE.clearness(3.0)
    for share, current in ((0.8, 3.0), (0.5, 6.0), (0.3, 10.89)):
        step = share * similarity.REFERENCE.saliency
        size, told = told_of(native, inductance_q=1.0 / (1.0 / 4.9e-3 - step))
        assert told == pytest.approx(current, rel=1e-3)
        assert size.clearness(told) >= usual / 2.0


def test_the_current_of_the_polarity_test_is_one_that_the_link_reverses(native):
    size, told = told_of(native, inertia=100 * 0.00455, volts=30.0)
    assert told == 6.0 <= size.current_that_follows(told)
    assert size.current_that_follows(size.current) < size.current


def test_the_estimator_of_a_start_is_faster_where_the_shaft_is(native):
    for name in ("avv_bandwidth_long", "avv_bandwidth_short"):
        assert times(native, name, inertia=0.00455 / 4) == 2.0
        assert times(native, name, inertia=0.00455 * 4) == 1.0
        assert times(native, name, inertia=0.00455 / 4, inductance_q=4.9e-3) == 1.0


def test_the_estimator_of_a_start_is_slower_where_its_loop_over_the_turn_of_the_axis_closes(native):
    """The loop goes by the inertia; a shaft eight times as heavy would have eight times the reference's."""
    for name in ("avv_bandwidth_long", "avv_bandwidth_short"):
        assert times(native, name, inertia=0.00455 * 8) == 0.5
        assert times(native, name, inertia=0.00455 * 32) == 0.25
        assert times(native, name, inertia=0.00455 * 8, inductance_q=4.9e-3) == 1.0


def test_the_band_of_the_drops_is_narrower_where_the_ripple_is_less(native):
    for factor, expected in ((4.0, 0.25), (2.0, 0.5), (1.1, 1.0), (0.25, 1.0)):
        changes = {"inductance_d": 4.9e-3 * factor, "inductance_q": 7.8e-3 * factor}
        assert times(native, "drop_band", **changes) == expected
    assert times(native, "drop_band", current_range=80.0) == 1.0  # of the board's size, which is four times as large


def test_the_spin_shows_an_emf_beside_what_the_devices_leave(native):
    """Of a weak magnet: a sixteenth of the link's voltage at least."""
    for flux, expected in ((0.08, 1.0), (0.06, 2.0), (0.035, 4.0)):
        assert times(native, "spin_speed", magnet_flux=flux, inductance_q=20e-3) >= expected / 2.0
        told = followed(native, magnet_flux=flux, inductance_q=20e-3).get("spin_speed", 600.0)
        assert 4 * flux * told * math.pi / 30.0 >= 0.062 * 300.0
    assert followed(native, {"speed_limit": 700.0}, magnet_flux=0.02)["spin_speed"] == 700.0


def test_the_current_loop_is_faster_than_what_swings_by_itself(native):
    light = dataclasses.replace(similarity.REFERENCE, inertia=0.00455 / 50.0)
    told = {"polarity_current": 0.1}  # a usual segment
    assert followed(native, told, inertia=light.inertia)["current_bandwidth"] == pytest.approx(2.1 * light.swing, abs=1)
    assert followed(native, inertia=0.00455 / 500.0)["current_bandwidth"] == 2600.0
    told = {"current_divider": 2.0}
    assert followed(native, told, inertia=0.00455 / 500.0)["current_bandwidth"] == 2080.0


def test_the_current_loop_is_faster_where_a_segment_of_the_polarity_test_is_the_shortest(native):
    light = dataclasses.replace(similarity.REFERENCE, inertia=0.00455 / 30.0)
    assert followed(native, inertia=light.inertia)["current_bandwidth"] == pytest.approx(2.8 * light.swing, abs=1.0)
    assert followed(native, inertia=0.00455 / 60.0)["current_bandwidth"] == 2600.0
    smooth = dataclasses.replace(light, inductance_q=4.9e-3)  # is not asked for its polarity
    told = followed(native, inertia=light.inertia, inductance_q=4.9e-3)["current_bandwidth"]
    assert told == pytest.approx(2.1 * smooth.swing, abs=1.0)


@pytest.mark.parametrize(
    ("changes", "factor"),
    [
        ({}, 1.0),
        ({"inertia": 1.9 * 0.00455}, 1.0),
        ({"inertia": 2.1 * 0.00455}, 2.0),
        ({"inertia": 40 * 0.00455}, 4.0),
        ({"inertia": 0.00455 / 4, "inductance_d": 4.9e-4, "inductance_q": 7.8e-4}, 2.0),
        ({"inertia": 40 * 0.00455, "inductance_q": 5.4e-3}, 0.5),
    ],
)
def test_a_sharp_angle_on_a_heavy_rotor_is_told_as_a_noisier_one(changes, factor):
    plant = stated(**changes)
    assert observer_noise.times(plant) == factor
    assert nameplate.following(plant, {})["observer_noise"] == 100.0 * factor
    assert "observer_noise" not in nameplate.following(plant, {"observer_noise": 70.0})
    del plant["mechanics"]
    assert observer_noise.times(plant) == 1.0


@pytest.mark.parametrize(
    ("ripple", "factor"), [(0.1, 0.5), (1.9, 0.5), (2.1, 1.0), (7.9, 2.0), (8.1, 4.0), (40.0, 4.0)]
)
def test_without_saliency_the_noise_goes_by_what_an_inductance_that_is_off_makes_of_a_pulse(ripple, factor):
    """A pulse of 42 us and two thirds of the link; a twentieth of it over 5 mA for each of 20 A."""
    inductance = 2.0 / 3.0 * 300.0 * 42e-6 / ripple
    plant = stated(inductance_d=inductance, inductance_q=inductance)
    assert observer_noise.times(plant) == factor


def test_the_watch_over_synchronism_bears_what_the_sensors_noise_looks_like(native):
    assert times(native, "synchronism_floor", inductance_q=8 * 7.8e-3) == 8.0
    assert times(native, "synchronism_floor", inductance_q=7.8e-3 / 2) == 1.0
