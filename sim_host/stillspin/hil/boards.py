"""Virtual boards for the loop alone: a process each, whose port and bus are as fast as those of a real board can be."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Self

from stillspin.drive import Drive
from stillspin.errors import CampaignError
from stillspin.image.opened import WARNING
from stillspin.link.errors import DriveError
from stillspin.link.serial_port import DEFAULT_BAUD

BAUD = 390_625
"""bit/s; the drive's divider makes it exactly, that of an FT232 within 0.8 %."""
BITRATE = 1_000_000
KINDS = "serial", "can"

_PATIENCE = 300.0  # s; a machine with much else to do takes long to start a process
_POLL = 0.05


def memory() -> bytes:
    """The content of the memory of a board that has been told its rates: it takes the port's at its next start.

    Raises:
        CampaignError: a board does not start.
    """
    try:
        with (
            Board(None) as board,
            Drive.open(board.wait("serial", DEFAULT_BAUD), timeout=5.0) as drive,
        ):
            drive.set("baud_rate", BAUD)
            drive.set("can_rate", BITRATE // 1000)
            drive.save()
    except DriveError as error:
        raise CampaignError(f"a virtual board cannot be set up: {error}") from error
    return board.memory


class Board:
    """One process, from entering to leaving; `memory` is what is in its memory after that."""

    def __init__(self, memory: bytes | None, image: Path | None = None, rom: Path | None = None) -> None:
        """With the firmware that is compiled for this computer, or executing an image, with a boot ROM if given."""
        self.memory = memory or b""
        self._image = ["--image", str(image)] if image else []
        self._image += ["--rom", str(rom)] if rom else []

    def __enter__(self) -> Self:
        """Switch it on."""
        # No TemporaryDirectory: when this process ends, that one goes before the boards that are kept until then.
        self._directory = directory = Path(tempfile.mkdtemp(prefix="stillspin-hil-"))
        self._eeprom = directory / "memory"
        if self.memory:
            self._eeprom.write_bytes(self.memory)
        self._serial, self._can = directory / "serial", directory / "can"
        self._log = directory / "log"
        plugs = ["--serial-link", str(self._serial), "--can-link", str(self._can), "--eeprom", str(self._eeprom)]
        with self._log.open("w") as log:
            # Should this process end before it knows of that one, that one ends by itself.
            guard = ["--parent", str(os.getpid())]
            self._process = subprocess.Popen(
                _command("--speed", "0", *self._image, *guard, *plugs), stdout=log, stderr=log
            )
        return self

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

    def __exit__(self, *_: object) -> None:
        """Switch it off, and say what it has to say of its run."""
        self._process.terminate()
        self._process.wait(_PATIENCE)
        for line in self._log.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith(WARNING):
                print(line)
        self.memory = self._eeprom.read_bytes() if self._eeprom.exists() else b""
        shutil.rmtree(self._directory, ignore_errors=True)


def _command(*options: str) -> Sequence[str]:
    return sys.executable, "-m", "stillspin", "board", *options
