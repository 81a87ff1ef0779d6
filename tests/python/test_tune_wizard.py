"""The wizard for a motor: ten questions, what will work, set, measured, saved; at three sizes, real firmware."""

import importlib

import pytest
from desk import needs_board
from test_motor_files import ANSWERS, findings
from test_tune_looks import CUT_OFF, SIZES
from test_tune_on_board import LONG, SLOW, change, opened, picture

from stillspin.cases import nameplate, questions
from stillspin.drive import Drive
from stillspin.errors import InputError
from stillspin.tune import plate
from stillspin.tune.server import Server

HONEST = 0.3
TYPED = {flag.removeprefix("--").replace("-", "_"): value for flag, value in ANSWERS.items()}


def fits(page):
    """Nothing sticks out, at any of the sizes."""
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        assert page.evaluate("document.documentElement.scrollWidth") == width
        assert page.evaluate(CUT_OFF) == []
        for wide in page.locator("#wizard button:visible, #wizard input:visible, #wizard table:visible").all():
            box = wide.bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width


def follow_the_time_left(page):
    """(when, seconds that are said to be left, share done) until it is over; when in the drive's seconds."""
    page.evaluate("""() => {
        window.said = [];
        const look = () => {
            const words = document.getElementById('time-left')?.textContent ?? '';
            const [, number, unit] = words.match(/about ([\\d.]+) (s|min)/) ?? [];
            const time = Number(document.getElementById('time').dataset.seconds);
            const done = document.querySelector('progress')?.value;
            if (number) window.said.push([time, number * (unit === 'min' ? 60 : 1), done]);
        };
        const all = {childList: true, subtree: true, characterData: true};
        new MutationObserver(look).observe(document.getElementById('wizard'), all);
    }""")


@needs_board
def test_a_motor_is_asked_for_checked_set_measured_and_saved(tmp_path, monkeypatch, page):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    options = ("--speed", "0", "--eeprom", str(tmp_path / "memory"))
    with opened(page, *options) as drive:
        change(page, "link_timeout", 60000)  # of the drive's time, which goes faster than ours
        page.click("[data-tab=commissioning]")
        fields = page.locator("#wizard [data-key]")
        assert fields.count() == len(questions.QUESTIONS) == 10
        for key, typed in (TYPED | {"resistance": "0.25"}).items():
            page.fill(f"#wizard [data-key={key}]", typed)
        page.click("#plate-check")
        page.wait_for_selector("#plate-found .findings", timeout=1000 * LONG)
        found = page.inner_text("#plate-found")
        assert "works\ntried: started, 3" in found
        assert "will not work" not in found
        assert "stator_resistance" in found
        fits(page)
        page.click("#plate-use")
        page.wait_for_selector("#commission")
        assert drive.get("stator_resistance") == pytest.approx(0.25, abs=1e-4)
        fits(page)
        assert page.locator("#commission").is_disabled()
        for box in page.locator("#wizard input[type=checkbox]").all():
            box.check()
        page.click("#commission")
        page.wait_for_selector("#state:has-text('commissioning')")
        page.wait_for_selector("#hold:text-is('Commissioning: press to stop')")
        follow_the_time_left(page)
        page.wait_for_selector("#wizard :text('DC staircase')")
        fits(page)
        page.wait_for_selector("#keep-results", timeout=1000 * LONG)
        said = page.evaluate("window.said")
        end = said[-1][0]
        late = [(at, left, end - at) for at, left, done in said if done > 0.25 and end - at > 5.0]
        assert len(late) > 10
        assert [row for row in late if abs(row[1] - row[2]) > HONEST * row[2]] == []
        assert "Every value is plausible and in use." in page.inner_text("#wizard")
        assert "not by this page" not in page.inner_text("body")
        row = page.locator("#wizard tr", has_text="stator_resistance").inner_text()
        assert "0.25" in row
        assert "plausible, in use" in row
        fits(page)
        page.set_viewport_size({"width": 1280, "height": 860})
        picture(page, "commissioning")
        page.click("#keep-results")
        page.wait_for_selector("#store:has-text('the values have been saved')")
        kept = drive.parameters()
        assert abs(kept["stator_resistance"] - 0.32) < 0.05
    with opened(page, *options) as drive:
        assert drive.parameters() == kept
        assert "the saved values are in force" in page.inner_text("#store")


