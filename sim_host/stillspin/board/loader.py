"""A virtual board in serial boot as a process: its port is a pseudo-terminal, its flash a file."""

from __future__ import annotations

import struct
import time
from pathlib import Path
from typing import cast

from stillspin import core
from stillspin.board.desk import SLICE, Desk
from stillspin.board.pacer import Pacer
from stillspin.board.proving_port import ProvingPort
from stillspin.board.serve import stopped_by_signals
from stillspin.called import called
from stillspin.core_board import NativeBoard
from stillspin.core_loader import NativeLoader
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.flash import layout
from stillspin.flash.program import Program

_PAUSE = 0.02
_WORDS = len(layout.FLASH)
_FILE = struct.Struct(f"<{_WORDS}H")
_STAND_IN_ENTRY = (0x007F, 0x4000)
"""A new board has been programmed over JTAG: a branch to the start of sector A."""

_IN_WORDS = {"waiting": "its boot code, which waits for an image; no drive", "drive": "the drive"}


def _new_flash() -> list[int]:
    words = [layout.ERASED] * _WORDS
    at = layout.BOOT_ENTRY - layout.FLASH.start
    words[at : at + len(_STAND_IN_ENTRY)] = _STAND_IN_ENTRY
    return words


def _read(file: Path) -> list[int]:
    if not file.exists():
        return _new_flash()
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror})") from error
    if len(content) != _FILE.size:
        raise InputError(f"{file}: has {counted(len(content), 'octet')}, must have {_FILE.size}")
    return list(_FILE.unpack(content))


def serve(file: Path, kernel: Program, link: Path | None, speed: float) -> None:
    """Wait in serial boot for somebody at the port, until SIGINT or SIGTERM; the flash goes back to its file.

    Raises:
        InputError: the file or the link cannot be.
    """
    words = _read(file)
    blocks = [(block.address, list(block.words)) for block in kernel.blocks]
    board: NativeLoader = core.load().LoaderBoard(entry=kernel.entry or 0, blocks=blocks)
    try:
        board.flash = words
        board.set_serial_boot(True)
        board.power_cycle()
        # The desk asks nothing else of a board than what this one has, too.
        desk = Desk(cast(NativeBoard, board), ProvingPort(link))
    except InputError:
        board.close()
        raise
    print(f"virtual board: serial boot, flash {file}")
    print(f"serial port:   {desk.port.name}")
    print(f"try:           {called()} flash IMAGE --port {desk.port.name}", flush=True)
    try:
        pacer = Pacer(speed)
        with stopped_by_signals() as stop:
            while not stop.wanted:
                due = pacer.due(desk.time)
                if due >= SLICE:
                    desk.step(SLICE)
                else:
                    time.sleep(min(pacer.wall(SLICE - due), _PAUSE))
        board.set_serial_boot(False)
        file.write_bytes(_FILE.pack(*board.flash))
        board.power_cycle()
        board.advance(round(SLICE / 1e-8))
        print(f"switched off; in flash boot the chip runs: {_IN_WORDS.get(board.running, board.running)}")
    finally:
        desk.close()
