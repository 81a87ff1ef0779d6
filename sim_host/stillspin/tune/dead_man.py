"""The motor runs while somebody holds it, and no longer."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

PATIENCE = 0.6
"""Seconds without a word from who holds it; the page speaks ten times a second."""


class DeadMan:
    """Who holds the motor, and since when nothing was heard. Any thread."""

    def __init__(self, patience: float = PATIENCE, clock: Callable[[], float] = time.monotonic) -> None:
        self.patience = patience
        """Seconds of silence that are borne."""
        self.clock = clock
        """Tells the time in seconds."""
        self._lock = threading.Lock()
        self._holder: str | None = None
        self._heard = 0.0

    def take(self, who: str) -> None:
        """`who` holds the motor from now on; the one before does not."""
        with self._lock:
            self._holder, self._heard = who, self.clock()

    def tell(self, who: str) -> None:
        """`who` is still there."""
        with self._lock:
            if who == self._holder:
                self._heard = self.clock()

    @property
    def heard(self) -> float:
        """When the holder was heard last, by the clock."""
        return self._heard

    def release(self, who: str | None = None) -> bool:
        """Nobody holds it any more; true when somebody (or `who`) did."""
        with self._lock:
            held = self._holder is not None and who in {None, self._holder}
            if held:
                self._holder = None
            return held

    def is_held_by(self, who: str) -> bool:
        """Whether it is `who`."""
        with self._lock:
            return self._holder == who

    def expired(self) -> bool:
        """True once, when the holder has been silent for too long; it then holds the motor no more."""
        with self._lock:
            late = self._holder is not None and self.clock() - self._heard > self.patience
            if late:
                self._holder = None
            return late
