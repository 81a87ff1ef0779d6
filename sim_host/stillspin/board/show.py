"""What the virtual board says on the terminal while it runs: one line of status, and warnings."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Mapping
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.live import Live
from rich.text import Text

from stillspin.board.desk import Desk
from stillspin.board.pacer import Pacer
from stillspin.counted import counted

_EVERY = 0.25  # s between two looks of the status line
_AGAIN = 30.0  # s after which a warning is repeated
_WAITING = 8  # texts that wait for the terminal; what comes on top of them is not shown
_LAST = 1.0  # s that the last words may take at the end


class Show:
    """Draws the status line where somebody looks, prints warnings anywhere.

    A thread of its own does it: a terminal that takes nothing (Ctrl-S, a selection, a suspended window) must not stop
    the drive's time.
    """

    def __init__(self, console: Console, desk: Desk, pacer: Pacer, speed: float, states: Mapping[int, str]) -> None:
        self._console = console
        self._states = states
        self._desk = desk
        self._pacer = pacer
        self._speed = speed
        self._live = Live(console=console, auto_refresh=False, transient=True) if console.is_terminal else None
        self._next = 0.0
        self._warned: dict[str, float] = {}
        self._texts: queue.Queue[Text | None] = queue.Queue(_WAITING)
        self._draws = threading.Thread(target=self._draw, name="stillspin status line", daemon=True)

    def __enter__(self) -> Self:
        self._draws.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """The last words are waited for, but not for a terminal that takes nothing."""
        end = time.monotonic() + _LAST
        try:
            self._texts.put(None, timeout=_LAST)
        except queue.Full:
            return
        self._draws.join(max(0.0, end - time.monotonic()))

    @property
    def is_stuck(self) -> bool:
        """Whether the terminal has not taken the last words."""
        return self._draws.is_alive()

    def _draw(self) -> None:
        if self._live:
            self._live.start()
        while (text := self._texts.get()) is not None:
            if text.style or not self._live:
                self._console.print(text, soft_wrap=True)
            else:
                self._live.update(text, refresh=True)
        if self._live:
            self._live.stop()

    def _show(self, text: Text) -> bool:
        try:
            self._texts.put_nowait(text)
        except queue.Full:
            return False
        return True

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
            words = f"not fetched by the program that has the port open: {counted(self._desk.port.dropped, 'octet')}"
            self._warn("dropped", now, words)
        if self._live:
            self._show(Text(self.line()))

    def line(self) -> str:
        """Time, speed, state of the drive, shaft, port."""
        desk = self._desk
        signals, truth = desk.board.signals(), desk.board.truth()
        words = self._states.get(int(signals["state"]), "?") if signals else "executes"
        port = f"open at {desk.port.rate} bit/s" if desk.port.is_open else "not open"
        return (
            f"{desk.time:9.1f} s  {self._ratio()}  {words}  shaft {truth['speed']:7.1f} rpm, load "
            f"{truth['load_torque']:.2f} Nm  port {port}, {counted(desk.octets_in, 'octet')} in, {desk.octets_out} out"
        )

    def _ratio(self) -> str:
        ratio = self._pacer.ratio
        return "–" if ratio is None else f"{ratio:.2f} × real time"

    def _warn(self, kind: str, now: float, words: str) -> None:
        if now - self._warned.get(kind, -_AGAIN) < _AGAIN:
            return
        if self._show(Text(f"stillspin: {words}", style="yellow")):
            self._warned[kind] = now
