"""Signals that the page computes: their formulas, and against the true machine; empty where the rotor is not known."""

import math
from dataclasses import replace

import pytest
from desk import needs_board

from stillspin.drive import Drive
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.tune.derived import Choice
from stillspin.tune.server import Server

MOTOR = {"pole_pairs": 4, "inductance_d": 4.0, "inductance_q": 6.0, "magnet_flux": 0.15, "current_limit": 10.0}


@pytest.fixture
def table(drive):
    """That of the small drive, with the signals and parameters that it lacks."""
    more = {"voltage_d": "V", "voltage_q": "V", "current_a": "A", "current_b": "A"}
    signals = [
        *drive.table.signals,
        *(
            replace(drive.table.signals[0], index=20 + at, name=name, unit=unit)
            for at, (name, unit) in enumerate(more.items())
        ),
    ]
    sample = drive.table.parameters[0]
    parameters = [*drive.table.parameters, *(replace(sample, name=name) for name in MOTOR if name != "current_limit")]
    return replace(drive.table, signals=tuple(signals), parameters=tuple(parameters))


def value(table, name, **signals):
    choice = Choice([name], table)
    return choice.row(tuple(signals[need] for need in choice.streamed), MOTOR)[0]


def test_the_formulas(table):
    currents = {"current_d": -2.0, "current_q": 3.0}
    assert value(table, "torque", speed_known=1.0, **currents) == pytest.approx(1.5 * 4 * (0.15 + 0.002 * 2) * 3)
    assert value(table, "current_share", **currents) == pytest.approx(10 * math.sqrt(13))
    assert value(table, "power", voltage_d=10.0, voltage_q=20.0, **currents) == pytest.approx(1.5 * 40)
    assert value(table, "current_c", current_a=-2.0, current_b=0.5) == pytest.approx(1.5)


def test_what_is_not_known_of_the_rotor_is_empty(table):
    choice = Choice(["speed", "link_voltage", "torque"], table)
    known = {"link_voltage": 310.0, "speed_known": 0.0}
    row = choice.row(tuple(known.get(name, math.nan) for name in choice.streamed), MOTOR)
    assert math.isnan(row[0])
    assert row[1] == 310.0
    assert math.isnan(row[2])


def test_while_a_start_does_not_know_the_rotor_its_currents_make_power_and_no_torque(table):
    """They are those of the frame of the control, whose axes lie where the start has put them."""
    starting = {"current_d": 2.0, "current_q": 3.0, "speed_known": 0.0, "voltage_d": 10.0, "voltage_q": 20.0}
    choice = Choice(["torque", "power", "current_share", "current_q"], table)
    row = choice.row(tuple(starting[name] for name in choice.streamed), MOTOR)
    assert math.isnan(row[0])
    assert row[1:] == pytest.approx([1.5 * 80, 10 * math.sqrt(13), 3.0])


def test_more_than_the_drive_streams_is_refused_in_words(table):
    many = ["power", "current_c", "state", "speed", "speed_reference"]
    with pytest.raises(InputError, match=r"these need 9 signals of the drive .* 1 … 8 can be plotted at once"):
        Choice(many, table)
    with pytest.raises(InputError, match="no signal 'x'"):
        Choice(["x"], table)


@needs_board
def test_they_are_those_of_the_true_machine():
    with Drive.virtual("ideal", speed=1.0) as drive:
        drive.link.transport.set_load(1.0)
        with drive.running(600):
            assert wait_until(lambda: abs(drive.status().speed - 600) < 5, 20)
            choice = Choice(["torque", "power"], drive.table)
            parameters = drive.parameters()
            rows = [choice.row(tuple(drive.signals(*choice.streamed).values()), parameters) for _ in range(40)]
            torque, power = (sum(column) / len(rows) for column in zip(*rows, strict=True))
            assert torque == pytest.approx(1.0 + 0.003 * 600 * math.pi / 30, abs=0.15)  # load and friction
            assert power == pytest.approx(torque * 600 * math.pi / 30, rel=0.25)  # and what the winding takes


@needs_board
def test_a_person_finds_currents_torque_power_load_and_temperature_among_the_signals(page):
    """What no sensor has seen is a dash, and not 0 degrees."""
    wanted = ("current_a", "current_b", "current_c", "torque", "load_torque", "power", "current_share", "temperature")
    with Drive.virtual() as drive, Server(drive) as server:
        page.goto(server.address)
        page.wait_for_selector("#state:has-text('ready')")
        page.click("#chooser summary")
        for name in wanted:
            assert page.locator(f"#signals input[value={name}]").count() == 1, name
        page.check("#signals input[value=temperature]")
        page.wait_for_selector("[data-value=temperature]:text-is('–')")
        drive.set("temperature_limit", 120)
        page.wait_for_selector("[data-value=temperature]:has-text('°C')")
        drive.set("temperature_limit", 0)
        page.wait_for_selector("[data-value=temperature]:text-is('–')")


@needs_board
def test_a_box_is_ticked_that_is_plotted_and_no_other(page):
    """After a page is opened with as many as there may be, and after a choice that was refused."""
    eight = ["speed", "current_d", "current_q", "state", "fault", "limit", "link_voltage", "load_torque"]
    with Drive.virtual() as drive, Server(drive) as server:

        def ticked():
            return {box.input_value() for box in page.locator("#signals input:checked").all()}

        server.bench.plot(eight)
        page.goto(server.address)
        page.wait_for_selector("#state:has-text('ready')")
        page.click("#chooser summary")
        assert ticked() == set(eight)
        assert page.is_disabled("#signals input[value=angle]")
        page.uncheck("#signals input[value=fault]")
        page.wait_for_selector("#plots [data-value=fault]", state="detached")
        page.click("#signals input[value=power]")  # one box, and more signals of the drive than are left
        page.wait_for_selector("#note:has-text('can be plotted at once')")
        assert ticked() == set(eight) - {"fault"}
        server.bench.plot(eight[:2])  # by another page
        page.wait_for_selector("#plots [data-value=state]", state="detached")
        assert ticked() == set(eight[:2])
