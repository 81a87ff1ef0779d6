"""A virtual board in the client's own process that runs faster than the clock."""

import time

import pytest
from desk import needs_board

from stillspin.drive import Drive
from stillspin.drive.requester import wait_until
from stillspin.drive.state import ENERGISED, RUN

pytestmark = needs_board


@pytest.fixture
def drive(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with Drive.virtual("ideal", speed=0) as drive:
        yield drive


def passes(drive, seconds):
    """Wait until so much of the board's time is over, and see that the motor runs all the while."""
    end = drive.raw_status().time_ms + seconds * 1000
    while (status := drive.raw_status()).time_ms < end:
        assert status.state == RUN, drive.status()
        time.sleep(0.1)


def test_a_board_as_fast_as_possible_does_not_outrun_its_guard(drive):
    with drive.running(300):
        passes(drive, 20)
        assert drive.raw_status().held
    assert drive.raw_status().state not in ENERGISED
    assert not drive.raw_status().link & 2  # the context has stopped it, and not the guard


def test_it_waits_for_a_client_that_comes_late(drive):
    send = drive.link.transport.send

    def late(record):
        time.sleep(0.15)
        send(record)

    drive.set("link_timeout", 2000)
    with drive.running(300):
        drive.link.transport.send = late
        passes(drive, 10)
        drive.link.transport.send = send


def test_it_stops_when_nobody_holds_it(drive):
    drive.start(300, guarded=True)
    drive.holder = 0
    assert wait_until(lambda: drive.raw_status().link & 2, 20)
