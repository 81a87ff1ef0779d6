"""How much simulated time is due, and whether the machine keeps up."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

LAG = 0.2
"""Seconds of wall time that may be caught up; what lies further back is given up."""
WINDOW = 2.0
"""Seconds of wall time over which the ratio is measured."""
ENOUGH = 0.97
"""Share of the wanted speed from which the machine counts as keeping up."""


class Pacer:
    """Holds simulated time to `speed` times the wall clock; 0 is as fast as possible."""

    def __init__(self, speed: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._speed = speed
        self._clock = clock
        self._origin = clock()
        self._marks: deque[tuple[float, float]] = deque([(self._origin, 0.0)])

    @property
    def free(self) -> bool:
        """Whether it runs as fast as possible."""
        return self._speed == 0.0

    def due(self, simulated: float) -> float:
        """Simulated seconds that are due now, negative when it is ahead.

        Args:
            simulated: seconds that have been simulated.
        """
        now = self._clock()
        self._mark(now, simulated)
        if self.free:
            return float("inf")
        behind = (now - self._origin) * self._speed - simulated
        if behind > LAG * self._speed:
            self._origin += (behind - LAG * self._speed) / self._speed
            behind = LAG * self._speed
        return behind

    def wall(self, simulated: float) -> float:
        """Seconds of wall time that so much simulated time takes, 0 when as fast as possible."""
        return 0.0 if self.free else max(simulated / self._speed, 0.0)

    @property
    def ratio(self) -> float | None:
        """Simulated by real time over the last seconds; None before there is anything to measure."""
        (began, from_), (ended, to) = self._marks[0], self._marks[-1]
        return (to - from_) / (ended - began) if ended - began >= WINDOW / 4 else None

    @property
    def late(self) -> bool:
        """Whether the machine does not keep up."""
        if self.free or self._marks[-1][0] - self._marks[0][0] < WINDOW:
            return False
        ratio = self.ratio
        return ratio is not None and ratio < ENOUGH * self._speed

    def _mark(self, now: float, simulated: float) -> None:
        if now - self._marks[-1][0] >= WINDOW / 20 or len(self._marks) == 1:
            self._marks.append((now, simulated))
        while len(self._marks) > 2 and now - self._marks[1][0] >= WINDOW:
            self._marks.popleft()
