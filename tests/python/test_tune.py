"""The page in the browser: who may talk to its server, and that the motor runs only while somebody holds it."""

import asyncio
import http.client
import json
import re
import threading
from urllib.parse import urljoin, urlsplit

import aiohttp
import pytest

from stillspin.drive.protocol import Request
from stillspin.drive.requester import wait_until
from stillspin.drive.scope import DEPTH
from stillspin.tune.actions import ACTIONS
from stillspin.tune.dead_man import PATIENCE, DeadMan
from stillspin.tune.guard import HEADERS
from stillspin.tune.server import Server

READY, RUN = 2, 4
ARMED, DONE = 2, 4


def get(server, path, headers=None, method="GET"):
    """Status, headers and body; `headers` replace what a browser would send."""
    connection = http.client.HTTPConnection("127.0.0.1", server.guard.port, timeout=5)
    connection.putrequest(method, path, skip_host=True)
    for name, value in {"Host": f"127.0.0.1:{server.guard.port}", **(headers or {})}.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, dict(answer.getheaders()), answer.read().decode(errors="replace")


def cookie(server):
    return {"Cookie": f"{server.guard.cookie}={server.guard.session}"}


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


def live(server, **changed):
    """What a browser sends to open the live connection from the page itself."""
    own = f"127.0.0.1:{server.guard.port}"
    headers = {
        "Host": own,
        "Origin": f"http://{own}",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        **cookie(server),
    }
    headers |= {name.replace("_", "-"): value for name, value in changed.items()}
    return get(server, "/live", {name: value for name, value in headers.items() if value is not None})


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


class Page:
    """The page's end of the live connection."""

    def __init__(self, socket):
        self.socket, self.number, self.seen = socket, 0, []

    async def hear(self, kind):
        while True:
            message = json.loads((await self.socket.receive(timeout=10)).data)
            self.seen.append(message)
            if message["t"] == kind:
                return message

    async def ask(self, what, **given):
        self.number += 1
        await self.socket.send_json({"t": "ask", "id": self.number, "what": what, "given": given})
        while True:
            reply = await self.hear("reply")
            if reply["id"] == self.number:
                return reply

    async def say(self, **message):
        await self.socket.send_json(message)


def talk(server, conversation):
    """Run a coroutine with a page that is connected."""

    async def connected():
        own = f"http://127.0.0.1:{server.guard.port}"
        async with (
            aiohttp.ClientSession(headers=cookie(server)) as session,
            session.ws_connect(f"{own}/live", origin=own) as socket,
        ):
            await asyncio.wait_for(conversation(Page(socket)), 60)  # s: what never comes is a failure, no hang

    asyncio.run(connected())


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


@pytest.fixture
def clock(server):
    """The dead man's clock, which only the test moves: [s]."""
    now = [0.0]
    switch = server.bench.dead_man
    switch.patience, switch.clock = PATIENCE, lambda: now[0]
    return now


async def hold(page, server, clock, times):
    """Say so many times that it is held, half a second of the dead man's clock apart; wait until it is understood."""
    for _ in range(times):
        before = server.bench.dead_man.heard
        clock[0] += 0.5
        await page.say(t="hold")
        await asyncio.to_thread(wait_until, lambda before=before: server.bench.dead_man.heard != before, 10)


def test_the_motor_runs_while_the_page_says_so_and_stops_when_it_is_silent(server, fake, clock):
    async def conversation(page):
        await page.ask("start", speed=300)
        assert fake.guarded
        await hold(page, server, clock, 10)
        assert server.bench.dead_man.heard == clock[0] > 4 * PATIENCE
        assert not wait_until(lambda: fake.state != RUN, 0.3)  # three rounds of the watch
        clock[0] += PATIENCE + 0.01
        note = await page.hear("note")
        assert note["text"] == "stopped: nothing was heard from the page"
        assert fake.state != RUN

    talk(server, conversation)


def test_the_motor_stops_when_the_page_lets_go_or_is_closed(server, fake):
    async def lets_go(page):
        await page.ask("start", speed=300)
        await page.say(t="release")
        assert wait_until(lambda: fake.state != RUN, 10)
        assert wait_until(lambda: fake.state == READY, 10)

    async def is_closed(page):
        await page.ask("start", speed=300)
        assert fake.state == RUN

    talk(server, lets_go)
    talk(server, is_closed)
    assert wait_until(lambda: fake.state != RUN, 10)


