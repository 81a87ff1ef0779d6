"""The page as a person sees it, in the Chromium that is installed, with the small drive of fake_drive.py behind it."""

import time

import pytest

from stillspin import csv_table
from stillspin.drive.requester import wait_until

READY, START, RUN = 2, 3, 4


@pytest.fixture
def tuned(page, server):
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    return page


def hold(tuned):
    box = tuned.locator("#hold").bounding_box()
    tuned.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    tuned.mouse.down()


def test_the_token_leaves_the_address_line_and_a_reload_works(tuned, server):
    assert tuned.url == f"http://127.0.0.1:{server.guard.port}/"
    tuned.reload()
    tuned.wait_for_selector("#state:has-text('ready')")


def test_holding_the_button_runs_the_motor(tuned, fake):
    tuned.fill("#reference", "300")
    tuned.press("#reference", "Enter")
    hold(tuned)
    tuned.wait_for_selector("#state:has-text('run')")
    assert wait_until(lambda: float(tuned.inner_text("#speed")) > 290, 15)
    time.sleep(1.0)
    assert fake.state == RUN
    tuned.mouse.up()
    tuned.wait_for_selector("#state:has-text('ready')")


def test_a_speed_that_is_refused_is_marked_until_another_is_taken(tuned):
    tuned.fill("#reference", "1,000")
    tuned.press("#reference", "Enter")
    tuned.wait_for_selector("#reference.refused")
    tuned.fill("#reference", "300")
    tuned.press("#reference", "Enter")
    tuned.wait_for_selector("#reference:not(.refused)")


@pytest.mark.parametrize(("keep", "ends"), [(True, "press to stop"), (False, "let go to stop")])
def test_the_button_says_no_more_of_the_motor_than_the_drive_has_said(tuned, fake, keep, ends):
    tuned.evaluate(
        """() => {
            const button = document.getElementById('hold');
            window.said = [];
            new MutationObserver(() => window.said.push(button.textContent)).observe(button, {childList: true});
        }"""
    )
    tuned.set_checked("#keep", keep)
    fake.begins = START
    hold(tuned)
    tuned.wait_for_selector(f"#hold:text-is('Start: {ends}')")
    assert tuned.inner_text("#state") == "start"
    fake.state = RUN
    tuned.wait_for_selector(f"#hold:text-is('Run: {ends}')")
    assert tuned.inner_text("#state") == "run"
    held = [words for words in tuned.evaluate("window.said") if ends in words]
    assert list(dict.fromkeys(held)) == [f"{word}: {ends}" for word in ("Asked to start", "Start", "Run")]
    tuned.keyboard.press("Escape")
    tuned.wait_for_selector("#state:has-text('ready')")
    tuned.wait_for_selector(f"#hold:text-is('{'Start' if keep else 'Hold to run'}')")


def test_the_space_bar_and_escape(tuned, fake):
    tuned.keyboard.down(" ")
    tuned.wait_for_selector("#state:has-text('run')")
    tuned.keyboard.up(" ")
    tuned.wait_for_selector("#state:has-text('ready')")
    tuned.check("#keep")
    tuned.click("#hold")
    time.sleep(1.0)
    assert fake.state == RUN
    tuned.keyboard.press("Escape")
    tuned.wait_for_selector("#state:has-text('ready')")
    tuned.fill("#reference", "10")
    tuned.press("#reference", " ")  # a space in a field is a space
    assert fake.state == READY


def test_a_page_that_is_hidden_or_closed_stops_the_motor(tuned, fake):
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state:has-text('run')")
    tuned.evaluate(
        """() => {
            Object.defineProperty(document, 'hidden', {get: () => true});
            document.dispatchEvent(new Event('visibilitychange'));
        }"""
    )
    assert wait_until(lambda: fake.state != RUN, 10)
    assert wait_until(lambda: fake.state == READY, 10)
    tuned.reload()
    tuned.wait_for_selector("#state:has-text('ready')")
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state:has-text('run')")
    tuned.goto("about:blank")
    assert wait_until(lambda: fake.state != RUN, 10)


def test_a_page_that_hangs_stops_the_motor(tuned, fake):
    tuned.check("#keep")
    tuned.click("#hold")
    tuned.wait_for_selector("#state:has-text('run')")
    tuned.evaluate("() => { const end = Date.now() + 4000; while (Date.now() < end); }")
    assert fake.state != RUN


def test_parameters_are_searched_changed_and_refused_in_words(tuned, fake):
    tuned.click("[data-tab=parameters]")
    tuned.fill("#search", "ramp")
    assert tuned.locator(".parameter:visible").count() == 1
    field = tuned.locator("[data-name=speed_ramp] input")
    field.fill("500")
    field.press("Enter")
    tuned.wait_for_selector("[data-name=speed_ramp].changed")
    assert fake.values[86] == 500 * 2**8
    field.fill("200000")
    field.press("Enter")
    error = tuned.wait_for_selector("[data-name=speed_ramp] .error:visible")
    assert error.inner_text() == "speed_ramp: 200000 rpm/s is out of range; 0 … 100000 rpm/s"


