"""`look`: how a shaft turns of which nothing is known, against the true shaft."""

from __future__ import annotations

import re

import pytest
from function_desk import FAULT, READY, RUN, Desk

pytest.importorskip("stillspin._core", reason="the native module is not built")

LARGEST_ERROR = 0.03
"""Of the speed: the EMF's direction is known to a volt's worth, seen twice over some 60 degrees."""


@pytest.fixture
def desk():
    made = Desk({"emergency_stop": 1.0}, wait=250)
    yield made
    made.board.close()


def looked(desk: Desk, patience: int = 400) -> tuple[str, float]:
    """What the console says, and the true speed in the middle of it; the drive is ready again, its gates off."""
    before = desk.truth("speed")
    said = desk.type("look", patience)
    assert desk.state == READY
    assert desk.board.signals()["speed_known"] == 0.0
    return said, before


@pytest.mark.parametrize("speed", [150, 600, -1200, 2500])
def test_a_shaft_that_runs_out_after_coast_is_told_with_its_speed(desk: Desk, speed: float) -> None:
    desk.run(speed)
    desk.wait(1800)
    desk.type("coast", 100)
    assert desk.state == READY
    said, before = looked(desk)
    found = re.search(r"the shaft turns at (-?\d+) rpm", said)
    assert found, said
    after = desk.truth("speed")
    slower, faster = sorted((abs(before), abs(after)))
    assert slower * (1 - LARGEST_ERROR) <= abs(float(found[1])) <= faster * (1 + LARGEST_ERROR)
    assert float(found[1]) * speed > 0


def test_it_hardly_brakes_the_shaft(desk: Desk) -> None:
    """Less than one per cent beyond what the same time without it does."""
    desk.run(1200)
    desk.wait(1500)
    desk.type("coast", 100)
    first = desk.truth("speed")
    desk.wait(400)
    rested = desk.truth("speed")
    looked(desk, 400)
    slope = first - rested
    assert rested - desk.truth("speed") < slope + 0.01 * rested


def test_after_an_emergency(desk: Desk) -> None:
    desk.run(900)
    desk.wait(1000)
    desk.board.set_input("emergency", 1.0)
    desk.wait(50)
    assert desk.state == FAULT
    assert "a fault is latched, reset it first: emergency stop" in desk.type("look")
    assert desk.state == FAULT
    desk.board.set_input("emergency", 0.0)
    desk.wait(50)
    desk.type("reset", 100)
    assert desk.until(READY)
    said, before = looked(desk)
    found = re.search(r"the shaft turns at (\d+) rpm", said)
    assert found, said
    assert float(found[1]) == pytest.approx(before, rel=0.1)


def test_a_shaft_that_stands_is_said_to_stand_as_far_as_the_pulses_show(desk: Desk) -> None:
    turned = desk.truth("angle")
    said, _ = looked(desk)
    assert re.search(r"it stands, or turns at less than 4\d rpm", said), said
    assert abs(desk.truth("angle") - turned) < 0.001


def test_while_it_runs_it_is_refused(desk: Desk) -> None:
    desk.run(300)
    assert "the drive is busy, stop it first: running" in desk.type("look")
    assert desk.state == RUN


def test_a_coast_ends_it(desk: Desk) -> None:
    desk.board.serial_write(b"look\r")
    desk.wait(1.2)
    desk.board.serial_write(b"coast\r")
    desk.wait(100)
    said = desk.board.serial_read().decode()
    assert desk.state == READY
    assert "power stage off" in said  # which answers instead


def test_a_fault_ends_it(desk: Desk) -> None:
    desk.board.serial_write(b"look\r")
    desk.wait(1.2)
    desk.board.set_input("emergency", 1.0)
    desk.wait(100)
    assert desk.state == FAULT
    assert "ended by a stop or a fault: see 'status'" in desk.board.serial_read().decode()


@pytest.mark.parametrize("speed", [900, -900])
def test_pulses_that_contradict_each_other_are_said_to(desk: Desk, speed: float) -> None:
    """A drive that is told a third of its magnet: size and turning of the back-EMF have no speed in common."""
    desk.run(speed)
    desk.wait(1500)
    desk.type("coast", 100)
    told = 0.3 * float(re.search(r"magnet_flux = (\S+)", desk.type("get magnet_flux"))[1])
    assert f"magnet_flux = {told:.5f}" in desk.type(f"set magnet_flux {told:.5f}")
    said, before = looked(desk)
    found = re.search(r"it turns, but the two pulses disagree; by its back-EMF at about (\d+) rpm", said)
    assert found, said
    assert float(found[1]) == pytest.approx(abs(before) / 0.3, rel=0.1)


def test_nothing_looks_by_itself(desk: Desk) -> None:
    """After a coast the gates stay off: the shaft runs out as one that nobody looks at."""
    desk.run(600)
    desk.wait(600)
    desk.type("coast")
    currents = []
    for _ in range(300):
        desk.wait(1.1)
        currents.append(abs(desk.truth("i_a")))
    assert max(currents) < 1e-6
