"""A stand-in for the native module `stillspin._core`, for tests of the Python code around it.

The "motor" is a first-order lag with a load dip, the "estimator" the true angle plus a slow wobble and a little noise.
It has nothing to do with a real drive; what it keeps is the interface and determinism in the seed. Special values make
it fail on purpose: `inverter.dead_short = true` faults, `friction = 99` in the firmware never turns the shaft.
"""

from __future__ import annotations

import struct
import time as clock
from types import SimpleNamespace

import numpy as np

from stillspin.drive.protocol import VERSION, Request
from stillspin.link.records import ANSWER, Record, to_wire
from stillspin.link.splitter import Splitter

SAMPLE = 1e-4  # s, one PWM period

_SCHEMA = {
    "machine": {
        "pole_pairs": ("", 1, 50, 4),
        "resistance": ("Ohm", 1e-4, 100.0, 0.32),
        "inductance_d": ("H", 1e-6, 1.0, 0.0049),
        "inductance_q": ("H", 1e-6, 1.0, 0.0078),
        "magnet_flux": ("Vs", 0.0, 10.0, 0.16),
        "rated_peak_current": ("A", 0.1, 1000.0, 10.9),
        "saturation": ("", None, None, True),
        "cross_inductance": ("H", -0.01, 0.01, 1.18e-4),
        "emf_harmonic_5": ("", 0.0, 0.3, 0.02),
        "emf_harmonic_7": ("", 0.0, 0.3, 0.01),
    },
    "mechanics": {
        "inertia": ("kg m2", 1e-6, 100.0, 0.00455),
        "viscous_friction": ("N m s", 0.0, 10.0, 0.003),
        "cogging_torque": ("N m", 0.0, 10.0, 0.1),
        "locked": ("", None, None, False),
    },
    "inverter": {
        "switch_threshold": ("V", 0.0, 10.0, 1.0),
        "switch_resistance": ("Ohm", 0.0, 10.0, 0.04),
        "diode_threshold": ("V", 0.0, 10.0, 0.9),
        "diode_resistance": ("Ohm", 0.0, 10.0, 0.03),
        "turn_on_delay": ("ticks", 0, 1000, 30),
        "turn_off_delay": ("ticks", 0, 1000, 60),
        "dead_short": ("", None, None, False),
    },
    "link": {
        "source_voltage": ("V", 1.0, 2000.0, 300.0),
        "stiff": ("", None, None, False),
        "source_resistance": ("Ohm", 1e-3, 1000.0, 0.3),
        "capacitance": ("F", 1e-6, 1.0, 2e-3),
        "ripple": ("", 0.0, 0.5, 0.01),
        "ripple_frequency": ("Hz", 0.0, 5000.0, 300.0),
        "rectifier": ("", None, None, False),
        "brake_chopper": ("", None, None, False),
        "brake_on_voltage": ("V", 1.0, 5000.0, 400.0),
        "brake_off_voltage": ("V", 1.0, 5000.0, 390.0),
        "brake_resistance": ("ohm", 0.1, 10000.0, 47.0),
    },
    "sensor": {
        "count": ("", 2, 3, 2),
        "bandwidth": ("Hz", 0.0, 1e8, 150e3),
        **{f"gain_{phase}": ("A/A", 0.5, 1.5, 1.0) for phase in "abc"},
        **{f"offset_{phase}": ("A", -5.0, 5.0, 0.0) for phase in "abc"},
        "ring_amplitude": ("A", 0.0, 10.0, 0.3),
        "ring_frequency": ("Hz", 1e3, 5e6, 200e3),
        "ring_decay": ("s", 1e-8, 1e-4, 2e-6),
    },
    "adc": {
        "current_range": ("A", 0.1, 10000.0, 20.0),
        "voltage_range": ("V", 1.0, 5000.0, 450.0),
        "voltage_gain": ("V/V", 0.5, 1.5, 1.01),
        "noise": ("LSB", 0.0, 100.0, 1.2),
        "inl": ("LSB", 0.0, 50.0, 1.5),
    },
    "parameter_error": dict.fromkeys(
        ("resistance", "inductance_d", "inductance_q", "magnet_flux", "inertia"), ("", -0.9, 9.0, 0.0)
    ),
    "solver": {"method": ("", None, None, "rk4")},
}
_CHOICES = {"solver.method": ["rk4", "erkstep", "reference"]}

