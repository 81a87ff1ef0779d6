"""The page in the browser: who may talk to its server, and what it is asked and answers."""

import re
import threading
from urllib.parse import urljoin, urlsplit

import pytest
from tune_page import cookie, get, live, talk

from stillspin.drive.protocol import Request
from stillspin.drive.requester import wait_until
from stillspin.drive.scope import DEPTH
from stillspin.tune.actions import ACTIONS
from stillspin.tune.guard import HEADERS
from stillspin.tune.server import Server

ARMED, DONE = 2, 4


def test_the_printed_address_opens_the_page_and_gives_the_cookie(server):
    path = server.address.split(str(server.guard.port), 1)[1]
    status, headers, body = get(server, path)
    assert (status, "<title>stillspin" in body) == (200, True)
    given = headers["Set-Cookie"]
    assert given.startswith(f"{server.guard.cookie}={server.guard.session};")
    assert "HttpOnly" in given
    assert "SameSite=Strict" in given
    assert {name: headers[name] for name in HEADERS} == HEADERS
    assert get(server, "/page/app.js", cookie(server))[0] == 200


def test_two_starts_have_two_tokens(drive, server):
    with Server(drive) as other:
        assert other.guard.token != server.guard.token
        assert get(other, f"/?token={server.guard.token}")[0] == 403


@pytest.mark.parametrize(
    "path", ["/", "/?token=", "/?token=guess", "/live", "/page/app.js", "/page/../server.py", "/x"]
)
def test_nothing_without_the_token(server, path):
    status, headers, body = get(server, path)
    assert status == 403
    assert "token" in body
    assert "Set-Cookie" not in headers


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "0.0.0.0:{port}", ""]
)
def test_a_rebound_name_is_refused_even_with_the_token(server, host):
    host = host.format(port=server.guard.port)
    for path in (f"/?token={server.guard.token}", "/page/app.js"):
        status, _, body = get(server, path, {"Host": host, **cookie(server)})
        assert (status, "own names only" in body) == (403, True)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1:{port}"])
def test_another_origin_is_refused_even_with_the_cookie(server, origin):
    status, _, body = live(server, Origin=origin.format(port=server.guard.port))
    assert (status, "other pages" in body) == (403, True)


def test_a_live_connection_without_an_origin_is_refused(server):
    assert live(server, Origin=None)[0] == 403
    assert live(server, Sec_Fetch_Site="cross-site")[0] == 403
    assert live(server, Cookie=None)[0] == 403


def test_only_reading_is_known(server):
    assert get(server, "/", cookie(server), method="POST")[0] == 405


def test_the_server_is_on_the_loopback_only(server):
    assert server._socket.getsockname()[0] == "127.0.0.1"
    assert urlsplit(server.address).hostname == "127.0.0.1"


def test_the_page_learns_the_table_and_changes_a_parameter(server, fake):
    async def conversation(page):
        hello = await page.hear("hello")
        assert {entry["name"] for entry in hello["parameters"]} == set(hello["values"])
        ramp = next(entry for entry in hello["parameters"] if entry["name"] == "speed_ramp")
        assert (ramp["unit"], ramp["group"], ramp["maximum"]) == ("rpm/s", "Control", 100000)
        assert (await page.ask("set", name="speed_ramp", value="500"))["result"] == {"value": 500, "conflict": ""}
        reply = await page.ask("set", name="current_limit", value="99")
        assert reply["error"] == "current_limit: 99 A is out of range; 0.10 … 16.00 A"
        samples = await page.hear("samples")
        assert len(samples["values"]) == 4

    talk(server, conversation)
    assert fake.values[86] == 500 * 2**8


def test_what_the_server_does_not_know_is_said_and_harms_nothing(server):
    async def conversation(page):
        for text in ("", "[]", "{}", "null", '{"t": 5}', '{"t": "ask"}', "\u0000"):
            await page.socket.send_str(text)
        assert "does not know" in (await page.ask("rm"))["error"]
        assert "'fast' is no number" in (await page.ask("start", speed="fast"))["error"]
        assert "no signal 'x'" in (await page.ask("plot", signals=["x"]))["error"]
        for what in ("set", "start", "ref", "plot", "phase", "capture"):
            error = (await page.ask(what))["error"]
            assert "must be" in error or "None is no number" in error
        assert (await page.ask("values"))["result"]["current_limit"] == 14.0

    talk(server, conversation)
    assert set(ACTIONS) >= {"start", "stop", "coast", "set", "capture", "faults", "commission"}


def test_the_next_capture_ends_the_one_before(server, fake):
    fake.scope = ARMED
    setup = {"signals": ["speed"], "trigger": "speed", "level": 1, "edge": "rising", "decimation": 1, "before": 50}

    async def conversation(page):
        await page.say(t="ask", id=77, what="capture", given=setup)
        await page.hear("scope")
        await page.say(t="ask", id=78, what="capture", given=setup)
        reply = await page.hear("reply")
        assert reply == {"t": "reply", "id": 77, "error": "another capture was started and ended this one"}
        fake.scope = DONE
        assert len((await page.hear("reply"))["result"]["time"]) == DEPTH

    talk(server, conversation)


def test_what_is_urgent_is_asked_before_all_that_waits(drive, fake):
    """Also before the repetition of a question that gets no answer."""
    fake.swallow += [Request.STATUS] * 2
    slow = [threading.Thread(target=drive.raw_status) for _ in range(6)]
    for thread in slow:
        thread.start()
    assert wait_until(lambda: len(fake.swallow) == 1, 10)  # the first has been swallowed: it is waited for
    fake.asked.clear()
    drive.stop()
    assert Request.COMMAND in fake.asked[:2]
    for thread in slow:
        thread.join(10)
    assert fake.asked.count(Request.STATUS) == 6


def test_the_books_pages_are_served_and_every_link_of_the_guide_leads_to_one(server):
    """With the cookie alone, like everything else here; a link that leaves the book is its words."""
    assert get(server, "/book/tuning.md")[0] == 403
    for start in ("tuning", "parameters"):
        status, headers, body = get(server, f"/book/{start}.md", cookie(server))
        assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
        targets = set(re.findall(r'(?:href|src)="([^"#]+)(?:#[^"]*)?"', body)) - {"data:,"}
        assert len(targets) > 4
        for target in targets:
            assert get(server, urljoin(f"/book/{start}.md", target), cookie(server))[0] == 200, target
    assert 'id="speed_ramp"' in body
    assert get(server, "/book/nothing.md", cookie(server))[0] == 404
    assert get(server, "/book/..%2FREADME.md", cookie(server))[0] == 404
    assert "../" not in get(server, "/book/architecture.md", cookie(server))[2]
