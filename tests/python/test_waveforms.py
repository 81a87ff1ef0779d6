"""What is read out of waveforms: patterns from gate edges, switching frequency, spectrum, sweeps and holds."""

import numpy as np
import pytest

from stillspin.cases import scenario_file
from stillspin.measure import deviation_sweep, metrics, pieces, speed_profile, waveforms
from stillspin.runs import variant

DEAD = 200  # ticks of dead band
MACHINE = {
    "resistance": 0.35,
    "device_drop": 0.0,
    "inductance_d": 0.0049,
    "inductance_q": 0.0078,
    "cross_saturation": 0.0,
    "knee": 0.0,
}


def edges(pulses, dead=DEAD):
    """Gate edges of successive periods from pulses (rise, fall) of the three legs, ticks from each period's start."""
    rows = [(0, leg, 0, 1) for leg in range(3)]
    for number, period in enumerate(pulses):
        for leg, (rise, fall) in enumerate(period):
            start = number * waveforms.PERIOD
            rows += [(start + rise, leg, 0, 0), (start + rise + dead, leg, 1, 0)]
            rows += [(start + fall, leg, 0, 0), (start + fall + dead, leg, 0, 1)]
    rows.sort(key=lambda row: row[0])
    at, leg, upper, lower = (np.array(column, dtype=float) for column in zip(*rows, strict=True))
    return {"time": at * 1e-8, "leg": leg, "upper": upper, "lower": lower}


def looked(pulses):
    time = np.arange(0, len(pulses) * waveforms.PERIOD, 100) * 1e-8
    return {"raster": {"time": time}, "edges": edges(pulses), "samples": {"time": time[::50]}}


# On-times 3900, 3300, 3000: T1 = 600 and T2 = 300 ticks, extended to 2000 each.
EXTENDED = ((260, 4160), (2260, 5560), (4260, 7260))
# The same on-times with their middles together: nothing extended.
CENTRED = ((3050, 6950), (3350, 6650), (3500, 6500))


def test_a_pattern_is_read_back_without_the_dead_band():
    first, second = waveforms.patterns(looked([EXTENDED, CENTRED]))
    assert first.on == second.on == (3900, 3300, 3000)
    assert [state for state, _, _ in first.states] == ["000", "100", "110", "010", "011", "001", "000"]
    assert (first.time_in("100"), first.time_in("110")) == (2000, 1900)
    assert sum(last - begin for _, begin, last in first.states) == waveforms.PERIOD


def test_extension_with_its_compensation_is_recognised():
    good = ((260, 4560), (2260, 5960), (4260, 7660))  # 4300, 3700, 3400: hi and mid are still on when lo rises
    late = ((260, 4560), (2260, 5960), (4261, 7661))  # both vectors long enough, a tick more of one
    long = ((260, 7560), (2760, 7560), (5060, 7560))  # vectors of 2500 and 2300 by themselves
    one, shifted, centred, needless = waveforms.patterns(looked([good, late, CENTRED, long]))
    assert waveforms.is_extended(one) is True
    assert waveforms.is_extended(shifted) is True  # the complement gives the tick back
    assert waveforms.is_extended(centred) is False
    assert waveforms.is_extended(needless) is None


def test_voltage_errors_are_in_ticks_of_the_asked_voltage():
    waveform = looked([CENTRED] * 3)
    link = 300.0
    given = np.array([3900.0, 3300.0, 3000.0])
    a, b, c = (given - given.mean()) * link / waveforms.PERIOD
    rows = np.arange(-1, 3) * 1e-4
    asked = {"time": rows, "v_alpha": np.full(4, a), "v_beta": np.full(4, (b - c) / np.sqrt(3)), "v_link": [link] * 4}
    assert waveforms.voltage_errors(waveform, asked) == pytest.approx(np.zeros((3, 3)), abs=1e-6)
    asked["v_alpha"] = asked["v_alpha"] + 3.0 * link / waveforms.PERIOD
    assert waveforms.voltage_errors(waveform, asked)[:, 0] == pytest.approx(-3.0)
    with pytest.raises(ValueError, match="no period"):
        waveforms.voltage_errors(waveform, {name: data[:0] for name, data in asked.items() if name != "v_link"})


def test_switching_frequency_counts_the_upper_devices():
    assert waveforms.switching_frequency(edges([CENTRED] * 50), 50e-4) == pytest.approx(10e3)


def current(time, ripple, frequency=40.0):
    angle = 2.0 * np.pi * frequency * time
    phases = {
        name: 3.0 * np.cos(angle - shift) + ripple * np.sin(2.0 * np.pi * 10e3 * time + shift) + 0.2
        for name, shift in (("i_a", 0.0), ("i_b", 2.1), ("i_c", 4.2))
    }
    return {"time": time, "angle": np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi, **phases}