_PARAMETERS = [
    (1, "pole_pairs", "", 0, 1.0, 20.0, 4.0, "STOPPED", "pole pairs"),
    (2, "stator_resistance", "ohm", 4, 0.001, 20.0, 0.32, "STOPPED", "stator resistance of a phase"),
    (3, "inductance_d", "mH", 3, 0.05, 200.0, 4.9, "STOPPED", "d-axis inductance"),
    (4, "inductance_q", "mH", 3, 0.05, 200.0, 7.8, "STOPPED", "q-axis inductance"),
    (5, "magnet_flux", "Vs", 5, 0.002, 0.9, 0.16, "STOPPED", "magnet flux linkage"),
    (520, "rated_current", "A", 2, 0.0, 100.0, 0.0, "STOPPED", "rated phase current"),
    (8, "current_limit", "A", 2, 0.5, 100.0, 14.0, "STOPPED", "largest phase current"),
    (26, "current_full_scale", "A", 2, 1.0, 200.0, 20.0, "STOPPED", "current at ADC code 4096"),
    (27, "link_full_scale", "V", 1, 10.0, 2000.0, 450.0, "STOPPED", "DC-link voltage at ADC code 4096"),
    (28, "link_minimum", "V", 1, 10.0, 1000.0, 150.0, "STOPPED", "DC-link voltage below which the drive faults"),
    (29, "link_maximum", "V", 1, 10.0, 1500.0, 420.0, "STOPPED", "DC-link voltage above which the drive faults"),
    (30, "trip_current", "A", 2, 0.5, 194.0, 18.0, "STOPPED", "software over-current limit"),
    (88, "weakening_limit", "A", 2, 0.0, 100.0, 12.0, "STOPPED", "largest field-weakening current"),
    (110, "map_current", "A", 2, 1.0, 100.0, 14.0, "STOPPED", "i_q of the inductance map's last point"),
    (7, "friction", "Nms", 5, 0.0, 500.0, 0.003, "STOPPED", "viscous friction"),
    (20, "dead_time", "us", 2, 0.0, 5.0, 2.0, "STOPPED", "dead band of the gate signals"),
    (21, "turn_on_delay", "us", 2, 0.0, 2.0, 0.3, "STOPPED", "turn-on delay"),
    (22, "turn_off_delay", "us", 2, 0.0, 2.0, 0.6, "STOPPED", "turn-off delay"),
    (23, "device_drop", "V", 3, 0.0, 5.0, 0.95, "STOPPED", "on-state drop of a device"),
    (9, "speed_limit", "rpm", 0, 10.0, 6000.0, 3300.0, "STOPPED", "largest speed reference"),
    (24, "device_resistance", "ohm", 4, 0.0, 1.0, 0.035, "STOPPED", "on-state resistance of a device"),
    (25, "drop_band", "A", 2, 0.01, 2.0, 0.2, "ALWAYS", "current below which its sign is not trusted"),
    (40, "excitation", "", 0, 0.0, 5.0, 3.0, "STOPPED", "pulse pattern"),
    (6, "inertia", "kgm2", 6, 0.0001, 0.5, 0.00455, "STOPPED", "inertia of rotor and load"),
    (41, "pulse_time", "us", 2, 15.0, 47.0, 42.0, "ALWAYS", "mean pulse of the alternating layout"),
    (164, "link_regulation", "V", 1, 10.0, 1500.0, 405.0, "ALWAYS", "DC-link voltage from which braking is reduced"),
    (42, "window_minimum", "us", 2, 5.0, 30.0, 18.0, "ALWAYS", "shortest extended vector"),
    (43, "window_maximum", "us", 2, 5.0, 40.0, 30.0, "ALWAYS", "longest extended vector"),
    (45, "settle_time", "us", 2, 4.0, 25.0, 10.5, "ALWAYS", "from an edge to the first sample"),
    (60, "position_source", "", 0, 0.0, 8.0, 4.0, "STOPPED", "where the angle comes from"),
    (61, "blend_low", "rpm", 1, 5.0, 1000.0, 60.0, "STOPPED", "speed below which the low-speed estimator is used"),
    (62, "blend_high", "rpm", 1, 6.0, 2000.0, 100.0, "STOPPED", "speed above which AVV is used"),
    (66, "observer_noise", "mA", 1, 1.0, 1000.0, 100.0, "ALWAYS", "rms error of the current change over 33 us"),
    (67, "observer_load_rate", "Nm", 2, 0.01, 100.0, 0.6, "ALWAYS", "load change per 10 ms"),
    (75, "observer_load_quiet", "Nm", 2, 0.01, 100.0, 0.05, "ALWAYS", "load change per 10 ms at a crawl"),
    (68, "observer_windows", "", 0, 0.0, 1.0, 1.0, "ALWAYS", "windows of the observer"),
    (71, "id_low_speed", "A", 2, -10.0, 10.0, 0.0, "ALWAYS", "d-axis current below the blend"),
    (44, "zero_time", "us", 2, 0.0, 50.0, 0.0, "ALWAYS", "zero vector beside the extended ones"),
    (83, "speed_trajectory", "ms", 1, 2.0, 200.0, 7.0, "STOPPED", "time constant of the trajectory"),
    (69, "zvv_proportional", "rad/s", 1, 0.1, 200.0, 11.0, "ALWAYS", "Kp of ZVV"),
    (70, "zvv_integral", "rad/s2", 1, 0.0, 2000.0, 1100.0, "ALWAYS", "Ki of ZVV"),
    (311, "paper_terms", "", 0, 0.0, 127.0, 127.0, "STOPPED", "what it has beside the print"),
    (82, "speed_alpha", "A2s2", 0, 1.0, 100000.0, 200.0, "STOPPED", "weight of the predicted speed error"),
    (81, "speed_law", "", 0, 0.0, 1.0, 0.0, "STOPPED", "0 predictive, 1 PI"),
    (86, "speed_ramp", "rpm/s", 0, 0.0, 100000.0, 3000.0, "ALWAYS", "slope of the speed reference"),
    (90, "position_hold", "1/s", 1, 0.0, 20.0, 5.0, "ALWAYS", "how fast the shaft is brought back"),
    (103, "polarity_check", "", 0, 0.0, 1.0, 1.0, "STOPPED", "test the polarity of the magnet at start"),
    (163, "synchronism_time", "ms", 0, 1.0, 1000.0, 5.0, "ALWAYS", "how long a loss of synchronism lasts"),
    (170, "encoder_trim", "deg", 2, -180.0, 180.0, 0.0, "ALWAYS", "added to the angle of the encoder"),
    (171, "current_law", "", 0, 0.0, 1.0, 0.0, "STOPPED", "0 PI, 1 hysteresis"),
    (173, "hysteresis_frequency", "kHz", 2, 0.0, 25.0, 10.0, "ALWAYS", "switching frequency"),
    (300, "flux_cutoff", "rad/s", 1, 2.0, 150.0, 2.0, "STOPPED", "least cut-off"),
    (
        301,
        "flux_bandwidth",
        "rad/s",
        0,
        10.0,
        600.0,
        100.0,
        "ALWAYS",
        "bandwidth of the observer behind the stator flux",
    ),
    (302, "flux_adapt", "", 0, 0.0, 3.0, 1.0, "ALWAYS", "what the stator flux learns"),
    (303, "flux_low", "rpm", 1, 1.0, 2000.0, 350.0, "STOPPED", "below it the observer is used"),
    (304, "flux_high", "rpm", 1, 2.0, 3000.0, 500.0, "STOPPED", "above it the stator flux is used"),
    (305, "flux_beside", "", 0, 0.0, 4.0, 0.0, "STOPPED", "a method that looks on"),
    (306, "flux_plain", "", 0, 0.0, 3.0, 0.0, "STOPPED", "the low-pass as it is, or as printed"),
    (330, "mtpa", "", 0, 0.0, 1.0, 0.0, "ALWAYS", "least current for a torque"),
    (331, "current_divider", "", 0, 1.0, 2.0, 1.0, "STOPPED", "periods per step of the current control"),
    (332, "current_corner", "", 0, 0.0, 1.0, 0.0, "STOPPED", "corner of the integrator"),
    (340, "start_method", "", 0, 0.0, 1.0, 0.0, "STOPPED", "how a standing shaft is started"),
    (111, "lqq_1", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (112, "lqq_2", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (113, "lqq_3", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (114, "lqq_4", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (115, "ldd_1", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (116, "ldd_2", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (117, "ldd_3", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (118, "ldd_4", "%", 2, 20.0, 150.0, 100.0, "STOPPED", "the map of the inductances"),
    (119, "ldq_1", "mH", 4, -100.0, 100.0, 0.0, "STOPPED", "the map of the inductances"),
    (120, "ldq_2", "mH", 4, -100.0, 100.0, 0.0, "STOPPED", "the map of the inductances"),
    (121, "ldq_3", "mH", 4, -100.0, 100.0, 0.0, "STOPPED", "the map of the inductances"),
    (122, "ldq_4", "mH", 4, -100.0, 100.0, 0.0, "STOPPED", "the map of the inductances"),
    (123, "map_known", "", 0, 0.0, 1.0, 0.0, "STOPPED", "1: the map is the machine's"),
    (174, "slice_time", "us", 2, 5.0, 20.0, 5.0, "STOPPED", "interval of the decisions"),
]

SIGNALS = {
    "time": "s", "true_angle": "rad", "est_angle": "rad", "true_speed": "rpm", "est_speed": "rpm", "speed_ref": "rpm",
    "torque": "N m", "load_torque": "N m", "i_a": "A", "i_b": "A", "i_c": "A", "true_i_d": "A", "true_i_q": "A",
    "i_d": "A", "i_q": "A", "i_d_ref": "A", "i_q_ref": "A", "v_d": "V", "v_q": "V", "v_alpha": "V", "v_beta": "V",
    "v_link": "V", "deviation_q": "A/s", "v_dc": "V", "angle_zvv": "rad",
    "angle_avv": "rad", "weight": "", "load_estimate": "N m", "state": "", "fault": "",
    "start_phase": "", "polarity_sigma": "", "limit": "",
    "true_load_angle": "rad", "load_angle": "rad", "magnet_flux": "Vs",
    "told_angle": "1/rad^2", "told_cross": "s/rad^2", "told_speed": "s^2/rad^2",
}  # fmt: skip


_LOOKED_AT_NOTHING = {"raster": {"time": np.zeros(0)}}


def plant_schema():
    return {
        section: {
            key: {
                "unit": unit,
                "minimum": low,
                "maximum": high,
                "default": default,
                "help": f"{key} of the {section}",
                **({"choices": _CHOICES[f"{section}.{key}"]} if f"{section}.{key}" in _CHOICES else {}),
            }
            for key, (unit, low, high, default) in keys.items()
        }
        for section, keys in _SCHEMA.items()
    }


def parameters():
    names = ("id", "name", "unit", "decimals", "minimum", "maximum", "default", "access", "help")
    whole = ("pole_pairs", "excitation", "observer_windows", "speed_law")
    return [dict(zip(names, row, strict=True)) | {"whole": row[1] in whole} for row in _PARAMETERS]


def names():
    return [row[1] for row in _PARAMETERS] + list(SIGNALS)


def check_parameters(parameters):
    """Everything fits together here."""


def signals():
    return [{"name": name, "unit": unit, "help": name} for name, unit in SIGNALS.items()]


def _ramped(target, slope):
    """The reference follows its target with a bounded slope, 0 for a jump."""
    if slope == 0.0:
        return target
    out = np.zeros_like(target)
    now = 0.0
    for index, wanted in enumerate(target):
        now += min(max(wanted - now, -slope * SAMPLE), slope * SAMPLE)
        out[index] = now
    return out


def _lag(values, constant):
    out = np.zeros_like(values)
    now = 0.0
    for index, value in enumerate(values):
        now += (value - now) * SAMPLE / constant
        out[index] = now
    return out


def run(
    *, plant, parameters, commands, load, duration, max_start, record_every, waveform, seed, progress, recording=None
):
    began = clock.perf_counter()
    for share in (0.25, 0.5, 0.75, 1.0):
        if progress is not None and not progress(share):
            return SimpleNamespace(
                signals={"time": np.zeros(0)},
                waveform=_LOOKED_AT_NOTHING,
                completed=False,
                reason="stopped",
                faults=[],
                stats={},
            )
    time = np.arange(-0.05, duration + SAMPLE / 2, SAMPLE)
    at = np.array([-1.0] + [row[0] for row in commands if row[1] == "speed_ref_rpm"])
    value = np.array([0.0] + [row[2] for row in commands if row[1] == "speed_ref_rpm"])
    target = value[np.searchsorted(at, time, side="right") - 1]
    reference = _ramped(target, parameters.get("speed_ramp", 3000.0))
    torque = np.interp(time, *zip(*load, strict=True)) if load else np.zeros_like(time)
    constant = 0.012 if parameters.get("speed_law", 0.0) == 0.0 else 0.03
    lag = _lag(torque, 0.05)
    speed = _lag(reference, constant) - 1000.0 * constant * (torque - lag)
    if parameters.get("friction") == 99.0:
        speed = np.zeros_like(speed)
    noise = np.random.default_rng(seed).normal(0.0, plant.get("adc", {}).get("noise", 1.2), time.size)
    pairs = plant.get("machine", {}).get("pole_pairs", 4)
    angle = 0.3 + np.cumsum(speed) * SAMPLE * 2.0 * np.pi / 60.0 * pairs
    used = angle - np.radians(0.3 * np.sin(2.0 * np.pi * 1.3 * time) + 0.05 * noise)
    current = torque / 0.96 + 0.5
    phases = [-current * np.sin(angle - shift * 2.0 * np.pi / 3.0) for shift in range(3)]
    zero = np.zeros_like(time)
    data = {
        "time": time, "true_angle": np.remainder(angle + np.pi, 2 * np.pi) - np.pi,
        "est_angle": np.remainder(used, 2 * np.pi), "true_speed": speed, "est_speed": speed + 0.2 * noise,
        "speed_ref": reference, "torque": lag, "load_torque": torque,
        "i_a": phases[0], "i_b": phases[1], "i_c": phases[2],
        "true_i_d": zero, "true_i_q": current, "i_d": 0.01 * noise, "i_q": current + 0.01 * noise, "i_d_ref": zero,
        "i_q_ref": current, "v_d": zero, "v_q": speed * 0.067, "v_alpha": zero, "v_beta": zero,
        "v_link": zero + 300.0, "deviation_q": zero, "v_dc": zero + 300.0,
        "angle_zvv": used, "angle_avv": used,
        "weight": np.clip((100.0 - np.abs(speed)) / 40.0, 0.0, 1.0), "load_estimate": lag,
        "state": np.full(time.size, 4), "fault": np.zeros(time.size, int),
        "start_phase": np.full(time.size, 5), "polarity_sigma": np.full(time.size, 10.0),
        "limit": np.zeros(time.size, int),
        "true_load_angle": 0.02 * current, "load_angle": 0.02 * current + 1e-4 * noise, "magnet_flux": zero + 0.16,
        "told_angle": zero + 1e4, "told_cross": zero, "told_speed": zero + 0.01,
    }  # fmt: skip
    short = plant.get("inverter", {}).get("dead_short", False)
    return SimpleNamespace(
        signals={name: column[:: int(record_every)] for name, column in data.items()},
        waveform=_LOOKED_AT_NOTHING,
        completed=not short,
        reason="over-current at 0.100 s" if short else "",
        faults=[(0.1, "over-current")] if short else [],
        stats={"wall_seconds": clock.perf_counter() - began, "simulated_seconds": duration + 0.05, "plant_share": 0.5},
    )


def commission(*, plant, parameters, limit, seed, progress, recording=None):
    """The friction is refused when it is told as 9, and nothing is found with a dead short."""
    for share in (0.0, 0.5, 1.0):
        if progress is not None and not progress(share, "a phase"):
            return SimpleNamespace(values=[], completed=False, reason="stopped", stats={})
    short = plant.get("inverter", {}).get("dead_short", False)
    open_ = parameters.get("friction") == 9.0
    words = "too far from the value given before" if open_ else "plausible, in use"
    row = {"name": "friction", "unit": "Nms", "decimals": 5, "before": 0.003, "value": 0.004, "used": not open_}
    ramp = {
        "name": "speed_ramp",
        "unit": "rpm/s",
        "decimals": 0,
        "before": 3000.0,
        "value": 2000.0 + seed,
        "used": True,
    }
    return SimpleNamespace(
        values=[] if short else [{**row, "words": words}, {**ramp, "words": "plausible, in use"}],
        completed=not short,
        reason="fault: over-current comparator" if short else "",
        stats={"wall_seconds": 1.0, "simulated_seconds": 40.05, "commissioning_seconds": 40.0},
    )


FIRMWARE = "stillspin fake (edition unknown, board bench, commit 0badcafe, table 12345678)"


class VirtualBoard:
    """Says who it is, and nothing else."""

    def __init__(self, *, plant, parameters, seed):
        self.now = 0
        self._splitter, self._said = Splitter(), b""

    def advance(self, ticks):
        self.now += ticks

    def serial_write(self, octets):
        for item in self._splitter.feed(octets, 0.0):
            if isinstance(item, Record) and item.kind == Request.IDENTITY:
                head = struct.pack("<HHHHI", VERSION, 0, 0, 0, 0x12345678)
                body = head + b"stillspin fake\0bench\0" + struct.pack("<IH", 0x0BADCAFE, 0)
                self._said += to_wire(Record(item.kind | ANSWER, item.tag, b"\0" + body))

    def serial_read(self):
        said, self._said = self._said, b""
        return said

    def close(self):
        """Nothing is kept."""
