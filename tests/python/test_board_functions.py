"""The functions of the board between link and motor, each on the virtual board with what hangs on it."""

from typing import Any

import pytest
from function_desk import BRAKE_RESISTOR, EMERGENCY, FAULT, OVERLOAD, PRECHARGE, READY, RUN, TEMPERATURE, Desk, Plant

pytest.importorskip("stillspin._core", reason="the native module is not built")

# ---- bootstrap supplies


def test_bootstrap_capacitors_are_charged_before_the_first_pulse(power: Any) -> None:
    desk = power({"bootstrap_time": 2.0, "flying_start": 0.0}, {"board": {"bootstrap": True}})
    desk.run(300)
    desk.wait(200)
    assert desk.output("lockouts") == 0
    assert desk.truth("speed") == pytest.approx(300, abs=20)


def test_without_charging_the_upper_devices_do_not_switch(power: Any) -> None:
    """That the model can tell: the same start without the time for it."""
    desk = power({"bootstrap_time": 0.0, "flying_start": 0.0}, {"board": {"bootstrap": True}})
    desk.type("start free")
    desk.wait(50)
    assert desk.output("lockouts") > 0


def test_a_turning_shaft_is_not_braked_by_the_charging(power: Any) -> None:
    """Two thousand turns a minute: the short circuit would carry 40 A if it lasted."""
    plant = {"board": {"bootstrap": True}, "initial": {"speed": 200.0}}
    desk = power({"bootstrap_time": 2.0}, plant)
    desk.type("ref 1500 rpm")
    desk.type("start free", 0)
    assert desk.until(RUN), desk.status("fault")
    assert desk.output("lockouts") == 0
    assert desk.truth("speed") > 1200


# ---- precharge


def charging(resistance: float) -> Plant:
    link = {"stiff": False, "source_resistance": 0.3, "capacitance": 2e-3}
    return {"board": {"precharge_resistance": resistance}, "initial": {"link_voltage": 0.0}, "link": link}


def test_the_relay_closes_when_the_link_is_charged(power: Any) -> None:
    desk = power({"precharge_voltage": 270.0}, charging(100.0))
    assert desk.output("relay") == 0
    assert "precharge relay open" in desk.status("board")
    desk.wait(600)  # 2 mF, 100 ohm: 90 % after 0.46 s
    assert desk.output("relay") == 1
    assert "precharge relay closed" in desk.status("board")
    assert desk.truth("link_voltage") > 290
    desk.run(300)


def test_a_start_before_the_link_is_charged_is_refused(power: Any) -> None:
    desk = power({"precharge_voltage": 270.0}, charging(100.0))
    desk.type("start free")
    assert (desk.state, desk.fault) == (FAULT, PRECHARGE)
    desk.wait(600)
    desk.type("reset", 100)
    desk.run(300)


def test_a_link_that_does_not_charge_is_a_fault(power: Any) -> None:
    """A resistor of 10 kilohm in its place."""
    desk = power({"precharge_voltage": 270.0, "precharge_time": 1000.0}, charging(1e4))
    desk.wait(800)
    assert desk.state == READY  # below an eighth nobody charges
    desk.wait(3000)
    assert (desk.state, desk.fault) == (FAULT, PRECHARGE)
    assert desk.output("relay") == 0


# ---- brake resistor


def braking(**board: Any) -> Plant:
    return {"link": {"stiff": False, "rectifier": True, "capacitance": 4e-4, "brake_resistance": 47.0}, "board": board}


def brake_from(desk: Desk) -> float:
    """Highest link voltage while the shaft is brought to rest from 2000 rpm."""
    desk.run(2000)
    assert desk.until(RUN)
    desk.wait(1200)
    desk.type("stop", 0)
    highest = 0.0
    for _ in range(600):
        desk.wait(1)
        highest = max(highest, desk.truth("link_voltage"))
    return highest


SWIFT = {"speed_ramp": 20000.0, "link_regulation": 418.0}


def test_the_brake_resistor_keeps_the_link_down(power: Any) -> None:
    desk = power({**SWIFT, "brake_voltage": 350.0, "brake_share": 90.0}, braking(brake=True))
    assert brake_from(desk) < 375
    assert desk.fault == 0
    assert desk.output("brake") == 0
    assert "brake resistor off" in desk.status("board")


def test_without_it_the_link_rises(power: Any) -> None:
    desk = power({**SWIFT, "brake_voltage": 350.0, "brake_share": 90.0}, braking(brake=False))
    assert brake_from(desk) > 390


def test_a_brake_resistor_that_is_on_too_long_is_a_fault(power: Any) -> None:
    """The supply itself is above the threshold."""
    plant = {"link": {"stiff": False, "source_voltage": 340.0}, "board": {"brake": True}}
    desk = power({"brake_voltage": 320.0, "brake_share": 5.0}, plant)
    assert desk.output("brake") == 1
    desk.wait(300)
    assert desk.state == READY
    desk.wait(400)
    assert (desk.state, desk.fault) == (FAULT, BRAKE_RESISTOR)


