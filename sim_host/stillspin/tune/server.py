"""Serves the page and its live connection: on the loopback, unless asked for more."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

from aiohttp import web

from stillspin.drive import Drive
from stillspin.link.errors import DriveError
from stillspin.tune import book, files
from stillspin.tune.dead_man import PATIENCE
from stillspin.tune.guard import Guard
from stillspin.tune.listen import LOOPBACK, Outside, listening
from stillspin.tune.pages import Pages
from stillspin.tune.workbench import Workbench

_PAGE = Path(__file__).resolve().parent / "page"


class Server:
    """One drive's page. A context: serves in a thread of its own from entering to leaving."""

    def __init__(
        self,
        drive: Drive,
        port: int = 0,
        patience: float = PATIENCE,
        reopen: Callable[[], Drive] | None = None,
        outside: Outside | None = None,
    ) -> None:
        """Take a port; 0 is any that is free.

        Args:
            drive: that is open; who opened it closes it.
            port: TCP port.
            patience: s without a word from who holds the motor, until it is stopped.
            reopen: opens the drive again when the way to it was lost; without, it stays lost.
            outside: where other machines reach it; the loopback only, without.

        Raises:
            InputError: the port cannot be had.
        """
        self.guard = Guard(names=(outside.name,), scheme="https", token=outside.token) if outside else Guard()
        self._tls = outside.tls if outside else None
        self._loop = asyncio.new_event_loop()
        self._pages = Pages(self._loop)
        self.bench = self._pages.bench = Workbench(drive, self._pages.tell, patience, reopen)
        self._socket = listening(outside.host if outside else LOOPBACK, port)
        self.guard.port = self._socket.getsockname()[1]
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
        self._loop.run_until_complete(web.SockSite(runner, self._socket, ssl_context=self._tls).start())
        beat = self._loop.create_task(self._pages.beat())
        self._ready.set()
        try:
            self._loop.run_forever()
        finally:
            beat.cancel()
            self._loop.run_until_complete(runner.cleanup())
            self._loop.run_until_complete(_cancel_all())
            self._pages.close()
            self._loop.close()

    def _application(self) -> web.Application:
        application = web.Application(middlewares=[self.guard.middleware()])
        application.router.add_get("/", self._index)
        application.router.add_get("/live", self._pages.live)
        names = "{name:history\\.parquet|history\\.csv|parameters\\.toml}"
        application.router.add_get(f"/file/{names}", files.handler(self.bench))
        application.router.add_static("/page", _PAGE)
        book.add_to(application.router)
        application.on_shutdown.append(self._pages.say_goodbye)
        return application

    async def _index(self, _: web.Request) -> web.StreamResponse:
        return web.FileResponse(_PAGE / "index.html")


async def _cancel_all() -> None:
    """What still waits for a page that has gone."""
    waiting = asyncio.all_tasks() - {asyncio.current_task()}
    for task in waiting:
        task.cancel()
    await asyncio.gather(*waiting, return_exceptions=True)
