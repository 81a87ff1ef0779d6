"""The pages that are open: each has a live connection, says what it wants and is told what the drive says."""

from __future__ import annotations

import asyncio
import contextlib
import json
import uuid
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor

from aiohttp import WSCloseCode, WSMsgType, web

from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.tune.actions import ACTIONS, SAFE
from stillspin.tune.describe import describe
from stillspin.tune.messages import Message
from stillspin.tune.workbench import Workbench

_LARGEST = 1 << 20
_HEARTBEAT = 5.0
_BEAT = 0.2
"""Seconds between signs of life: a page that hears none knows that the server, not the drive, is silent."""
_FAREWELL = 1.0
"""Seconds for a page to answer that the connection ends."""
_BACKLOG = 400
"""Messages that may wait for a page that does not fetch them."""


class Pages:
    """All methods run in the server's loop, `tell` from any thread."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._pages: dict[str, asyncio.Queue[str]] = {}
        self._connections: set[web.WebSocketResponse] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        # What stops the motor has threads of its own: others may wait for the drive for long.
        self._safe = ThreadPoolExecutor(4, "stillspin stop")
        self.bench: Workbench

    def tell(self, message: Message) -> None:
        """To all pages."""
        text = _text(message)

        def deliver() -> None:
            for queue in self._pages.values():
                if not queue.full():
                    queue.put_nowait(text)

        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(deliver)

    async def beat(self) -> None:
        """Says without end that the server lives."""
        while True:
            self.tell({"t": "beat"})
            await asyncio.sleep(_BEAT)

    async def live(self, request: web.Request) -> web.StreamResponse:
        """One page: what it says goes to the workbench, what the drive says goes to it."""
        connection = web.WebSocketResponse(heartbeat=_HEARTBEAT, max_msg_size=_LARGEST, timeout=_FAREWELL)
        await connection.prepare(request)
        self._connections.add(connection)
        who = uuid.uuid4().hex
        queue: asyncio.Queue[str] = asyncio.Queue(_BACKLOG)
        sender = asyncio.create_task(_send(connection, queue))
        try:
            with contextlib.suppress(DriveError):  # it is away: all pages are told when it is back
                await queue.put(_text(await asyncio.to_thread(describe, self.bench.drive, self.bench.plotted)))
            self._pages[who] = queue
            async for message in connection:
                if message.type == WSMsgType.TEXT:
                    self._hear(who, queue, message.data)
        finally:
            self._pages.pop(who, None)
            self._connections.discard(connection)
            sender.cancel()
            await self._let_go(who, "stopped: the page was closed")
        return connection

    async def say_goodbye(self, _: web.Application) -> None:
        """A page that is told goes at once; for one that is not the shutdown waits."""
        await asyncio.gather(*(page.close(code=WSCloseCode.GOING_AWAY) for page in self._connections))

    def close(self) -> None:
        """Wait for nothing."""
        self._safe.shutdown(wait=False)

    def _hear(self, who: str, queue: asyncio.Queue[str], text: str) -> None:
        try:
            message = json.loads(text)
        except ValueError:
            return
        if not isinstance(message, dict):
            return
        kind = message.get("t")
        if kind == "hold":
            self.bench.dead_man.tell(who)
        elif kind == "release":
            self._keep(self._let_go(who, ""))
        elif kind == "ask":
            self._keep(self._answer(who, queue, message))

    def _keep(self, work: Coroutine[None, None, None]) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _let_go(self, who: str, why: str) -> None:
        with contextlib.suppress(DriveError):  # the watch tries again
            await self._loop.run_in_executor(self._safe, self.bench.release, who, why)

    async def _answer(self, who: str, queue: asyncio.Queue[str], message: Message) -> None:
        what, number = message.get("what"), message.get("id")
        given = message.get("given")
        action = ACTIONS.get(what) if isinstance(what, str) else None
        reply: Message = {"t": "reply", "id": number}
        if action is None or not isinstance(given, dict):
            reply["error"] = "the page asks for something that this server does not know"
        else:
            try:
                pool = self._safe if what in SAFE else None
                reply["result"] = await self._loop.run_in_executor(pool, action, self.bench, who, given)
            except (DriveError, InputError) as error:
                reply["error"] = str(error)
        await queue.put(_text(reply))


async def _send(connection: web.WebSocketResponse, queue: asyncio.Queue[str]) -> None:
    with contextlib.suppress(ConnectionError):
        while not connection.closed:
            await connection.send_str(await queue.get())


def _text(message: Message) -> str:
    return json.dumps(message, allow_nan=False)