# ---- heat


def test_a_hot_heat_sink_takes_current_and_then_faults(power: Any) -> None:
    desk = power({"temperature_limit": 90.0, "temperature_derating": 70.0})
    desk.board.set_input("heat_sink", 50.0)
    desk.wait(20)
    line = desk.status("board")
    assert "heat sink 50 C" in line or "heat sink 51 C" in line or "heat sink 49 C" in line
    assert "current limit 100 %" in line
    assert abs(desk.board.signals()["temperature"] - 50.0) < 2.0
    desk.board.set_input("heat_sink", 80.0)
    desk.wait(20)
    share = int(desk.status("board").split("current limit ")[1].split(" ")[0])
    assert 70 <= share <= 80  # half way to a half, and the table's lines
    desk.board.set_input("heat_sink", 95.0)
    desk.wait(20)
    assert (desk.state, desk.fault) == (FAULT, TEMPERATURE)
    desk.board.set_input("heat_sink", 40.0)
    desk.wait(20)
    desk.type("reset", 100)
    assert desk.state == READY


@pytest.mark.parametrize("celsius", [-100.0, 250.0], ids=["open", "short"])
def test_a_broken_sensor_is_a_fault(power: Any, celsius: float) -> None:
    """A wire that is broken looks colder, a short circuit hotter than anything."""
    desk = power({"temperature_limit": 90.0})
    desk.board.set_input("heat_sink", celsius)
    desk.wait(20)
    assert (desk.state, desk.fault) == (FAULT, TEMPERATURE)
    assert temperature(desk) == "unknown"


def test_without_a_sensor_the_temperature_is_unknown(power: Any) -> None:
    """And not 0 C."""
    desk = power({})
    desk.board.set_input("heat_sink", 50.0)
    desk.wait(20)
    assert temperature(desk) == "unknown"
    desk.type("set temperature_limit 90")
    assert abs(float(temperature(desk)) - 50.0) < 2.0
    desk.type("set temperature_limit 0")
    assert temperature(desk) == "unknown"


def temperature(desk: Any) -> str:
    """What stands behind its name."""
    return str(desk.type("signals temperature", 100).split()[3])


def test_overload_brings_the_current_limit_down_to_what_may_flow_for_ever(power: Any) -> None:
    """A shaft that cannot turn: the speed control asks for all the current that it may have."""
    told = {"overload_current": 6.0, "overload_time": 1000.0, "position_source": 0.0, "polarity_check": 0.0}
    desk = power(told, {"mechanics": {"locked": True}})
    desk.run(300)
    desk.wait(100)
    assert desk.mean_current() == pytest.approx(14, abs=0.5)
    desk.wait(1500)
    assert desk.fault == 0
    assert desk.mean_current() == pytest.approx(6, abs=0.4)
    limit = int(desk.status("board").split("current limit ")[1].split(" ")[0])
    assert limit == pytest.approx(100 * 6 / 14, abs=4)


def test_overload_that_derating_does_not_end_is_a_fault(power: Any) -> None:
    """The limit is above what may flow for ever by so little time that it comes too late."""
    desk = power({"overload_current": 3.0, "overload_time": 100.0, "if_current": 10.0, "start_method": 1.0})
    desk.type("start free", 0)
    desk.wait(1500)
    assert (desk.state, desk.fault) == (FAULT, OVERLOAD)


# ---- emergency stop


def test_the_emergency_stop_opens_the_gates_in_hardware(power: Any) -> None:
    desk = power({"emergency_stop": 1.0})
    desk.run(600)
    desk.wait(200)
    edges = desk.board.statistics()["gate_edges"]
    desk.board.set_input("emergency", 1.0)
    desk.wait(0.001)  # before the next control interrupt
    off = desk.board.statistics()["gate_edges"]
    assert off != edges
    desk.wait(1)
    assert desk.board.statistics()["gate_edges"] == off
    assert (desk.state, desk.fault) == (FAULT, EMERGENCY)
    assert "emergency stop pressed" in desk.status("board")


def test_it_stays_off_until_it_is_released_and_reset(power: Any) -> None:
    desk = power({"emergency_stop": 1.0})
    desk.board.set_input("emergency", 1.0)
    desk.wait(5)
    assert (desk.state, desk.fault) == (FAULT, EMERGENCY)
    desk.type("reset", 60)
    assert (desk.state, desk.fault) == (FAULT, EMERGENCY)
    desk.board.set_input("emergency", 0.0)
    desk.wait(5)
    assert desk.state == FAULT
    desk.type("reset", 100)
    desk.run(300)
