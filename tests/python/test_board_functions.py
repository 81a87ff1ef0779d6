"""The functions of the board, each on the virtual board with what hangs on it."""

import importlib
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("stillspin._core", reason="the native module is not built")

MS = 100_000  # ticks
READY, RUN, FAULT = 2, 4, 6
EMERGENCY, PRECHARGE, TEMPERATURE, OVERLOAD, BRAKE_RESISTOR, GATE_ENABLE, SELF_TEST = range(14, 21)
LINK_HIGH = 4
POWER_UP = 80  # ms to READY, parameters told, and the functions have seen them

Plant = dict[str, dict[str, Any]]


class Desk:
    """A virtual board with a console."""

    def __init__(self, parameters: dict[str, float], plant: Plant | None = None, *, wait: int = POWER_UP) -> None:
        native = importlib.import_module("stillspin._core")
        chosen = {"solver": {"method": "rk4"}, **(plant or {})}
        self.board = native.VirtualBoard(plant=chosen, parameters=parameters, seed=1)
        self.wait(wait)

    def wait(self, ms: float) -> None:
        self.board.advance(round(ms * MS))

    def type(self, line: str, ms: int = 60) -> str:
        """What comes back of a line within some time."""
        self.board.serial_write(line.encode() + b"\r")
        self.wait(ms)
        return str(self.board.serial_read().decode())

    def status(self, title: str) -> str:
        """A line of the command status."""
        lines = self.type("status", 250).splitlines()
        return next(line.removeprefix(title).strip() for line in lines if line.startswith(title))

    def until(self, state: int, ms: int = 2000) -> bool:
        """Whether the drive gets there."""
        for _ in range(ms // 5):
            if self.state == state:
                return True
            self.wait(5)
        return self.state == state

    def run(self, rpm: float) -> None:
        self.type(f"ref {rpm} rpm")
        self.type("start")
        assert self.until(RUN), self.status("fault")

    @property
    def state(self) -> int:
        return int(self.board.signals()["state"])

    @property
    def fault(self) -> int:
        return int(self.board.signals()["fault"])

    def truth(self, name: str) -> float:
        return float(self.board.truth()[name])

    def mean_current(self) -> float:
        """Torque current without the excitation's ripple, A."""
        seen = []
        for _ in range(100):
            self.wait(0.137)
            seen.append(abs(self.truth("i_q")))
        return sum(seen) / len(seen)

    def output(self, name: str) -> float:
        return float(self.board.outputs()[name])


@pytest.fixture
def desks() -> Iterator[list[Desk]]:
    """One at a time in a process: closed behind each test."""
    opened: list[Desk] = []
    yield opened
    for desk in opened:
        desk.board.close()


@pytest.fixture
def power(desks: list[Desk]) -> Any:
    def switch_on(*arguments: Any, **named: Any) -> Desk:
        desks.append(Desk(*arguments, **named))
        return desks[-1]

    return switch_on


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
    desk.type("start")
    desk.wait(50)
    assert desk.output("lockouts") > 0


def test_a_turning_shaft_is_not_braked_by_the_charging(power: Any) -> None:
    """Two thousand turns a minute: the short circuit would carry 40 A if it lasted."""
    plant = {"board": {"bootstrap": True}, "initial": {"speed": 200.0}}
    desk = power({"bootstrap_time": 2.0}, plant)
    desk.type("ref 1500 rpm")
    desk.type("start", 0)
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
    desk.type("start")
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
    desk.type("start", 0)
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


# ---- the gate enable, a watchdog of the board


def test_a_gate_enable_that_is_stuck_is_found_before_the_first_start(power: Any) -> None:
    desk = power({"gate_feedback": 1.0}, {"board": {"enable_stuck": True}})
    assert (desk.state, desk.fault) == (FAULT, SELF_TEST)
    assert "the gate enable passes the gates without being toggled" in desk.status("self-test")


def test_a_gate_enable_that_works_is_not_complained_of(power: Any) -> None:
    desk = power({"gate_feedback": 1.0})
    desk.run(300)
    desk.wait(100)
    assert (desk.state, desk.fault, desk.output("gates_pass")) == (RUN, 0, 1)


# ---- speed command without a host


def test_switch_and_voltage_run_the_drive(power: Any) -> None:
    desk = power({"speed_input": 1.0, "speed_input_full": 1000.0, "speed_input_dead": 5.0})
    desk.board.set_input("speed", 1.5)
    desk.wait(100)
    assert desk.state == READY  # the switch is open
    desk.board.set_input("run", 1.0)
    assert desk.until(RUN)
    desk.wait(500)
    assert desk.truth("speed") == pytest.approx(1000 * (0.5 - 0.05) / 0.95, abs=15)
    desk.board.set_input("speed", 0.1)  # in the dead zone
    desk.wait(600)
    assert desk.truth("speed") == pytest.approx(0, abs=8)
    desk.board.set_input("run", 0.0)
    assert desk.until(READY)


def test_a_switch_that_is_closed_at_power_on_starts_nothing(power: Any) -> None:
    desk = power({"speed_input": 1.0}, wait=1)
    desk.board.set_input("run", 1.0)
    desk.board.set_input("speed", 1.5)
    desk.wait(600)
    assert desk.state == READY
    desk.board.set_input("run", 0.0)
    desk.wait(10)
    desk.board.set_input("run", 1.0)
    assert desk.until(RUN)


@pytest.mark.parametrize(("reaction", "slowest", "fastest"), [(1.0, -5, 5), (2.0, 200, 580)], ids=["stop", "coast"])
def test_a_lost_live_zero_stops_the_drive(power: Any, reaction: float, slowest: float, fastest: float) -> None:
    plan = {"speed_input": 2.0, "speed_input_loss": reaction, "speed_input_dead": 0.0}
    desk = power(plan)
    desk.board.set_input("speed", 3.0 * (0.1 + 0.8 * 0.3))
    desk.board.set_input("run", 1.0)
    assert desk.until(RUN)
    desk.wait(500)
    assert desk.truth("speed") == pytest.approx(600, abs=15)
    desk.board.set_input("speed", 0.0)
    desk.wait(400)
    assert desk.state == READY
    assert "signal lost" in desk.status("board")
    assert slowest <= desk.truth("speed") <= fastest
    desk.board.set_input("speed", 1.5)
    desk.wait(100)
    assert desk.state == READY  # until the switch has been opened


def test_the_link_is_still_measured_while_the_speed_is(power: Any) -> None:
    desk = power({"speed_input": 1.0})
    seen = []
    for _ in range(40):
        desk.wait(0.37)
        seen.append(desk.board.signals()["link_voltage"])
    assert max(seen) - min(seen) < 15
    assert min(seen) > 280


# ---- self-test


def test_the_self_test_passes_in_words(power: Any) -> None:
    desk = power({"reference_input": 1.0, "gate_feedback": 1.0})
    desk.wait(150)
    assert desk.status("self-test").startswith("passed; flash not tested")
    assert desk.fault == 0


@pytest.mark.parametrize("address", [0x8000, 0x9ABC, 0xBFFF])
def test_a_bit_of_ram_that_is_stuck_is_found(power: Any, address: int) -> None:
    desk = power({}, wait=0)
    desk.board.set_input("broken_ram", address)
    desk.wait(150)
    assert (desk.state, desk.fault) == (FAULT, SELF_TEST)
    assert "RAM does not keep what is written" in desk.status("self-test")
    desk.type("reset", 60)
    assert desk.fault == SELF_TEST


def test_a_reference_that_is_off_is_found(power: Any) -> None:
    desk = power({"reference_input": 1.0}, wait=0)
    desk.board.set_input("reference", 120.0)
    desk.wait(150)
    assert (desk.state, desk.fault) == (FAULT, SELF_TEST)
    assert "the converter misreads ground or reference" in desk.status("self-test")


def test_what_is_not_wired_is_not_missed(power: Any) -> None:
    """The defaults: nothing but the chip is tested, and nothing of the board is used."""
    desk = power({})
    desk.board.set_input("reference", 120.0)
    desk.board.set_input("emergency", 1.0)
    desk.board.set_input("run", 1.0)
    desk.board.set_input("heat_sink", 150.0)
    desk.run(300)
    assert desk.status("board") == "current limit 100 %"
