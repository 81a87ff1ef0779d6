"""The page, the client and the firmware together: what a person does with a motor, in a headless browser.

The picture of each step goes to the directory that the variable STILLSPIN_PICTURES names, from the root of the
repository, for the book (make pictures).
"""

import os
from contextlib import chdir, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from desk import PATIENT, board, needs_board

from stillspin import core
from stillspin.drive import Drive
from stillspin.drive.requester import wait_until
from stillspin.tune.server import Server

pytestmark = needs_board
ROOT = Path(__file__).parents[2]
SLOW = 30
LONG = 240


@contextmanager
def opened(page, *options, edition="lab"):
    """The page of a board of its own, and the drive."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(core.EDITION, edition)  # of the board's process
        with _opened(page, *options) as drive:
            patch.undo()
            yield drive


@contextmanager
def _opened(page, *options):
    with (
        TemporaryDirectory() as directory,
        chdir(directory),
        board(Path(), *options) as port,  # whose name is on the pictures
        Drive.open(port, timeout=2.0) as drive,
        Server(drive, patience=PATIENT) as server,
    ):
        page.set_default_timeout(1000 * SLOW)
        page.goto(server.address)
        page.wait_for_selector("#state:has-text('ready')")
        yield drive


@pytest.fixture
def tuned(tmp_path, monkeypatch, page):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    with opened(page, "--profile", "ideal") as drive:
        drive.set("link_timeout", 1000 * SLOW)  # of the drive's time
        yield page


def picture(page, name):
    directory = os.environ.get("STILLSPIN_PICTURES")
    if directory:
        page.screenshot(path=ROOT / directory / f"tune-{name}.png")


def speed(page):
    return float(page.inner_text("#speed").replace("−", "-"))


def refer(page, rpm):
    page.fill("#reference", str(rpm))
    page.press("#reference", "Enter")


def colours(page, home):
    """Of each signal that is plotted there: what it is drawn in."""
    return {
        value.get_attribute("data-value"): value.evaluate("b => b.parentNode.querySelector('.key').style.background")
        for value in page.locator(f"{home} [data-value]").all()
    }


def change(page, name, value):
    page.click("[data-tab=parameters]")
    field = page.locator(f"[data-name={name}] input")
    field.fill(str(value))
    field.press("Enter")
    page.wait_for_selector(f"[data-name={name}].changed")


def test_a_motor_is_started_tuned_captured_and_its_fault_understood(tuned):
    # Start, and see the speed follow the reference.
    refer(tuned, 300)
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state:has-text('running')")
    tuned.wait_for_selector("#hold:text-is('Running: press to stop')")
    assert wait_until(lambda: abs(speed(tuned) - 300) < 6, SLOW)

    # Change a parameter, and see the speed follow it: with a slower ramp it takes seconds.
    change(tuned, "speed_ramp", 200)
    tuned.click("[data-tab=live]")
    refer(tuned, 600)
    assert not wait_until(lambda: speed(tuned) > 590, 0.8)
    assert wait_until(lambda: abs(speed(tuned) - 600) < 8, SLOW)
    change(tuned, "speed_ramp", 6000)

    # Capture a step, triggered by the speed.
    tuned.click("[data-tab=scope]")
    tuned.fill("#level", "800")
    tuned.locator("#level").blur()
    tuned.click("#capture")
    tuned.wait_for_selector("#scope-note.armed")  # the part before the trigger is recorded
    assert tuned.inner_text("#scope-note") == "armed, waits for speed: it rises through 800 rpm"
    of_live = colours(tuned, "#plots")
    refer(tuned, 1000)
    tuned.wait_for_selector("#captured canvas")
    assert "512 records every 0.4 ms" in tuned.inner_text("#scope-note")
    captured = colours(tuned, "#captured")
    assert captured == {name: of_live[name] for name in ("speed", "current_d", "current_q")}
    picture(tuned, "scope")
    tuned.click("[data-tab=live]")
    refer(tuned, 400)
    assert wait_until(lambda: abs(speed(tuned) - 400) < 8, SLOW)
    tuned.click("#freeze")
    drawn = tuned.locator("#plots").screenshot()
    assert tuned.locator("#plots").screenshot() == drawn
    tuned.select_option("#window", "5")  # what is frozen is drawn anew
    assert tuned.locator("#plots").screenshot() != drawn
    tuned.click("#freeze")
    picture(tuned, "live")

    # What may not change while it runs says why.
    tuned.click("[data-tab=parameters]")
    assert tuned.locator("[data-name=pole_pairs] input").is_disabled()
    picture(tuned, "parameters")
    tuned.keyboard.press("Escape")
    tuned.wait_for_selector("#state:has-text('ready')")

    # A fault, in words, with what to do.
    change(tuned, "link_minimum", 350)
    tuned.click("#hold")
    tuned.wait_for_selector("#fault-words:has-text('DC link below link_minimum')")
    tuned.click("[data-tab=faults]")
    tuned.wait_for_selector("#history:has-text('DC link below link_minimum')")
    assert "check the supply" in tuned.inner_text("#history")
    tuned.wait_for_selector("#hold:has-text('Start')")  # nothing is held any more
    picture(tuned, "fault")


def test_what_the_edition_of_a_drive_leaves_out_has_no_panel(tmp_path, monkeypatch, page):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    with opened(page, edition="minimal"):
        assert page.inner_text("#edition") == (
            "Edition minimal of the firmware leaves out: scope, commissioning, store, CAN bus, look."
        )
        tabs = page.locator("[role=tab]:visible")
        assert tabs.all_inner_texts() == ["Live", "Parameters", "Faults"]
        tabs.nth(0).press("ArrowLeft")
        assert page.is_visible("#faults"), "by the keys as well"
        change(page, "speed_ramp", 500)
        assert page.inner_text("#store-note") == "Changes are in effect; they last until the drive is switched off."
        assert not page.is_visible("#save")
        assert not page.is_visible("#store")
        look = page.locator("#look")
        assert look.get_attribute("data-part") == "look" and look.evaluate("button => button.hidden")
        assert page.locator("[data-name=can_node]").count() == 0
        assert "STORE" not in page.inner_text("aside").upper().replace(page.inner_text("#edition").upper(), "")
    with opened(page, edition="lab"):
        assert not page.is_visible("#edition")
        assert tabs.count() == 5
        page.click("[data-tab=parameters]")
        assert page.is_visible("#save")


def test_a_page_that_is_closed_stops_the_real_firmware(tuned):
    refer(tuned, 300)
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state:has-text('running')")
    other = tuned.context.new_page()
    address = tuned.url
    tuned.close()
    other.goto(address)
    other.wait_for_selector("#state:has-text('ready')", timeout=1000 * SLOW)
    other.close()
