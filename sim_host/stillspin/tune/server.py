"""Serves the page and its live connection, on the loopback only."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import threading
import uuid
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import TracebackType

from aiohttp import WSCloseCode, WSMsgType, web

from stillspin.drive import Drive
from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.tune.actions import ACTIONS, SAFE, describe
from stillspin.tune.dead_man import PATIENCE
from stillspin.tune.guard import Guard
from stillspin.tune.workbench import Message, Workbench

_PAGE = Path(__file__).resolve().parent / "page"
_HOST = "127.0.0.1"
_LARGEST = 1 << 16
_BEAT = 5.0
_FAREWELL = 1.0
"""Seconds for a page to answer that the connection ends."""
_BACKLOG = 400
"""Messages that may wait for a page that does not fetch them."""


class Server:
    """One drive's page. A context: serves in a thread of its own from entering to leaving."""

    def __init__(self, drive: Drive, port: int = 0, patience: float = PATIENCE) -> None:
        """Take a port; 0 is any that is free.

        Raises:
            InputError: the port cannot be had.
        """
        self.guard = Guard()
        self.bench = Workbench(drive, self._tell, patience)
        self._socket = _listen(port)
        self.guard.port = self._socket.getsockname()[1]
        self._pages: dict[str, asyncio.Queue[str]] = {}
        self._connections: set[web.WebSocketResponse] = set()
        self._tasks: set[asyncio.Task[None]] = set()
        self._loop = asyncio.new_event_loop()
        # What stops the motor has threads of its own: others may wait for the drive for long.
        self._safe = ThreadPoolExecutor(4, "stillspin stop")
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="stillspin tune", daemon=True)

    @property
    def address(self) -> str:
        """What to open in a browser, with the token of this start."""
        return self.guard.address

    def __enter__(self) -> Server:
        self._thread.start()
        self._ready.wait()
        self.bench.begin()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        with contextlib.suppress(DriveError):
            self.bench.close()
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5.0)

    def _serve(self) -> None:
        asyncio.set_event_loop(self._loop)
        runner = web.AppRunner(self._application(), access_log=None, shutdown_timeout=1.0)
        self._loop.run_until_complete(runner.setup())
        self._loop.run_until_complete(web.SockSite(runner, self._socket).start())
        self._ready.set()
        try:
            self._loop.run_forever()
        finally:
            self._loop.run_until_complete(runner.cleanup())
            self._loop.run_until_complete(_cancel_all())
            self._safe.shutdown(wait=False)
            self._loop.close()

    def _application(self) -> web.Application:
        application = web.Application(middlewares=[self.guard.middleware()])
        application.router.add_get("/", self._index)
        application.router.add_get("/live", self._live)
        application.router.add_static("/page", _PAGE)
        application.on_shutdown.append(self._say_goodbye)
        return application

    async def _say_goodbye(self, _: web.Application) -> None:
        """A page that is told goes at once; for one that is not the shutdown waits."""
        await asyncio.gather(*(page.close(code=WSCloseCode.GOING_AWAY) for page in self._connections))

    async def _index(self, _: web.Request) -> web.StreamResponse:
        return web.FileResponse(_PAGE / "index.html")

    async def _live(self, request: web.Request) -> web.StreamResponse:
        """One page: what it says goes to the workbench, what the drive says goes to it."""
        connection = web.WebSocketResponse(heartbeat=_BEAT, max_msg_size=_LARGEST, timeout=_FAREWELL)
        await connection.prepare(request)
        self._connections.add(connection)
        who = uuid.uuid4().hex
        queue: asyncio.Queue[str] = asyncio.Queue(_BACKLOG)
        sender = asyncio.create_task(_send(connection, queue))
        try:
            await queue.put(_text(await asyncio.to_thread(describe, self.bench)))
            self._pages[who] = queue
            async for message in connection:
                if message.type == WSMsgType.TEXT:
                    self._hear(who, queue, message.data)
        except DriveError as error:
            await connection.send_str(_text({"t": "lost", "text": str(error)}))
        finally:
            self._pages.pop(who, None)
            self._connections.discard(connection)
            sender.cancel()
            await self._let_go(who, "stopped: the page was closed")
        return connection

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

    def _tell(self, message: Message) -> None:
        """To all pages, from any thread."""
        text = _text(message)

        def deliver() -> None:
            for queue in self._pages.values():
                if not queue.full():
                    queue.put_nowait(text)

        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(deliver)


async def _cancel_all() -> None:
    """What still waits for a page that has gone."""
    waiting = asyncio.all_tasks() - {asyncio.current_task()}
    for task in waiting:
        task.cancel()
    await asyncio.gather(*waiting, return_exceptions=True)


async def _send(connection: web.WebSocketResponse, queue: asyncio.Queue[str]) -> None:
    with contextlib.suppress(ConnectionError):
        while not connection.closed:
            await connection.send_str(await queue.get())


def _text(message: Message) -> str:
    return json.dumps(message, allow_nan=False)


def _listen(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((_HOST, port))
        listening.listen(16)
    except OSError as error:
        listening.close()
        raise InputError(f"--port {port}: cannot be had ({error.strerror})") from error
    return listening