@pytest.mark.parametrize(
    ("unsent", "said"),
    [
        (3, "3 samples did not arrive: not sent, the drive's port has no room for so many"),
        (0, "3 samples did not arrive: lost on the way, this computer is too busy"),
    ],
)
def test_samples_that_did_not_arrive_are_said_beside_the_plots_with_the_cause(tuned, fake, unsent, said):
    tuned.wait_for_selector("[data-value=current_d]")
    time.sleep(1.2)  # s: the server asks for the cause once a second at most
    assert tuned.inner_text("#stream-lost") == ""
    fake.unsent, fake.missing = unsent, 3
    lost = tuned.wait_for_selector(f'#stream-lost:has-text("{said}")')
    assert lost.get_attribute("title") == "The time axis has a gap there."


def test_a_capture_a_fault_and_the_commissioning_are_shown(tuned, fake, drive):
    tuned.click("[data-tab=scope]")
    tuned.click("#capture")
    tuned.wait_for_selector("#captured canvas")
    assert "512 records every 0.4 ms" in tuned.inner_text("#scope-note")
    with tuned.expect_download() as download:
        tuned.click("#download")
    about, rows = csv_table.read(download.value.path())
    assert about["firmware"] == drive.identity.text
    assert list(rows[0]) == ["time [s]", "speed [rpm]", "current_d [A]", "current_q [A]"]
    tuned.click("[data-tab=commissioning]")
    assert tuned.locator("#commission").is_disabled()
    for box in tuned.locator("#wizard input[type=checkbox]").all():
        box.check()
    tuned.click("#commission")
    tuned.wait_for_selector("#wizard :text('too few samples')")
    fake.raise_fault(1)
    tuned.wait_for_selector("#fault-words:has-text('over-current')")
    tuned.click("[data-tab=faults]")
    assert "over-current: the comparator opened the gates" in tuned.inner_text("#history")
    tuned.click("#reset")
    tuned.wait_for_selector("#state:has-text('ready')")


def test_an_unplugged_drive_is_said(tuned, fake):
    fake.unplug()
    tuned.wait_for_selector("#lost:visible")
    assert "is gone" in tuned.inner_text("#lost")


def test_another_site_in_the_same_browser_gets_nothing(tuned, server):
    """With the page's cookie in the jar: not as a script, a fetch, a frame, nor as a live connection."""
    other = tuned.context.new_page()
    other.route(
        "http://evil.example/", lambda route: route.fulfill(body="<title>evil</title>", content_type="text/html")
    )
    other.goto("http://evil.example/")
    outcome = other.evaluate(
        """async (own) => {
            const load = (make) => new Promise((resolve) => {
                const element = make();
                element.onload = () => resolve('loaded');
                element.onerror = () => resolve('refused');
                document.body.append(element);
            });
            const code = {src: own + 'page/app.js'};
            const script = await load(() => Object.assign(document.createElement('script'), code));
            const socket = await new Promise((resolve) => {
                const live = new WebSocket(own.replace('http', 'ws') + 'live');
                live.onopen = () => resolve('opened');
                live.onerror = () => resolve('refused');
            });
            const text = await fetch(own, {credentials: 'include'}).then((answer) => answer.text(), () => 'refused');
            return {script, socket, text};
        }""",
        f"http://127.0.0.1:{server.guard.port}/",
    )
    assert outcome == {"script": "refused", "socket": "refused", "text": "refused"}
    other.close()


def test_a_parameter_leads_to_what_it_does_and_the_guide_is_a_click_away(tuned):
    tuned.click("[data-tab=parameters]")
    for link in ("#guide", ".parameter[data-name=speed_ramp] .name a"):
        assert "a motor that runs from here stops" in tuned.locator(link).get_attribute("title")
    with tuned.expect_popup() as opened:
        tuned.click(".parameter[data-name=speed_ramp] .name a")
    book = opened.value
    heading = book.locator("h3#speed_ramp")
    heading.wait_for()
    assert book.evaluate("document.querySelector(':target').id") == "speed_ramp"
    # A page is scrolled when it is laid out, to a whole pixel.
    assert wait_until(lambda: -1 < heading.bounding_box()["y"] < 100, 20.0), heading.bounding_box()
    assert book.evaluate("document.documentElement.scrollWidth") == 1280
    tuned.click("#guide")  # into the tab that is open
    book.wait_for_selector("h1:has-text('Tuning by what you see')")
    pictures = "[...document.images].every((image) => image.complete && image.naturalWidth > 0)"
    assert wait_until(lambda: book.evaluate(pictures), 20.0)  # not polled in the page, which forbids code from text
    book.set_viewport_size({"width": 390, "height": 844})
    assert book.evaluate("document.documentElement.scrollWidth") == 390