def test_distortion_is_what_is_neither_fundamental_nor_dc():
    time = np.arange(0.0, 0.311, 1e-6)  # 12.4 electrical periods
    assert waveforms.spectrum(current(time, 0.3)).distortion == pytest.approx(0.1, rel=1e-3)
    # the window's side lobes are what is left of a pure sine
    assert waveforms.spectrum(current(time, 0.0)).distortion < 1e-3
    above = {**current(time, 0.0), "i_a": current(time, 0.0)["i_a"] + np.sin(2.0 * np.pi * 60e3 * time)}
    assert waveforms.spectrum(above).distortion < 1e-3


def test_a_short_waveform_has_no_spectrum():
    with pytest.raises(ValueError, match="electrical periods"):
        waveforms.spectrum(current(np.arange(0.0, 0.1, 1e-6), 0.1))


def swept(machine, factor=1.0, amps=5.0):
    error = np.linspace(92.0, -92.0, 40_000)
    used = 0.3 - np.radians(error)
    signals = {"i_d_ref": np.full(error.size, amps), "est_angle": used}
    return error, {**signals, "deviation_q": factor * deviation_sweep.derived(np.radians(error), signals, machine)}


@pytest.mark.parametrize("amps", [3.0, -5.0])
def test_without_drops_and_saturation_the_deviation_is_kq_half_sine(amps):
    error, signals = swept(MACHINE, amps=amps)
    half = deviation_sweep.gain(amps, MACHINE) / 2.0
    assert signals["deviation_q"] == pytest.approx(half * np.sin(np.radians(2.0 * error)), abs=1e-9)
    found = deviation_sweep.sweep(error, signals, MACHINE)
    assert found.gain == pytest.approx(1.0)
    assert found.sine == pytest.approx(found.deviation, abs=0.01 * abs(half))


def test_the_fitted_gain_is_that_of_the_deviation():
    machine = {**MACHINE, "device_drop": 0.95, "cross_saturation": 1e-5, "knee": 21.8}
    error, signals = swept({**machine, "device_drop": 0.0}, 1.07)
    assert deviation_sweep.sweep(error, signals, {**machine, "device_drop": 0.0}).gain == pytest.approx(1.07)
    assert deviation_sweep.sweep(*swept(machine), machine).gain == pytest.approx(1.0)
    # forgetting the drops shows
    assert deviation_sweep.sweep(*swept(machine), MACHINE).gain > 1.3


def test_what_the_drops_do_is_taken_off():
    machine = {**MACHINE, "device_drop": 0.95}
    found = deviation_sweep.sweep(*swept(machine), machine)
    assert found.deviation == pytest.approx(found.derived)
    assert found.deviation == pytest.approx(found.sine, abs=1.0)  # the bins are not quite even
    assert np.ptp(found.raw) > 1.3 * np.ptp(found.deviation)


def test_a_sweep_that_does_not_go_round_has_no_gain():
    error, signals = swept(MACHINE)
    with pytest.raises(ValueError, match="sweep"):
        deviation_sweep.sweep(0.5 * error, signals, MACHINE)


def test_holds_are_where_the_reference_stays():
    time = np.arange(0.0, 3.0, 1e-3)
    reference = np.interp(time, [0.0, 1.0, 1.2, 3.0], [100.0, 100.0, 500.0, 500.0])
    signals = {"time": time, "speed_ref": reference, "true_speed": reference - 20.0}
    first, second = speed_profile.holds(signals, np.where(time < 1.1, -2.0, 4.0))
    assert (first.reference, first.peak, first.rms, first.followed) == (100.0, 2.0, 2.0, False)
    assert (second.reference, second.peak) == (500.0, 4.0)


def test_the_papers_scheme_runs_where_the_position_is_judged_and_its_source_left_open():
    paper = variant.paper()
    applies = {name for name in scenario_file.ids() if paper.applies(scenario_file.load(name))}
    assert {"A10", "A11", "A15", "A16", "A17", "A18a", "A18b", "A18c", "A19"} <= applies
    assert not applies & {"A09", "A12", "A13", "A14", "S01"}
    other = paper.scenario(scenario_file.load("A10"))
    assert other.runs[0].parameters["position_source"] == 1
    assert other.figures == scenario_file.load("A10").figures


def test_a_run_that_was_not_looked_into_has_no_waveform_figures():
    piece = pieces.Piece({"time": np.zeros(2)}, np.zeros(2), 0.0, 0.0)
    with pytest.raises(ValueError, match="not looked into"):
        metrics.thd(piece)
