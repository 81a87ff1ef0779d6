"""The board's lines to the outside on the virtual board: gate enable, speed command, self-test."""

from typing import Any

import pytest
from function_desk import FAULT, READY, RUN, SELF_TEST

pytest.importorskip("stillspin._core", reason="the native module is not built")

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
    assert "the ADC misreads ground or reference" in desk.status("self-test")


def test_what_is_not_wired_is_not_missed(power: Any) -> None:
    """The defaults: nothing but the chip is tested, and nothing of the board is used."""
    desk = power({})
    desk.board.set_input("reference", 120.0)
    desk.board.set_input("emergency", 1.0)
    desk.board.set_input("run", 1.0)
    desk.board.set_input("heat_sink", 150.0)
    desk.run(300)
    assert desk.status("board") == "rated_current not set: half of current_limit is used; current limit 100 %"
