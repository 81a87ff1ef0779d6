"""What the page shows when the drive, the cable or the server is gone, and how it comes back: the real firmware."""

import re
import signal
import subprocess
import sys
import time

import pytest
from cable import Cable
from desk import board, needs_board

from stillspin.drive import Drive
from stillspin.drive.requester import wait_until
from stillspin.tune import connection
from stillspin.tune.server import Server

SLOW = 60
KNOWN_NO_LONGER = 1.0
"""Seconds of the page's own timer; the page needs 0.4, and a drive or a server some more."""
BEAT = 0.05
WATCH = f"""() => {{
  const state = document.getElementById("state");
  window.beats = 0;
  window.knownFor = null;
  setInterval(() => window.beats++, {1000 * BEAT});
  new MutationObserver(() => {{
    if (state.textContent === "not known") window.knownFor ??= window.beats;
  }}).observe(state, {{ childList: true, characterData: true, subtree: true }});
}}"""
"""Counts beats of the page until it says so: on a loaded computer they are late with everything that the page does."""
GREEN = """() => {
  const probe = document.body.appendChild(document.createElement("i"));
  probe.style.background = "var(--good)";
  const green = getComputedStyle(probe).backgroundColor;
  probe.remove();
  return [...document.querySelectorAll("button, .pill")]
    .filter((at) => at.checkVisibility() && getComputedStyle(at).backgroundColor === green)
    .map((at) => at.id);
}"""
"""What has the colour of a motor that runs."""


class Tune:
    """`stillspin tune` as a process of its own."""

    def __init__(self, port):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "stillspin", "tune", "--no-open", "--drive", port],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.address = ""
        for line in self.process.stdout:
            if found := re.match(r"page: (\S+)", line):
                self.address = found.group(1)
                break

    def signal(self, number):
        self.process.send_signal(number)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGCONT)
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    return tmp_path


def run(page):
    page.fill("#reference", "300")
    page.press("#reference", "Enter")
    page.check("#keep")
    page.click("#hold")
    page.wait_for_selector("#state.on:has-text('running')", timeout=1000 * SLOW)
    assert page.evaluate(GREEN) == ["state", "hold"]


def ready(page):
    page.wait_for_selector("#state:has-text('ready')", timeout=1000 * SLOW)


def not_known(page, break_off):
    """Break off, and wait until the page says so, in time; and that nothing known is left on it."""
    page.evaluate(WATCH)
    break_off()
    page.wait_for_selector("#state:text-is('not known')", timeout=1000 * SLOW)
    assert page.evaluate(GREEN) == []
    assert page.inner_text("#speed") == "–"
    assert set(page.locator("aside dd").all_inner_texts()) == {"–"}
    assert page.evaluate("window.knownFor") * BEAT < KNOWN_NO_LONGER


@needs_board
def test_a_server_that_stalls_leaves_nothing_green_and_the_page_says_what_the_motor_did(home, page):
    with board(home) as port, Tune(port) as tune:
        page.goto(tune.address)
        ready(page)
        run(page)
        not_known(page, lambda: tune.signal(signal.SIGSTOP))
        page.wait_for_selector("#lost:has-text('The server does not answer')")
        assert "link_timeout" in page.inner_text("#lost")
        time.sleep(1.0)  # the drive has stopped by itself
        tune.signal(signal.SIGCONT)
        ready(page)
        assert page.is_hidden("#lost")
        page.click("[data-tab=faults]")
        told = page.text_content("#events")
        assert "it heard nothing for its link_timeout" in told
        assert "known again after" in told
        assert page.inner_text("#hold") == "Start"  # nothing is held any more


@needs_board
def test_a_cable_that_is_pulled_at_the_computer_and_put_back(home, page):
    with board(home) as port, Cable(port, home) as cable, Tune(cable.port) as tune:
        page.goto(tune.address)
        ready(page)
        page.click("[data-tab=scope]")
        page.fill("#level", "77")
        run(page)
        not_known(page, cable.pull)
        page.wait_for_selector("#lost:has-text('there is no serial port')")  # it looks for it
        time.sleep(1.0)
        cable.plug()
        ready(page)
        assert page.is_hidden("#lost")
        assert page.input_value("#level") == "77"  # what was set up on the page is still there
        assert "is gone" in page.text_content("#events")
        run(page)


