"""Files that the page gives and takes: the history of the session, the drive's parameters."""

from __future__ import annotations

import asyncio
import tempfile
from pathlib import Path
from typing import Any

from aiohttp import web

from stillspin.drive import parameter_file
from stillspin.errors import InputError
from stillspin.link.errors import DriveError
from stillspin.tune.workbench import Workbench

_TYPES = {"parquet": "application/vnd.apache.parquet", "csv": "text/csv", "toml": "application/toml"}


def handler(bench: Workbench) -> Any:
    """Answers a request for one of the files."""

    async def give(request: web.Request) -> web.Response:
        name = request.match_info["name"]
        try:
            content = await asyncio.to_thread(_content, bench, name)
        except (DriveError, InputError) as error:
            return web.Response(status=409, text=f"{error}\n")
        headers = {"Content-Disposition": f'attachment; filename="{name}"'}
        return web.Response(body=content, content_type=_TYPES[name.rpartition(".")[2]], headers=headers)

    return give


def _content(bench: Workbench, name: str) -> bytes:
    if name == "parameters.toml":
        about = [f"Parameters of a drive with firmware {bench.drive.identity.text}."]
        return parameter_file.text(bench.drive.parameters(), bench.drive.table, about).encode()
    return bench.streamer.history.file(name.rpartition(".")[2], bench.drive.identity.text)


def load(bench: Workbench, name: str, text: str) -> dict[str, Any]:
    """Put the values of a parameter file into the drive; all are checked before the first is sent.

    Raises:
        InputError: it is no such file, or has a value that the drive's table does not allow.
    """
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / (Path(name).name or "file")
        path.write_text(text, encoding="utf-8")
        try:
            wanted = parameter_file.read(path, bench.drive.table, bench.drive.parameters())
        except InputError as error:
            raise InputError(str(error).replace(f"{directory}/", "")) from None
    bench.drive.set_scales(wanted)
    rows = parameter_file.differences(bench.drive.parameters(), wanted, bench.drive.table, wanted)
    complaints = parameter_file.put(bench.drive, rows)
    values = bench.drive.parameters()
    bench.streamer.learn(values)
    return {"values": values, "named": len(wanted), "different": len(rows), "complaints": complaints}
