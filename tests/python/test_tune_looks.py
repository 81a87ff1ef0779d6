"""How the page looks: nothing cut off or wasted at three sizes, units, words for numbers, and no lost samples."""

import re
import time
from pathlib import Path

import pytest
from desk import needs_board

from stillspin.drive import Drive
from stillspin.tune import choices
from stillspin.tune.actions import ACTIONS
from stillspin.tune.describe import describe
from stillspin.tune.server import Server

ROOT = Path(__file__).resolve().parents[2]
TABS = ("live", "parameters", "scope", "faults", "commissioning")
SIZES = [(1440, 900), (1024, 768), (390, 844)]
CUT_OFF = """() => [...document.querySelectorAll("body *")]
  .filter((at) => at.checkVisibility() && at.clientWidth && at.scrollWidth > at.clientWidth && at.tagName != "CANVAS")
  .map((at) => `${at.tagName} ${at.id} ${at.className}: ${at.scrollWidth} in ${at.clientWidth}`)"""
"""What is wider than the box that it stands in: words run out of it, or are reached by scrolling sideways alone."""


def expect_all_in_sight(page, server, width, height):
    """In every tab."""
    page.set_viewport_size({"width": width, "height": height})
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    for tab in TABS:
        page.click(f"[data-tab={tab}]")
        assert page.evaluate("document.documentElement.scrollWidth") == width
        for wide in page.locator("button:visible, input:visible, select:visible, canvas:visible").all():
            box = wide.bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width
        assert page.evaluate(CUT_OFF) == []
        sheet = page.locator(f"#{tab}").bounding_box()
        assert sheet["y"] + sheet["height"] > 0.95 * height


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_nothing_is_cut_off_and_no_third_of_it_is_empty(page, server, width, height):
    expect_all_in_sight(page, server, width, height)
    page.click("[data-tab=live]")
    last = page.locator("#plots canvas").last.bounding_box()
    assert last["y"] + last["height"] > 0.9 * height  # the plots, and not only their frame


@needs_board
def test_nothing_is_cut_off_of_all_that_a_drive_has_to_tell(page):
    """Every parameter and signal, and a fault in its words."""
    with Drive.virtual(speed=1.0) as drive, Server(drive) as server:
        for width, height in SIZES:
            expect_all_in_sight(page, server, width, height)
        drive.set("link_minimum", 390)
        page.click("[data-tab=live]")
        page.click("#chooser summary")
        page.check("#keep")
        page.click("#hold")
        page.wait_for_selector("#fault:has-text('link_minimum')")
        assert page.evaluate(CUT_OFF) == []


@needs_board
def test_numbers_that_stand_for_something_are_words_of_the_drive():
    with Drive.virtual(speed=0) as drive:
        table = drive.table

        def words(name):
            return choices.of_parameter(table.parameter(name))

        assert words("excitation")[4:] == ["long zero vector", "as 2, cheapest pair above"]
        assert words("position_source")[4:6] == ["observer alone", "CONV"]
        assert len(words("position_source")) == 9
        assert words("link_reaction") == ["stop", "coast"]
        assert words("current_law") == ["PI with space vectors", "hysteresis"]
        assert words("mtpa") == ["no", "yes"]
        assert words("pole_pairs") == words("current_divider") == words("speed_limit") == []
        said = choices.of_signals(drive)
        assert said["state"][2] == "ready"
        assert said["fault"][14] == "emergency stop"
        assert all(all(text for text in list_[1:]) for name, list_ in said.items() if name != "limit")


COUNTS = {"windows"}
"""Signals without a unit that are numbers, and stand for nothing."""


@needs_board
def test_every_signal_that_stands_for_something_has_all_the_drives_words():
    """Whole numbers without a unit: a new one is a count, or has words."""
    with Drive.virtual(speed=0) as drive:
        said = choices.of_signals(drive)
        whole = {signal.name for signal in drive.table.signals if not signal.unit and not signal.q}
        assert set(said) == whole - COUNTS
        assert whole > COUNTS
        kinds = {"state": "STATE", "start_phase": "START", "limit": "LIMIT", "wiring": "WIRING"}
        assert set(kinds) == set(said) - {"fault", "speed_known"}  # as many as the table says; a flag
        rows = (ROOT / "firmware" / "text" / "catalogue_list.h").read_text(encoding="utf-8")
        for name, kind in kinds.items():
            words = re.findall(rf'^WORDS\({kind}, \d+, "(.*)"\)$', rows, re.MULTILINE)
            assert said[name][: len(words)] == words
            assert len(said[name]) == (16 if name == "limit" else len(words))  # as many as its bits
        assert said["speed_known"] == ["no", "yes"]


@needs_board
def test_the_page_says_what_is_wired_wrongly_in_words_among_the_signals(page):
    planted = ["fault.from_power_on=true", "fault.gain_sensor=b", "fault.gain_sensor_factor=-1"]
    with Drive.virtual("bench", planted) as drive, Server(drive) as server:
        server.bench.plot(["wiring", "speed_known"])
        page.goto(server.address)
        page.wait_for_selector("[data-value=wiring]:has-text('no mistake found')")
        page.wait_for_selector("[data-value=speed_known]:text-is('no')")
        page.check("#keep")
        page.click("#hold")
        page.wait_for_selector("[data-value=wiring]:text-is('sensor b is reversed')")


@needs_board
def test_no_sample_is_lost_while_parameters_and_a_capture_are_read():
    with (
        Drive.virtual(speed=1.0) as drive,
        Server(drive) as server,
        drive.stream(["speed", "current_q"], 0.02) as stream,
    ):
        time.sleep(0.5)
        for _ in range(3):
            describe(server.bench.drive, server.bench.plotted)
        setup = {"trigger": "speed", "level": 0, "edge": "now", "decimation": 1, "before": 0}
        ACTIONS["capture"](server.bench, "somebody", {"signals": ["speed", "current_d"], **setup})
        assert stream.lost == 0, stream.why_lost()


def test_units_words_and_that_there_is_no_fault_are_said(page, server, fake):
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    page.wait_for_selector("[data-value=speed_reference]:has-text('rpm')")
    page.wait_for_selector("#now-fault:has-text('no fault')")
    page.click("#chooser summary")
    page.check("#signals input[value=state]")
    page.wait_for_selector("[data-value=state]:has-text('ready')")
    page.click("[data-tab=commissioning]")
    for box in page.locator("#wizard input[type=checkbox]").all():
        box.check()
    fake.pace = 100
    page.click("#commission")
    page.wait_for_selector("#time-left:has-text('left')")


def test_an_unknown_speed_is_said_and_looked_at_on_command(page, server, fake):
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    page.wait_for_selector("#shaft:has-text('the shaft may be turning')")
    assert page.inner_text("#speed") == page.inner_text("#now-reference") == "–"
    page.click("#look")
    page.wait_for_selector("#note:has-text('the shaft turns at 1059 rpm')")
    page.check("#keep")
    page.click("#hold")
    page.wait_for_selector("#state.on")
    page.wait_for_selector("#shaft", state="hidden")
    assert page.inner_text("#now-reference").endswith(" rpm")
    page.keyboard.press("Escape")
    page.wait_for_selector("#now-reference:text-is('–')")