@pytest.mark.parametrize("lost", [1, 8], ids=["a slow answer", "no answer"])
def test_a_stop_that_failed_is_told_and_one_that_took_its_time_is_not(server, fake, lost):
    """The watch comes by every 0.1 s; an answer is waited for 0.3 s, and four times."""

    async def conversation(page):
        await page.ask("start", speed=300)
        fake.swallow += [Request.COMMAND] * lost
        reply = await page.ask("stop")
        assert ("error" in reply) == (lost > 1)
        while lost > 1 and not told(page):
            await page.hear("note")
        for _ in range(3):  # rounds of the watch
            await page.hear("status")
        assert told(page) == (lost > 1)
        assert fake.state != RUN

    def told(page):
        return any(message.get("text") == "stopped; it took more than one try" for message in page.seen)

    talk(server, conversation)


def test_a_page_that_goes_leaves_the_motor_of_another_alone_but_its_stop_is_for_everybody(server, fake, clock):
    async def is_closed(page):
        await page.ask("start", speed=300)
        fake.start(4711)  # meanwhile it has stopped, and another client has started it

    async def falls_silent(page):
        await page.ask("stop")
        assert await asyncio.to_thread(wait_until, lambda: fake.state == READY, 10)
        await page.ask("start", speed=300)
        fake.start(4711)
        clock[0] += PATIENCE + 0.01
        assert await asyncio.to_thread(wait_until, lambda: not server.bench.dead_man.release(), 10)
        assert not await asyncio.to_thread(wait_until, lambda: fake.state != RUN, 0.3)  # three rounds of the watch
        await page.ask("stop")
        assert fake.state != RUN

    fake.values[200] = 10000  # link_timeout: nobody keeps this guard alive here
    talk(server, is_closed)
    assert not wait_until(lambda: fake.state != RUN, 0.3)
    talk(server, falls_silent)


def test_a_page_that_only_looks_does_not_keep_the_motor_running(server, fake, clock):
    async def conversation(page):
        await page.ask("start", speed=300)
        own = f"http://127.0.0.1:{server.guard.port}"
        async with (
            aiohttp.ClientSession(headers=cookie(server)) as session,
            session.ws_connect(f"{own}/live", origin=own) as socket,
        ):
            second = Page(socket)
            for _ in range(3):
                clock[0] += 0.3
                await second.say(t="hold")
            assert await asyncio.to_thread(wait_until, lambda: fake.state != RUN, 10)
            assert "error" not in await second.ask("stop")

    talk(server, conversation)


def test_the_motor_stops_with_the_server(drive, fake):
    with Server(drive) as server:
        server.bench.start("somebody", 300)
        assert fake.state == RUN
    assert wait_until(lambda: fake.state != RUN, 10)


def test_the_drive_stops_by_itself_when_the_server_is_gone_without_a_word(drive, fake):
    server = Server(drive)
    server.bench.start("somebody", 300)
    assert wait_until(lambda: fake.state != RUN, 10)  # nobody asks the drive anything: its own guard acts


def test_a_start_that_is_refused_holds_nothing(server, fake):
    async def conversation(page):
        fake.raise_fault(1)
        assert "not in this state" in (await page.ask("start", speed=300))["error"]
        assert not server.bench.dead_man.release()

    talk(server, conversation)


def test_letting_go_while_the_start_is_under_way_stops(server, fake):
    bench = server.bench
    start = bench.drive.start

    def slow(*arguments, **options):
        start(*arguments, **options)
        bench.release("somebody", "")

    bench.drive.start = slow
    bench.start("somebody", 300)
    assert wait_until(lambda: fake.state != RUN, 10)


def test_stop_gets_through_while_every_thread_waits_for_a_capture(server, fake):
    fake.scope = ARMED  # a trigger that never comes
    setup = {"signals": ["speed"], "trigger": "speed", "level": 1, "edge": "rising", "decimation": 1, "before": 50}

    async def conversation(page):
        await page.ask("start", speed=300)
        for number in range(100, 140):
            await page.say(t="ask", id=number, what="capture", given=setup)
        assert "error" not in await page.ask("stop")
        assert fake.state != RUN

    talk(server, conversation)
    server.bench.begin_capture()  # the last one ends, too


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


def test_the_dead_mans_switch():
    now = [0.0]
    switch = DeadMan(0.5, lambda: now[0])
    assert not switch.expired()
    switch.take("a")
    now[0] = 0.4
    switch.tell("b")
    switch.tell("a")
    now[0] = 0.8
    assert not switch.expired()
    now[0] = 1.0
    assert switch.expired()
    assert not switch.expired()
    switch.tell("a")
    assert not switch.is_held_by("a")
    assert not switch.release("a")


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
