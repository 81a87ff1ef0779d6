"""`stillspin tune`: the page in the browser."""

from __future__ import annotations

import contextlib
import threading
import webbrowser
import zlib
from functools import partial
from typing import Annotated

import typer

from stillspin.commands.connection import DriveOption, opened
from stillspin.drive import Drive
from stillspin.errors import InputError
from stillspin.options import whole
from stillspin.tune.server import Server

_OWN = range(49152, 65536)
"""Ports that anybody may use."""


def tune(
    *,
    where: DriveOption = "",
    port: Annotated[
        int,
        typer.Option(
            "--port",
            parser=whole("--port", 0, 65535),
            metavar="N",
            help="Port on the loopback; 0: the drive's own, or any that is free.",
        ),
    ] = 0,
    browser: Annotated[bool, typer.Option("--open/--no-open", help="Open it in the browser.")] = True,
) -> None:
    """Serve the page for this drive, to this computer only, until Ctrl-C."""
    with opened(where) as drive, _server(drive, where, port) as server:
        print(f"{drive.version} on {drive.link.transport.name}")
        print(f"page: {server.address}", flush=True)
        print("Whoever has this address can run the motor. Ctrl-C ends the server and stops the motor.", flush=True)
        if browser:
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            print("stopped")


def _server(drive: Drive, where: str, port: int) -> Server:
    """On the port that this drive had the last time, so that a page which is still open finds it again."""
    reopen = partial(Drive.open, where)
    if not port:
        with contextlib.suppress(InputError):
            return Server(drive, _OWN[zlib.crc32(where.encode()) % len(_OWN)], reopen=reopen)
    return Server(drive, port, reopen=reopen)
