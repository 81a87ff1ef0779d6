"""Amperes and volts of the drive's formats: a motor of another size is the same motor in other units."""

import importlib
import re
from pathlib import Path

import numpy as np
import pytest

from stillspin import can, core
from stillspin.cases import nameplate, profile
from stillspin.scales import POWERS, SCALES, exponent

ROOT = Path(__file__).resolve().parents[2]
PLANT = {
    "machine": {"resistance": (-1, 1), "inductance_d": (-1, 1), "inductance_q": (-1, 1), "magnet_flux": (0, 1),
                "rated_peak_current": (1, 0), "cross_inductance": (-1, 1)},
    "mechanics": {"inertia": (1, 1), "viscous_friction": (1, 1)},
    "link": {"source_voltage": (0, 1)},
    "adc": {"current_range": (1, 0), "voltage_range": (0, 1)},
}  # fmt: skip
"""By entry: how often it has the unit of a current and that of a voltage in it."""


@pytest.fixture(scope="module")
def native():
    return importlib.import_module("stillspin._core")


def listed_units():
    rows = re.findall(
        r'^UNIT\(\w+, "([^"]*)", (-?\d), (-?\d)\)', (ROOT / "firmware/dictionary/unit_list.h").read_text(), re.M
    )
    return {text: (int(current), int(voltage)) for text, current, voltage in rows}


def test_the_client_knows_the_units_as_the_firmware_does(native):
    scaled = {unit: powers for unit, powers in listed_units().items() if powers != (0, 0)}
    assert scaled == POWERS
    for row in native.parameters():
        assert row["unit"] in listed_units(), row["name"]


def larger(value, powers, scales):
    return value * 2.0 ** (powers[0] * scales[0] + powers[1] * scales[1])


def ran(native, scales):
    """Motor A in `ideal`, started, turned and loaded; all of it so many times larger in amperes and in volts."""
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load("ideal", schema, known)
    plant = profile.merged(chosen.plant, {"solver": {"method": "rk4"}})
    for section, keys in PLANT.items():
        for key, powers in keys.items():
            value = plant.get(section, {}).get(key, schema[section][key].default)
            plant.setdefault(section, {})[key] = larger(value, powers, scales)
    told = {name: value * 2.0 ** exponent(known[name].unit, scales) for name, value in chosen.parameters.items()}
    told |= dict(zip(SCALES, map(float, scales), strict=True))
    load = larger(4.0, (1, 1), scales)
    result = native.run(
        plant=plant,
        parameters=told,
        commands=[(0.0, "speed_ref_rpm", 300.0)],
        load=[(0.0, 0.0), (0.3, 0.0), (0.31, load), (10.0, load)],
        duration=0.5,
        max_start=2.0,
        record_every=10,
        waveform=(0.0, 0.0, 1),
        seed=1,
        progress=None,
    )
    assert result.completed, result.reason
    return result.signals


@pytest.mark.parametrize("scales", [(5, 1), (-4, -5), (2, -3)])
def test_a_motor_of_another_size_runs_bit_for_bit_alike(native, scales):
    """A large or a small machine is motor A in other units of current and voltage, to the last bit."""
    small, large = ran(native, (0, 0)), ran(native, scales)
    for name in ("time", "est_angle", "est_speed", "state", "weight"):
        assert np.array_equal(small[name], large[name], equal_nan=True), name
    for name, powers in {"i_q": (1, 0), "v_q": (0, 1), "load_estimate": (1, 1), "v_link": (0, 1)}.items():
        assert np.array_equal(larger(small[name], powers, scales), large[name], equal_nan=True), name
    # The plant reckons in SI units, where a step may be rounded another way.
    for name, powers in {"true_angle": (0, 0), "true_speed": (0, 0), "true_i_q": (1, 0), "torque": (1, 1)}.items():
        assert np.allclose(
            larger(small[name], powers, scales), large[name], rtol=1e-9, atol=larger(1e-9, powers, scales)
        ), name


@pytest.mark.parametrize(
    ("amperes", "volts", "expected"),
    [
        (20.0, 450.0, {}),
        (40.0, 225.0, {}),
        (41.0, 451.0, {"current_scale": 1.0, "voltage_scale": 1.0}),
        (19.9, 224.0, {"current_scale": -1.0, "voltage_scale": -1.0}),
        (857.0, 15.0, {"current_scale": 5.0, "voltage_scale": -4.0}),
    ],
)
def test_the_scales_follow_from_the_ranges_of_the_board(amperes, volts, expected):
    assert nameplate.scales({"adc": {"current_range": amperes, "voltage_range": volts}}) == expected


@pytest.mark.parametrize(
    ("inertia", "expected"),
    [
        (6.8e-5, {"voltage_scale": 1.0}),
        (6.7e-5 * 2, {"voltage_scale": 1.0}),
        (6.7e-5, {}),
        (3.3e-5, {"current_scale": -1.0}),
        (1.6e-5, {"voltage_scale": -1.0, "current_scale": -1.0}),
        (4.3e-6, {"voltage_scale": -1.0, "current_scale": -2.0}),
        (4.2e-6, {"voltage_scale": 1.0}),
    ],
)
def test_a_light_rotor_has_lower_scales_if_they_hold_it(inertia, expected):
    plant = {
        "adc": {"current_range": 20.0, "voltage_range": 465.0},
        "machine": {"pole_pairs": 2.0},
        "mechanics": {"inertia": inertia},
    }
    assert nameplate.scales(plant) == expected


def test_the_voltage_of_a_link_bounds_the_scale_of_a_light_rotor():
    plant = {
        "adc": {"current_range": 20.0, "voltage_range": 450.0},
        "machine": {"pole_pairs": 2.0},
        "mechanics": {"inertia": 4.3e-6},
        "link": {"source_voltage": 250.0},
    }
    assert nameplate.scales(plant) == {"voltage_scale": -2.0, "current_scale": -1.0}
    plant["link"]["source_voltage"] = 251.0
    assert nameplate.scales(plant) == {"voltage_scale": -1.0, "current_scale": -2.0}


def test_a_bus_is_described_in_the_steps_of_its_node():
    plain, scaled = (can.cantools.database.load_string(can.text_of([], 3, scales)) for scales in ((0, 0), (5, -2)))
    for message in plain.messages:
        for signal in message.signals:
            factor = {"A": 32.0, "V": 0.25, "Nm": 8.0}.get(signal.unit, 1.0)
            assert (
                scaled.get_message_by_name(message.name).get_signal_by_name(signal.name).scale == signal.scale * factor
            )


def test_a_schema_without_a_board_allows_what_some_board_has(native):
    """400 A are wrong for sensors of 20 A and right for others; no drive has 20 000 A."""
    known = core.parameters(native)
    assert known["current_limit"].maximum == 100.0
    wide = core.at_some_scale(known)
    assert wide["current_limit"].maximum == 100.0 * 64 and wide["current_limit"].minimum == 0.5 / 64
    assert wide["stator_resistance"].maximum == known["stator_resistance"].maximum * 4096
    assert wide["speed_ramp"] == known["speed_ramp"]
