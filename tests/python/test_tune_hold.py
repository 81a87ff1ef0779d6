"""The motor runs only while somebody holds it in the browser, and stops when nobody does."""

import asyncio

import aiohttp
import pytest
from tune_page import Page, cookie, talk

from stillspin.drive.protocol import Request
from stillspin.drive.requester import wait_until
from stillspin.tune.dead_man import PATIENCE, DeadMan
from stillspin.tune.server import Server

READY, RUN, ARMED = 2, 4, 2


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
