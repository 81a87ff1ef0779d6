"""Virtual boards for the loop alone: a process each, whose port and bus are as fast as those of a real board can be."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Self

from stillspin.drive import Drive
from stillspin.errors import CampaignError
from stillspin.link.errors import DriveError
from stillspin.link.serial_port import DEFAULT_BAUD

BAUD = 390_625
"""bit/s; the drive's divider makes it exactly, that of an FT232 within 0.8 %."""
BITRATE = 1_000_000
KINDS = "serial", "can"

_PATIENCE = 300.0  # s; a machine with much else to do takes long to start a process
_POLL = 0.05


@contextmanager
def boards(kind: str, count: int) -> Iterator[list[str]]:
    """Addresses of so many boards, which run until the context ends.

    Args:
        kind: serial or can, the way to them.
        count: how many.

    Raises:
        CampaignError: one of them does not start.
    """
    with tempfile.TemporaryDirectory(prefix="stillspin-hil-") as directory, ExitStack() as started:
        root = Path(directory)
        memory = _memory(root)
        running = [started.enter_context(_Board(root / str(number), memory)) for number in range(count)]
        yield [board.wait(kind) for board in running]


def _memory(root: Path) -> Path:
    """The content of the memory of a board that has been told its rates: it takes the port's at its next start."""
    try:
        with (
            _Board(root / "first", None) as board,
            Drive.open(board.wait("serial", DEFAULT_BAUD), timeout=5.0) as drive,
        ):
            drive.set("baud_rate", BAUD)
            drive.set("can_rate", BITRATE // 1000)
            drive.save()
    except DriveError as error:
        raise CampaignError(f"a virtual board cannot be set up: {error}") from error
    return board.memory


class _Board:
    """One process."""

    def __init__(self, directory: Path, memory: Path | None) -> None:
        directory.mkdir()
        self.memory = directory / "memory"
        if memory:
            shutil.copyfile(memory, self.memory)
        self._serial, self._can = directory / "serial", directory / "can"
        self._log = directory / "log"
        plugs = ["--serial-link", str(self._serial), "--can-link", str(self._can), "--eeprom", str(self.memory)]
        with self._log.open("w") as log:
            # Should this process end before it knows of that one, that one ends by itself.
            guard = ["--parent", str(os.getpid())]
            self._process = subprocess.Popen(_command("--speed", "0", *guard, *plugs), stdout=log, stderr=log)

    def wait(self, kind: str, baud: int = BAUD) -> str:
        """Its address, as soon as it has one.

        Raises:
            CampaignError: it has ended.
        """
        end = time.monotonic() + _PATIENCE
        while not (self._serial.exists() and self._can.exists()):
            if self._process.poll() is not None or time.monotonic() > end:
                raise CampaignError(f"a virtual board does not start: {self._log.read_text().strip()}")
            time.sleep(_POLL)
        if kind == "serial":
            return f"serial://{self._serial}?baud={baud}"
        return f"can:slcan:{self._can}?bitrate={BITRATE}"

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Switch it off; returns when its memory is a file."""
        self._process.terminate()
        self._process.wait(_PATIENCE)


def _command(*options: str) -> Sequence[str]:
    return sys.executable, "-m", "stillspin", "board", *options
