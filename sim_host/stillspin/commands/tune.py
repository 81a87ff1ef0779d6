"""`stillspin tune`: the page in the browser."""

from __future__ import annotations

import contextlib
import threading
import webbrowser
import zlib
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stillspin.commands.connection import DriveOption, opened, say_unsaved
from stillspin.drive import Drive
from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.options import whole
from stillspin.tune.listen import Outside, outside

if TYPE_CHECKING:
    from stillspin.tune.server import Server

_OWN = range(61000, 65536)
"""Ports that anybody may use, and that Linux hands to no client that happens to ask before this server does."""


def tune(
    *,
    where: DriveOption = "",
    port: Annotated[
        int,
        typer.Option(
            "--port",
            parser=whole("--port", 0, 65535),
            metavar="N",
            help="TCP port; 0: the drive's own, or any that is free.",
        ),
    ] = 0,
    listen: Annotated[
        str,
        typer.Option("--listen", metavar="ADDRESS", help="Serve other machines, too; needs the three files below."),
    ] = "",
    certificate: Annotated[Path | None, typer.Option("--certificate", help="TLS certificate, PEM.")] = None,
    key: Annotated[Path | None, typer.Option("--key", help="Its key, PEM.")] = None,
    token_file: Annotated[
        Path | None, typer.Option("--token-file", help="File with the token that opens the page.")
    ] = None,
    browser: Annotated[bool, typer.Option("--open/--no-open", help="Open it in the browser.")] = True,
) -> None:
    """Serve the page for this drive until Ctrl-C: to this computer only, unless --listen names an interface."""
    beyond = outside(listen, certificate, key, token_file)
    with opened(where) as drive, _server(drive, where, port, beyond) as server:
        print(f"{drive.version} on {drive.link.transport.name}")
        print(f"page: {server.address}", flush=True)
        print("Whoever has this address can run the motor. Ctrl-C ends the server and stops the motor.", flush=True)
        if browser:
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            print("stopped")
            with contextlib.suppress(DriveError):  # it is away
                say_unsaved(server.bench.drive)


def _server(drive: Drive, where: str, port: int, beyond: Outside | None) -> Server:
    """On the port that this drive had the last time, so that a page which is still open finds it again."""
    from stillspin.tune.server import Server  # noqa: PLC0415 - takes long to load, and not all need it

    reopen = partial(Drive.open, where)
    if not port:
        with contextlib.suppress(InputError):
            return Server(drive, _OWN[zlib.crc32(where.encode()) % len(_OWN)], reopen=reopen, outside=beyond)
    return Server(drive, port, reopen=reopen, outside=beyond)
