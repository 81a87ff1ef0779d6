"""Reads the table from a drive, and keeps it on disk by its CRC so that the next time takes no second."""

from __future__ import annotations

import contextlib
import json
import os
import struct
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from stillspin import whole_file
from stillspin.counted import counted
from stillspin.drive.protocol import VERSION, Request, StatusCode, Words
from stillspin.drive.table import Parameter, Signal, Table
from stillspin.errors import InputError
from stillspin.link.errors import DifferentError, RefusedError

Ask = Callable[[Request, bytes], bytes]
_ALWAYS = 1
_Q, _NEEDS = 0x3F, 6
_FORMAT = 2
_BOOT = 10.0
_BUILD = struct.calcsize("<IH")
_AGAIN = 0.1


@dataclass(frozen=True)
class Identity:
    """What a drive says of itself."""

    parameters: int
    signals: int
    faults: int
    crc: int
    version: str
    board: str = ""
    """The board file that it was built for (hal/boards/)."""
    commit: int = 0
    """First 32 bits of the commit that its image was built from; 0 where that is not known."""
    changed: bool = False
    """Whether there were changes beside the commit."""
    edition: str = ""
    """What is in it (firmware/editions/); empty where it does not say."""

    @property
    def build(self) -> str:
        """Commit in words."""
        return f"commit {self.commit:08x}{', changed' if self.changed else ''}" if self.commit else "unknown commit"

    @property
    def text(self) -> str:
        """All of it, for people and for the heads of files."""
        return self.built(self.build)

    def built(self, how: str) -> str:
        """`text` with other words for its commit, where those know more."""
        made = f"edition {self.edition or 'unknown'}, board {self.board or 'unknown'}, {how}"
        return f"{self.version} ({made}, table {self.crc:08x})"


def identity(ask: Ask) -> Identity:
    """Who is there. A drive that has just been switched on is still reckoning the CRC of its table.

    Raises:
        DriveError: it speaks another version of the protocol.
    """
    end = time.monotonic() + _BOOT
    while True:
        try:
            body = ask(Request.IDENTITY, b"")
            break
        except RefusedError as error:
            if error.status != StatusCode.BUSY or time.monotonic() > end:
                raise
            time.sleep(_AGAIN)
    head = unpack("<HHHHI", body)
    protocol, parameters, signals, faults, crc = head
    if protocol != VERSION:
        raise DifferentError(
            f"the drive speaks version {protocol} of the protocol, this client version {VERSION}: "
            "install the client that belongs to the firmware"
        )
    version, _, more = body[struct.calcsize("<HHHHI") :].partition(b"\0")
    board, _, build = more.partition(b"\0")
    commit, changed = unpack("<IH", build) if build else (0, 0)
    name, file, edition = (octets.decode("ascii", "replace") for octets in (version, board, build[_BUILD:]))
    return Identity(parameters, signals, faults, crc, name, file, commit, bool(changed), edition)


def table(ask: Ask, who: Identity, progress: Callable[[float], None] | None = None, *, remembers: bool = True) -> Table:
    """The drive's table, from the disk when it has been read before.

    Args:
        ask: asks the drive.
        who: what it said of itself.
        progress: called with the share read.
        remembers: whether the disk is used; without, the drive is always asked the same.
    """
    known = _load(who) if remembers else None
    if known:
        return replace(known, edition=who.edition)
    total = who.parameters + who.signals
    parameters, signals = [], []
    for index in range(total):
        if index < who.parameters:
            parameters.append(_parameter(index, ask(Request.PARAMETER_INFO, struct.pack("<H", index))))
        else:
            number = index - who.parameters
            try:
                signals.append(_signal(number, ask(Request.SIGNAL_INFO, struct.pack("<H", number))))
            except RefusedError as error:
                if error.status != StatusCode.EDITION:
                    raise
        if progress:
            progress((index + 1) / total)
    found = Table(who.version, who.crc, who.faults, tuple(parameters), tuple(signals))
    if remembers:
        _save(found)
    return replace(found, edition=who.edition)


def faults(ask: Ask, who: Identity) -> list[int]:
    """Numbers of the faults that the drive's edition has."""
    return [code for code in range(who.faults) if has(ask, Words.FAULT, code)]


_PARTS = {
    Words.SCOPE: "scope",
    Words.COMMISSIONING: "commissioning",
    Words.STORE: "store",
    Words.CAN: "CAN bus",
    Words.LOOK: "look",
}
"""Parts of the firmware that have words of their own."""


def left_out(ask: Ask) -> list[str]:
    """Parts that the drive's edition has not, for people."""
    return [part for kind, part in _PARTS.items() if not has(ask, kind)]


def has(ask: Ask, kind: Words, code: int = 0) -> bool:
    """Whether the drive's edition has a word of this kind, as far as it says."""
    try:
        ask(Request.WORDS, struct.pack("<BB", kind, code))
    except RefusedError as error:
        return error.status != StatusCode.EDITION
    return True


def unpack(form: str, body: bytes) -> tuple[Any, ...]:
    """The numbers at the beginning of an answer.

    Raises:
        DriveError: it is too short.
    """
    if len(body) < struct.calcsize(form):
        raise DifferentError(
            f"an answer of {counted(len(body), 'octet')} is too short: install the client that belongs to the firmware"
        )
    return struct.unpack_from(form, body)


def _words(octets: bytes, count: int) -> list[str]:
    words = octets.decode("ascii", "replace").rstrip("\0").split("\0")
    return (words + [""] * count)[:count]


def _parameter(index: int, body: bytes) -> Parameter:
    form = "<HBBBBiii"
    number, q, decimals, access, flags, minimum, maximum, initial = unpack(form, body)
    name, unit, meaning = _words(body[struct.calcsize(form) :], 3)
    always = access == _ALWAYS
    return Parameter(index, number, name, unit, q, decimals, always, flags, minimum, maximum, initial, meaning)


def _signal(index: int, body: bytes) -> Signal:
    (form,) = unpack("<B", body)
    name, unit, meaning = _words(body[1:], 3)
    return Signal(index, name, unit, form & _Q, (1 << (form >> _NEEDS)) >> 1, meaning)


def _file(crc: int) -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "stillspin" / f"table-{crc:08x}.json"


def _load(who: Identity) -> Table | None:
    try:
        data = json.loads(_file(who.crc).read_text(encoding="utf-8"))
        if data.pop("format") != _FORMAT:
            return None
        parameters = tuple(Parameter(**entry) for entry in data["parameters"])
        signals = tuple(Signal(**entry) for entry in data["signals"])
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return None
    # An edition may leave signals out.
    if len(parameters) != who.parameters or len(signals) > who.signals:
        return None
    return Table(who.version, who.crc, who.faults, parameters, signals)


def _save(found: Table) -> None:
    """A table that cannot be kept is read again the next time."""
    path = _file(found.crc)
    data = {"format": _FORMAT, "version": found.version}
    data |= {"parameters": [asdict(entry) for entry in found.parameters]}
    data |= {"signals": [asdict(entry) for entry in found.signals]}
    with contextlib.suppress(OSError, InputError):
        path.parent.mkdir(parents=True, exist_ok=True)
        whole_file.write(path, json.dumps(data))
