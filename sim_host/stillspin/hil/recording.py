"""Runs in the loop as a file: what a board was asked, and what it answered, for computers without the virtual drive.

A recording is compressed by gzip. Behind its first line comes run after run: a line of JSON (`Heading`), then requests
and answers by turns, two octets of length and as many octets each, and an empty request at the end.
"""

from __future__ import annotations

import errno
import gzip
import json
import os
import struct
import sys
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

from stillspin.counted import counted
from stillspin.errors import InputError

Pair = tuple[bytes, bytes]
"""A request and its answer, kind and status in front."""
_FIRST = b"stillspin recording 1\n"
_LENGTH = struct.Struct("<H")


@dataclass(frozen=True)
class Heading:
    """Of which run, and of which drive.

    Attributes:
        scenario, run, profile, whole, revision: as in the row of its results.
        version, edition, board, crc: of the drive that answered.
    """

    scenario: str
    run: str
    profile: str
    whole: bool
    revision: str
    version: str
    edition: str
    board: str
    crc: int


class RecordingWriter:
    """Takes what is said in a run, and keeps it when the run was good.

    It writes beside the file that is meant, which gets its new content when every run is there.
    """

    def __init__(self, file: Path, runs: int) -> None:
        """Begin a recording of so many runs.

        Raises:
            InputError: it cannot be written.
        """
        self._name, self._runs = file, runs
        self._kept = 0
        self._said: list[Pair] = []
        with self._telling():
            if file.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
            self._raw = tempfile.NamedTemporaryFile("wb", dir=file.absolute().parent, delete=False)  # noqa: SIM115
        self._out = gzip.GzipFile("", "wb", fileobj=self._raw, mtime=0)  # the same runs are the same octets
        self._out.write(_FIRST)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """The recording has its name; where runs are missing, one of its own, and no name where there are none."""
        beside, is_whole = Path(self._raw.name), self._kept == self._runs
        name = self._name if is_whole else self._name.with_name(f"{self._name.name}.part")
        try:
            with self._telling(), self._raw:
                self._out.close()
            if self._kept:
                with self._telling():
                    beside.chmod(0o644)
                    beside.replace(name)
        finally:
            beside.unlink(missing_ok=True)
        if not self._kept or not is_whole:
            there = f", in {name}" if self._kept else ""
            words = f"{self._kept} of {counted(self._runs, 'run')} can be kept{there}"
            print(f"--record {self._name}: not written; {words}", file=sys.stderr)

    def begin(self) -> None:
        """A run; what was said in one that was not kept is forgotten."""
        self._said.clear()

    def note(self, request: bytes, answer: bytes) -> None:
        """What was said."""
        self._said.append((request, answer))

    def keep(self, heading: Heading) -> None:
        """The run belongs into the recording.

        Raises:
            InputError: it cannot be written.
        """
        with self._telling():
            self._out.write(json.dumps(asdict(heading)).encode() + b"\n")
            for pair in self._said:
                for octets in pair:
                    self._out.write(_LENGTH.pack(len(octets)) + octets)
            self._out.write(_LENGTH.pack(0))
        self._kept += 1

    @contextmanager
    def _telling(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise InputError(f"--record {self._name}: cannot be written ({error.strerror})") from error


def recorded(file: Path) -> Iterator[tuple[Heading, list[Pair]]]:
    """The runs of a recording.

    Raises:
        InputError: it cannot be read, or is none.
    """
    try:
        with gzip.open(file, "rb") as recording:
            if recording.readline(len(_FIRST)) != _FIRST:
                raise ValueError
            while line := recording.readline():
                yield Heading(**json.loads(line)), list(_pairs(recording))
    except (EOFError, ValueError, TypeError, zlib.error, gzip.BadGzipFile) as error:
        raise InputError(
            f"--play {file}: is no whole recording; `stillspin hil ID --port virtual --record FILE` makes one"
        ) from error
    except OSError as error:
        raise InputError(f"--play {file}: cannot be read ({error.strerror})") from error


def _pairs(recording: gzip.GzipFile) -> Iterator[Pair]:
    while request := _octets(recording):
        yield request, _octets(recording)


def _octets(recording: gzip.GzipFile) -> bytes:
    length = recording.read(_LENGTH.size)
    if len(length) < _LENGTH.size:
        raise EOFError
    count = _LENGTH.unpack(length)[0]
    octets = recording.read(count)
    if len(octets) < count:
        raise EOFError
    return octets