@needs_board
def test_what_will_not_work_is_said_with_its_numbers(page):
    with Drive.virtual() as drive, Server(drive) as server:
        page.set_default_timeout(1000 * SLOW)
        page.goto(server.address)
        page.wait_for_selector("#state:has-text('ready')")
        page.click("[data-tab=commissioning]")
        page.fill("[data-key=speed]", "25000")
        page.fill("[data-key=pole_pairs]", "1,5")
        page.click("#plate-check")
        page.wait_for_selector("#plate-found .error:has-text('no comma')")
        page.fill("[data-key=pole_pairs]", "4")
        page.click("#plate-check")
        page.wait_for_selector("#plate-found :text('range: speed_limit: 25000 rpm is out of range; 10 … 20000 rpm')")
        page.wait_for_selector("#plate-found :text('link_maximum is 420 V')")
        assert page.inner_text("#plate-use") == "Set in the drive all the same"
        page.fill("[data-key=speed]", "3300")
        assert page.inner_text("#plate-found") == ""  # it was about other answers
        page.click("#plate-check")
        page.wait_for_selector("#plate-found :text('No problem found in 12 checks')")


@needs_board
def test_the_page_says_what_motor_check_says(tmp_path):
    """The same numbers, but for the start that is tried, in another state of the noise."""
    native = importlib.import_module("stillspin._core")
    with Drive.virtual(speed=0) as drive, Server(drive) as server:
        said = plate.check(server.bench, TYPED)["findings"]
    file = findings(native, tmp_path, questions.file_text("motor", questions.read(TYPED)))
    assert {one["title"] for one in said} == set(file)
    for one in said:
        assert one["works"] == file[one["title"]].works
        if one["title"] not in {"range", "tried"}:
            assert one["words"] == file[one["title"]].words


@needs_board
def test_without_the_virtual_drive_the_rest_is_looked_at_and_what_is_missing_is_said(monkeypatch):
    def missing():
        raise InputError("this needs the virtual drive, which is missing")

    with Drive.virtual(speed=0) as drive, Server(drive) as server:
        monkeypatch.setattr(plate.core, "load", missing)
        monkeypatch.setattr(plate, "_elsewhere", plate.of_the_virtual_drive)
        found = plate.check(server.bench, TYPED)
    assert found["missing"].endswith("no start was tried: this needs the virtual drive, which is missing")
    titles = {one["title"] for one in found["findings"]}
    assert {"range", "ripple", "polarity", "top speed"} <= titles
    assert not titles & {"drive's rules", "tried"}


@needs_board
def test_what_is_not_typed_anew_stays_to_the_last_digit():
    with Drive.virtual(speed=0) as drive, Server(drive) as server:
        before = drive.parameters()
        answers = {row["key"]: row["known"] for row in plate.asked(drive.table, before)}
        changed = {row["name"] for row in plate.check(server.bench, answers)["changes"]}
        assert changed == {"weakening_limit"}  # what the rule for motors has; the default of motor A is another
        assert plate.use(server.bench, answers | {"emf": "41.04"})["complaints"] == []
        assert drive.get("magnet_flux") == pytest.approx(0.08, abs=1e-4)
        assert drive.get("stator_resistance") == before["stator_resistance"]


def test_the_voltage_constant_is_that_of_a_sine():
    """82.07 V rms between wires at 1000 rpm and 4 pole pairs: 0.16 Vs."""
    assert questions.magnet_flux(82.07, 4) == pytest.approx(0.16, rel=1e-3)
    limits = questions.stated(questions.read(TYPED))
    assert nameplate.following(questions.plant(questions.read(TYPED)), limits)["inductance_d"] == pytest.approx(4.9)
