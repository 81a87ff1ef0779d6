"""Which phase or sensor is wired wrongly is said by every client in the drive's words, and what to check."""

import os
import re
from dataclasses import replace
from pathlib import Path

import pytest
from desk import board, needs_board
from screen import terminal

from stillspin.drive import Drive
from stillspin.drive.protocol import Request, StatusCode, Words
from stillspin.drive.requester import wait_until
from stillspin.drive.state import FAULT, WIRING_FAULTS
from stillspin.link.errors import DriveError, RefusedError
from stillspin.tune.server import Server

ROOT = Path(__file__).resolve().parents[2]
SLOW = 60
FROM_POWER_ON = "fault.from_power_on=true"
OPEN = "a motor phase carries no current: phase {} is open"
SENSOR = "a current sensor shows nothing or is reversed: sensor {}"
TURNED = "fault.gain_sensor={}", "fault.gain_sensor_factor=-1"
MISTAKES = [
    *(
        (
            ("fault.open_phase=" + leg,),
            OPEN.format(leg),
            "check its wire, terminals and gate driver",
        )
        for leg in "abc"
    ),
    *(
        (
            tuple(part.format(leg) for part in TURNED),
            SENSOR.format(leg + " is reversed"),
            "check its supply, wire and ",
        )
        for leg in "ab"
    ),
    (
        ("fault.stuck_sensor=a",),
        SENSOR.format("a shows nothing"),
        "check its supply, wire and direction",
    ),
    (
        ("wiring.input_a=b", "wiring.input_b=a"),
        "the current sensors are on different phases from the gates: sensors a and b are exchanged",
        "compare a, b and c at gates, motor cable, sensors and converter",
    ),
]


def test_the_numbers_of_these_faults_are_the_firmwares():
    rows = (ROOT / "firmware" / "start" / "flying" / "fault_list.h").read_text(encoding="utf-8")
    numbers = {name: int(number) for number, name in re.findall(r"FAULT\((\d+), (\w+)", rows)}
    assert [numbers.pop(name) for name in ("OPEN_PHASE", "CURRENT_SENSOR", "SENSOR_ORDER")] == list(WIRING_FAULTS)
    assert set(numbers) == {"NO_CURRENT"}  # which says all that there is to say


def test_the_kinds_of_words_are_the_firmwares():
    kinds = (ROOT / "firmware" / "text" / "catalogue.h").read_text(encoding="utf-8")
    theirs = {name: int(number) for name, number in re.findall(r"^  CATALOGUE_(\w+) = (\d+)", kinds, re.MULTILINE)}
    assert {kind.name: kind.value for kind in Words} == theirs


@needs_board
@pytest.mark.parametrize(("planted", "cause", "remedy"), MISTAKES)
def test_a_start_that_fails_says_which_one_and_what_to_check(planted, cause, remedy):
    with Drive.virtual("bench", [FROM_POWER_ON, *planted], speed=0) as drive:
        with pytest.raises(DriveError) as refused:
            drive.start(100, wait=True)
        assert str(refused.value).startswith(f"the motor does not run: {cause}; {remedy}")
        status = drive.status()
        assert status.fault == cause
        assert status.remedy.startswith(remedy)


@needs_board
def test_a_commissioning_that_fails_says_it_too():
    with Drive.virtual("bench", [FROM_POWER_ON, "fault.open_phase=c"], speed=0) as drive:
        with pytest.raises(DriveError) as refused:
            drive.commission()
        assert f"{OPEN.format('c')}; check its wire" in str(refused.value)


@needs_board
def test_another_fault_has_no_phase_of_an_earlier_start():
    with Drive.virtual("bench", [FROM_POWER_ON, "fault.open_phase=b"], speed=1.0) as drive:
        drive.set("emergency_stop", 1)
        with pytest.raises(DriveError, match="phase b is open"):
            drive.start(100, wait=True)
        drive.reset()
        assert drive.status().fault == ""
        drive.link.transport.set_input("emergency", 1.0)
        assert wait_until(lambda: drive.status().raw.state == FAULT, SLOW)
        assert drive.signals("wiring") == {"wiring": 3}
        assert drive.status().fault == "emergency stop"


@needs_board
def test_a_drive_without_these_words_says_the_fault_as_before(monkeypatch):
    with Drive.virtual("bench", [FROM_POWER_ON, "fault.open_phase=b"], speed=0) as drive:
        asked = drive.link.request

        def request(kind, body=b"", **options):
            if kind == Request.WORDS and body[0] == Words.WIRING:
                raise RefusedError("the drive does not know this", StatusCode.UNKNOWN)
            return asked(kind, body, **options)

        monkeypatch.setattr(drive.link, "request", request)
        with pytest.raises(
            DriveError,
            match="the motor does not run: a motor phase carries no current; check its wire",
        ):
            drive.start(100, wait=True)


@needs_board
def test_a_drive_without_the_signal_says_the_fault_as_before():
    with Drive.virtual("bench", [FROM_POWER_ON, "fault.open_phase=b"], speed=0) as drive:
        left = tuple(signal for signal in drive.table.signals if signal.name != "wiring")
        assert len(left) == len(drive.table.signals) - 1
        drive.table = replace(drive.table, signals=left)
        with pytest.raises(
            DriveError,
            match="the motor does not run: a motor phase carries no current; check its wire",
        ):
            drive.start(100, wait=True)


@needs_board
def test_the_page_says_which_one_and_what_to_check(page):
    with (
        Drive.virtual("bench", [FROM_POWER_ON, "fault.open_phase=b"]) as drive,
        Server(drive) as server,
    ):
        page.goto(server.address)
        page.wait_for_selector("#state:has-text('ready')", timeout=1000 * SLOW)
        page.check("#keep")
        page.click("#hold")
        page.wait_for_selector(f"#fault-words:text-is('{OPEN.format('b')}:')", timeout=1000 * SLOW)
        assert page.inner_text("#fault-remedy") == "check its wire, terminals and gate driver"


@needs_board
def test_the_monitor_says_which_one_and_what_to_check(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    options = "--set", FROM_POWER_ON, "--set", "fault.open_phase=b"
    with board(tmp_path, *options) as port:
        with (
            Drive.open(port, timeout=2.0) as drive,
            pytest.raises(DriveError, match="phase b is open"),
        ):
            drive.start(100, wait=True)
        said = terminal(
            ["monitor", "--drive", port, "--duration", "3"],
            {**os.environ, "TERM": "xterm"},
            SLOW,
            (30, 140),
        )
        said = " ".join(re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said).split())  # however the lines are broken
        assert "a motor phase carries no current: phase b is open" in said
        assert "check its wire, terminals and gate driver" in said
