"""Running the virtual board until somebody stops it."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Protocol

from rich.console import Console

from stillspin.board import eeprom_file
from stillspin.board.can_plug import CanPlug, SlcanPlug
from stillspin.board.desk import SLICE, Desk
from stillspin.board.pacer import Pacer
from stillspin.board.pseudo_terminal import DEFAULT_RATE, PseudoTerminal
from stillspin.board.show import Show
from stillspin.called import called
from stillspin.core_board import NativeBoard
from stillspin.errors import CampaignError, InputError
from stillspin.exit_codes import ExitCode
from stillspin.link.segments import DEFAULT_BITRATE

_PAUSE = 0.05  # s of wall time; the longest sleep
_LEAVE = 1.0  # s that the terminal has for the last line


class Debugger(Protocol):
    """What may hold the board's time."""

    @property
    def runs(self) -> bool:
        """Whether time may pass."""

    def poll(self, seconds: float) -> None:
        """Look whether anything is asked, and wait for that so long where time may not pass."""


@dataclass(frozen=True)
class Options:
    """How to run the board.

    `states`: of the drive, in words. `speed`: times real time, 0 as fast as possible. `load`: Nm. `socketcan`: an
    interface of the kernel in place of the SLCAN adapter. `end`: simulated seconds after which it stops. `eeprom`: the
    file that keeps the content of the EEPROM; a new memory without. `parent`: a process without which it stops.
    `remarks`: says of the board when it is switched off what a user has to know of the run.
    """

    states: Mapping[int, str]
    speed: float = 1.0
    link: Path | None = None
    can_link: Path | None = None
    socketcan: str | None = None
    load: float = 0.0
    end: float | None = None
    eeprom: Path | None = None
    parent: int | None = None
    debugger: Debugger | None = None
    remarks: Callable[[NativeBoard], list[str]] | None = None
    placed: Callable[[CampaignError, NativeBoard], CampaignError] | None = None
    """What an error is with where the program had come to."""


def serve(board: NativeBoard, options: Options, title: str) -> None:
    """Plug the board in, say how to connect, and run it until SIGINT, SIGTERM or its end.

    Raises:
        InputError: the link cannot be made, or an impossible load.
        CampaignError: the board cannot go on.
    """
    try:
        if options.eeprom:
            eeprom_file.insert(board, options.eeprom)
        board.set_load(options.load)
        desk = _plug_in(board, options)
    except ValueError as error:
        board.close()
        raise InputError(f"--load {options.load:g}: {error}") from error
    except InputError:
        board.close()
        raise
    try:
        _say_how_to_connect(desk, title)
        pacer = Pacer(options.speed)
        with stopped_by_signals() as stop, _show(desk, pacer, options) as show:
            began = time.monotonic()
            stop.parent = options.parent
            _loop(desk, pacer, show, stop, options)
            wall = time.monotonic() - began
        ran = desk.time
        remarks = options.remarks(board) if options.remarks else []
    except CampaignError as error:
        for words in options.remarks(board) if options.remarks else []:
            print(words)
        raise (options.placed(error, board) if options.placed else error) from None
    finally:
        if options.eeprom:
            eeprom_file.keep(board, options.eeprom)
        desk.close()
    left = f"switched off after {ran:.1f} s of the drive's time, {ran / wall:.2f} × real time"
    _take_leave("\n".join((*remarks, left)), show)


def _show(desk: Desk, pacer: Pacer, options: Options) -> Show:
    return Show(Console(stderr=True), desk, pacer, options.speed, options.states)


def _take_leave(words: str, show: Show) -> None:
    """Says them, and ends the process where the terminal takes nothing: all is kept, and Python would wait for it."""
    said = threading.Thread(target=print, args=(words,), kwargs={"flush": True}, daemon=True)
    said.start()
    said.join(_LEAVE)
    if said.is_alive() or show.is_stuck:
        os._exit(ExitCode.DONE)


def _plug_in(board: NativeBoard, options: Options) -> Desk:
    plug = _can_plug(board, options)
    try:
        return Desk(board, PseudoTerminal(options.link), plug)
    except InputError:
        plug.close()
        raise


def _can_plug(board: NativeBoard, options: Options) -> CanPlug:
    if not options.socketcan:
        return SlcanPlug(board, PseudoTerminal(options.can_link))
    from stillspin.board.socketcan_plug import SocketcanPlug  # noqa: PLC0415 - takes long to load, and not all need it

    return SocketcanPlug(board, options.socketcan)


@dataclass
class Stop:
    """Set by a signal, or true when the parent is no longer there."""

    asked: bool = False
    parent: int | None = None

    @property
    def wanted(self) -> bool:
        """Whether it is time to end."""
        return self.asked or self.parent not in {None, os.getppid()}


@contextmanager
def stopped_by_signals() -> Iterator[Stop]:
    """SIGINT and SIGTERM ask for an orderly end."""
    stop = Stop()

    def ask(_number: int, _frame: FrameType | None) -> None:
        stop.asked = True

    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _loop(desk: Desk, pacer: Pacer, show: Show, stop: Stop, options: Options) -> None:
    end, debugger = options.end, options.debugger
    while not stop.wanted and (end is None or desk.time < end):
        due = pacer.due(desk.time)
        if debugger:
            debugger.poll(_PAUSE)
        if debugger and not debugger.runs:
            pass  # its time stands
        elif pacer.free and desk.board.in_loop:
            desk.answer()
        elif due >= SLICE:
            desk.step(SLICE)
        else:
            time.sleep(min(pacer.wall(SLICE - due), _PAUSE))
        show.look()


def _say_how_to_connect(desk: Desk, title: str) -> None:
    name = desk.port.name
    device = f" ({desk.port.device})" if name != desk.port.device else ""
    print(f"virtual board: {title}")
    print(f"serial port:   {name}{device}, {DEFAULT_RATE} bit/s, 8 data bits, no parity, 1 stop bit")
    if desk.can:
        kind = "SLCAN adapter" if isinstance(desk.can, SlcanPlug) else "SocketCAN interface"
        print(f"CAN:           {desk.can.name}, {kind}; the drive is node 1 at {DEFAULT_BITRATE // 1000} kbit/s")
    print(f"connect:       {called()} console --drive {name}, or any terminal program")
    print("switch off:    Ctrl-C", flush=True)
