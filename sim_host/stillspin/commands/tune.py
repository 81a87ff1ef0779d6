"""`stillspin tune`: the page in the browser."""

from __future__ import annotations

import threading
import webbrowser
from typing import Annotated

import typer

from stillspin.commands.connection import DriveOption, opened
from stillspin.errors import InputError
from stillspin.tune.server import Server

_POLL = 0.5
_PORTS = range(65536)


def tune(
    *,
    where: DriveOption = "",
    port: Annotated[int, typer.Option("--port", help="Port on the loopback; 0 takes any that is free.")] = 0,
    browser: Annotated[bool, typer.Option("--open/--no-open", help="Open it in the browser.")] = True,
) -> None:
    """Serve the page for this drive, to this computer only, until Ctrl-C."""
    if port not in _PORTS:
        raise InputError(f"--port {port}: must be 0 … {_PORTS[-1]}")
    with opened(where) as drive, Server(drive, port) as server:
        print(f"{drive.version} on {drive.link.transport.name}")
        print(f"page: {server.address}", flush=True)
        print("Whoever has this address can run the motor. Ctrl-C ends the server and stops the motor.", flush=True)
        if browser:
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        try:
            while not drive.link.lost:
                threading.Event().wait(_POLL)
        except KeyboardInterrupt:
            print("stopped")
        if drive.link.lost:
            raise drive.link.lost
