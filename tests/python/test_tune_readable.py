"""What the page shows can be read: contrast in light and dark, a unit on every axis, targets that a finger hits."""

import time

import page_contrast
import pytest
from fake_tables import SIGNALS
from test_tune_looks import TABS

from stillspin.drive.requester import wait_until

RECORD = """
(() => {
    window.drawn = new Map();
    const {fillText} = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
        const name = this.canvas.getAttribute('aria-label');
        window.drawn.set(name, (window.drawn.get(name) ?? new Set()).add(text));
        return fillText.call(this, text, ...rest);
    };
})()
"""
FINGER = 44  # px


@pytest.fixture
def tuned(page, server):
    page.add_init_script(RECORD)
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    return page


def states(page, fake, server):
    """Brings the page into each of its states; yields their names."""
    for tab in TABS:
        page.click(f"[data-tab={tab}]")
        yield tab
    page.click("[data-tab=live]")
    page.check("#keep")
    page.click("#hold")
    page.wait_for_selector("#state.on")
    yield "running"
    page.keyboard.press("Escape")
    page.wait_for_selector("#state:has-text('ready')")
    page.click("[data-tab=commissioning]")
    for box in page.locator("#wizard input[type=checkbox]").all():
        box.check()
    fake.pace = 100
    page.click("#commission")
    page.wait_for_selector("#time-left:has-text('left')")
    yield "commissioning"
    fake.raise_fault(1)
    page.wait_for_selector("#fault:visible")
    page.click("[data-tab=faults]")
    page.wait_for_selector("#history strong")
    yield "fault"
    fake.unplug()
    page.wait_for_selector("#lost:visible")
    yield "lost"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_and_edges_have_contrast_in_every_state(tuned, server, fake, scheme):
    tuned.emulate_media(color_scheme=scheme)
    for state in states(tuned, fake, server):
        assert page_contrast.pale_texts(tuned) == [], state
        assert page_contrast.pale_edges(tuned) == [], state
    for name, value in page_contrast.canvas_colours(tuned).items():
        assert value >= (page_contrast.LINE if name.startswith("--line") else page_contrast.TEXT), name


def test_every_axis_says_its_unit(tuned, server):
    """Of everything that can be plotted, and of a capture."""
    tuned.click("#chooser summary")
    table = [label.inner_text().split() for label in tuned.locator("#signals label").all()]
    assert len(table) > len(SIGNALS)  # and what is computed
    for name, *unit in table:
        server.bench.plot([name])
        tuned.wait_for_selector(f"[data-value={name}]")
        words = {" ".join(unit) or "(number)", "s"}
        assert wait_until(lambda: words <= set(drawn(tuned, f"{name} over time")), 10), (name, unit)  # noqa: B023
    tuned.click("[data-tab=scope]")
    tuned.click("#capture")
    tuned.wait_for_selector("#captured canvas")
    assert {"rpm", "ms"} <= set(drawn(tuned, "speed over time"))
    assert {"A", "ms"} <= set(drawn(tuned, "current_d, current_q over time"))


def test_under_the_pointer_a_state_is_a_word(tuned, server):
    """In a plot, and in a capture."""
    server.bench.plot(["state"])
    tuned.wait_for_selector("[data-value=state]:has-text('ready')")
    tuned.hover("#plots canvas")
    assert wait_until(lambda: "state ready" in drawn(tuned, "state over time"), 10)
    tuned.click("[data-tab=scope]")
    for channel, name in enumerate(("state", "speed", "", "")):
        tuned.select_option(f"[data-channel='{channel}']", name)
    tuned.evaluate("window.drawn.clear()")
    tuned.click("#capture")
    canvas = tuned.locator("#captured canvas").first
    box = canvas.bounding_box()
    for x in range(round(box["width"] / 4), round(box["width"] / 3)):  # the small drive's ramp is at its state there
        tuned.mouse.move(box["x"] + x, box["y"] + 50)
    assert wait_until(lambda: "state ready" in drawn(tuned, "state over time"), 10)


def drawn(page, label):
    return page.evaluate("(label) => [...(window.drawn.get(label) ?? [])]", label)


def test_a_finger_hits_what_it_should_on_a_phone(tuned):
    tuned.set_viewport_size({"width": 390, "height": 844})
    for tab in TABS:
        tuned.click(f"[data-tab={tab}]")
        for target in tuned.locator("button:visible, select:visible, input:visible, .button:visible").all():
            box = target.locator("xpath=ancestor-or-self::label[contains(@class, 'check')] | .").first.bounding_box()
            assert box["height"] >= FINGER, target.evaluate("(element) => element.outerHTML")


def test_words_that_come_and_go_move_nothing(tuned):
    """A note lies over the page; values keep their decimals."""
    before = tuned.locator("#hold").bounding_box()
    tuned.click("#look")
    tuned.wait_for_selector("#note:visible")
    assert tuned.locator("#hold").bounding_box() == before
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state.on")
    end = time.monotonic() + 1.5
    shown = set()
    while time.monotonic() < end:
        shown.add(tuned.inner_text("[data-value=current_q]"))
    numbers = {text for text in shown if text != "–"}
    assert numbers
    assert all(len(text.removesuffix(" A").partition(".")[2]) == 2 for text in numbers)