def test_a_cable_that_was_put_back_is_tried_at_once_when_a_person_asks(page, fake, tmp_path, monkeypatch):
    """By itself the server would try it again in an hour."""
    monkeypatch.setattr(connection, "_AGAIN", 3600.0)
    with Cable(fake.port, tmp_path) as cable:

        def opened():
            return Drive.open(f"serial://{cable.port}", timeout=0.3)

        with opened() as drive, Server(drive, reopen=opened) as server:
            page.goto(server.address)
            ready(page)
            not_known(page, cable.pull)
            page.wait_for_selector("#lost:has-text('there is no serial port')")
            cable.plug()
            time.sleep(1.5)
            assert page.inner_text("#state") == "not known"
            page.click("#again")
            ready(page)
            assert page.is_hidden("#lost")


@needs_board
def test_a_cable_that_is_pulled_at_the_drive_and_put_back(home, page):
    with board(home) as port, Cable(port, home) as cable, Tune(cable.port) as tune:
        page.goto(tune.address)
        ready(page)
        run(page)
        not_known(page, lambda: setattr(cable, "cut", True))
        page.wait_for_selector("#lost:has-text('does not answer')")
        time.sleep(1.0)
        cable.cut = False
        ready(page)
        assert page.is_hidden("#lost")
        page.wait_for_selector("[data-value=speed_reference]:not(:text-is('–'))")  # and the signals come again


@needs_board
def test_a_server_that_is_killed_and_started_again(home, page):
    with board(home) as port:
        with Tune(port) as tune:
            page.goto(tune.address)
            ready(page)
            run(page)
            not_known(page, lambda: tune.signal(signal.SIGKILL))
            page.wait_for_selector("#lost:has-text('Start stillspin tune again')")
        with Tune(port) as again:
            assert again.address.split("?")[0] == tune.address.split("?")[0]
            assert again.address != tune.address
            page.wait_for_selector("#lost:has-text('open the address that it has printed')")
            other = page.context.new_page()
            other.goto(again.address)
            ready(other)
            ready(page)  # with nothing more done to it
            other.close()


def test_a_drive_that_was_switched_off_and_on_is_said_and_its_values_are_read_again(page, fake):
    with (
        Drive.open(f"serial://{fake.port}", timeout=0.3) as drive,
        Server(drive, reopen=lambda: Drive.open(f"serial://{fake.port}", timeout=0.3)) as server,
    ):
        page.goto(server.address)
        ready(page)
        drive.set("speed_ramp", 500)
        page.reload()
        ready(page)
        page.click("[data-tab=parameters]")
        assert page.input_value("[data-name=speed_ramp] input") == "500"
        # A drive that had been on for a moment only could not be told from an answer that came late.
        assert wait_until(lambda: drive.raw_status().time_ms > 5000, SLOW)
        fake.switch_on_again()
        field = "[data-name=speed_ramp] input"
        assert wait_until(lambda: page.input_value(field) == "3000", SLOW)
        page.click("[data-tab=faults]")
        assert "switched off and on again" in page.text_content("#events")


@needs_board
def test_an_emergency_is_said_in_words_and_one_click_clears_it(home, page):
    with Drive.virtual(speed=1.0) as drive, Server(drive) as server:
        button = drive.link.transport
        drive.set("emergency_stop", 1)
        page.goto(server.address)
        ready(page)
        run(page)
        button.set_input("emergency", 1.0)
        page.wait_for_selector("#fault-words:has-text('emergency stop')")
        assert "bad" in page.get_attribute("#state", "class").split()
        assert "release it, then reset" in page.inner_text("#fault-remedy")
        page.click("#reset")
        page.wait_for_selector("#note:has-text('Still there: emergency stop')")
        button.set_input("emergency", 0.0)
        page.click("#reset")
        ready(page)
        assert page.is_hidden("#fault")
        page.click("[data-tab=faults]")
        assert "fault: emergency stop" in page.text_content("#events")
        run(page)
