"""What the virtual board says on the terminal: how to connect, one line of status, and warnings."""

from __future__ import annotations

import time
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.text import Text

from stillspin.board.desk import Desk
from stillspin.board.pacer import Pacer
from stillspin.drive import state

_EVERY = 0.25  # s between two looks of the status line
_AGAIN = 30.0  # s after which a warning is repeated

_STATES = {
    state.BOOT: "boot",
    state.CALIBRATE: "calibrating",
    state.READY: "ready",
    state.START: "starting",
    state.RUN: "running",
    state.STOP: "stopping",
    state.FAULT: "FAULT",
    state.COMMISSION: "commissioning",
}


class Show:
    """Draws the status line where somebody looks, prints warnings anywhere."""

    def __init__(self, console: Console, desk: Desk, pacer: Pacer, speed: float) -> None:
        self._console = console
        self._desk = desk
        self._pacer = pacer
        self._speed = speed
        self._live = Live(console=console, auto_refresh=False, transient=True) if console.is_terminal else None
        self._next = 0.0
        self._warned: dict[str, float] = {}

    def __enter__(self) -> Self:
        if self._live:
            self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live:
            self._live.stop()

    def look(self) -> None:
        """Renew the line and look for something to warn of, a few times a second."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _EVERY
        if self._pacer.late:
            self._warn("late", now, f"this machine does not keep up: {self._ratio()} instead of {self._speed:g} ×")
        rates = self._desk.wrong_rate
        if rates:
            self._warn("rate", now, f"the terminal is set to {rates[0]} bit/s and the drive to {rates[1]}")
        if self._desk.port.dropped:
            words = f"{self._desk.port.dropped} octets were not fetched by the program that has the port open"
            self._warn("dropped", now, words)
        if self._live:
            self._live.update(Text(self.line()), refresh=True)

    def line(self) -> str:
        """Time, speed, state of the drive, shaft, port."""
        desk = self._desk
        signals, truth = desk.board.signals(), desk.board.truth()
        words = _STATES.get(int(signals["state"]), "?")
        port = f"open at {desk.port.rate} bit/s" if desk.port.is_open else "not open"
        return (
            f"{desk.time:9.1f} s  {self._ratio()}  {words}  {truth['speed']:7.1f} rpm  {truth['load_torque']:.2f} Nm  "
            f"port {port}, {desk.octets_in} octets in, {desk.octets_out} out"
        )

    def _ratio(self) -> str:
        ratio = self._pacer.ratio
        return "–" if ratio is None else f"{ratio:.2f} × real time"

    def _warn(self, kind: str, now: float, words: str) -> None:
        if now - self._warned.get(kind, -_AGAIN) < _AGAIN:
            return
        self._warned[kind] = now
        self._console.print(f"stillspin: {words}", style="yellow", highlight=False, soft_wrap=True)
