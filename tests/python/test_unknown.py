"""What a drive says of a shaft of which it knows nothing: not a number, anywhere. On the virtual board, full link."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from function_desk import COMMISSION, FAULT, READY, RUN, Desk

from stillspin import core
from stillspin.cases import profile

pytest.importorskip("stillspin._core", reason="the native module is not built")

OF_ROTOR = ("angle", "speed", "load_torque", "current_d", "current_q")
ASKED_FOR = (
    *("speed_reference", "current_d_reference", "current_q_reference"),
    *("voltage_d", "voltage_q", "voltage_alpha", "voltage_beta"),
)
"""With the power stage off nothing is."""
DOCS = Path(__file__).resolve().parents[2] / "docs"


def promised(page):
    """A; what a page of the book says that sensors read at rest: their noise and what a code is worth."""
    text = (DOCS / page).read_text(encoding="utf-8")
    (said,) = re.findall(r"current_a` and `current_b`[^\d\n]* below (\d+\.\d+) A", text)
    return float(said)


SENSOR_NOISE = promised("wiring.md")


@pytest.fixture
def desk():
    made = Desk({"emergency_stop": 1.0}, wait=250)
    yield made
    made.board.close()


def expect_nothing_known(desk: Desk) -> None:
    """Of the rotor, in signals, status, watch; while the sensors' currents are small."""
    seen = [desk.board.signals() for _ in range(200) if desk.wait(1.3) is None]
    assert all(row["speed_known"] == 0.0 for row in seen)
    assert all(row[name] == 0.0 for row in seen for name in (*OF_ROTOR, *ASKED_FOR))
    assert max(abs(row[name]) for row in seen for name in ("current_a", "current_b")) < SENSOR_NOISE
    assert desk.status("speed").startswith("unknown, the shaft may be turning; reference ")
    currents = re.fullmatch(r"phase a (-?\d+\.\d\d) A, phase b (-?\d+\.\d\d) A", desk.status("current"))
    assert currents
    assert all(abs(float(value)) <= SENSOR_NOISE for value in currents.groups())
    assert "unknown, the shaft may be turning" in desk.type("watch", 100)
    desk.type("", 20)


def test_the_pages_for_a_new_board_promise_the_same():
    assert SENSOR_NOISE == promised("bring-up.md") == 0.05


def test_an_idle_board_at_full_link_shows_the_sensors_noise_and_no_estimate(desk):
    assert desk.state == READY
    assert desk.board.signals()["link_voltage"] == pytest.approx(300, abs=3)
    expect_nothing_known(desk)


def test_after_coast_the_speed_is_unknown_while_the_shaft_turns(desk):
    desk.run(1200)
    desk.wait(1000)
    assert desk.board.signals()["speed_known"] == 1.0
    assert desk.board.signals()["speed"] == pytest.approx(1200, rel=0.01)
    desk.type("coast")
    assert desk.truth("speed") > 900
    assert desk.status("state") == "ready"
    expect_nothing_known(desk)
    assert desk.truth("speed") > 300


def test_after_an_emergency_the_speed_is_unknown_and_was_known_when_it_came(desk):
    desk.run(900)
    desk.wait(1000)
    desk.board.set_input("emergency", 1.0)
    desk.wait(50)
    assert desk.state == FAULT
    assert desk.truth("speed") > 600
    expect_nothing_known(desk)
    said = re.search(r"emergency stop, running at (\d+\.\d) rpm", desk.type("faults", 200))
    assert said
    # Some of the period in which the gates went off is in it: where they did makes up to 14 rpm either way.
    assert math.isclose(float(said[1]), 900.0, abs_tol=20.0)


def test_a_start_is_known_at_its_end(desk):
    """Not while it still looks for the polarity."""
    desk.type("start free", 0)
    known = []
    while desk.state != RUN:
        known.append(desk.board.signals()["speed_known"])
        desk.wait(0.3)
    assert len(known) > 50
    assert not any(known)
    assert desk.board.signals()["speed_known"] == 1.0
    assert math.isclose(desk.board.signals()["speed"], desk.truth("speed"), abs_tol=30.0)


def test_where_a_rotor_without_an_axis_is_while_it_is_measured_is_not_known():
    native = core.load()
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native), "B-SPM")
    desk = Desk({**chosen.parameters, "emergency_stop": 1.0}, chosen.plant, wait=250)
    desk.type("commission start free", 10)
    assert desk.until(COMMISSION)
    turning = []
    for _ in range(200):
        row = desk.board.signals()
        assert row["state"] == COMMISSION
        assert row["speed_known"] == row["speed"] == row["load_torque"] == 0.0
        assert abs(row["current_d"]) + abs(row["current_q"]) > 0.0
        turning.append(abs(desk.truth("speed")))
        desk.wait(3)
    assert max(turning) > 1.0
    desk.board.close()
