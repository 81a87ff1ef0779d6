"""Ctrl-C held back until it does no harm."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType

_Handler = Callable[[int, FrameType | None], object]


class HeldInterrupt:
    """What asks this process to end (SIGINT, SIGTERM) is noted, and heard where `hear` is called.

    An exception in the middle of the library's code that waits for workers leaves locks behind that their results need:
    whoever then waits for the workers to end waits for ever. Who asks a second time is heard at once. Only the main
    thread hears signals; in another one this does nothing.
    """

    def __init__(self) -> None:
        self._handlers: dict[int, _Handler] = {}
        self._noted: int | None = None

    def __enter__(self) -> HeldInterrupt:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                handler = signal.getsignal(number)
                if callable(handler):  # neither ignored nor left to the system
                    self._handlers[number] = handler
                    signal.signal(number, self._note)
        return self

    def hear(self) -> None:
        """Do now what was asked for, once.

        Raises:
            KeyboardInterrupt: somebody wants an end; whatever else the handlers from before raise.
        """
        number, self._noted = self._noted, None
        if number is not None:
            self._handlers[number](number, None)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._give_back()
        if error is None:
            self.hear()

    def _give_back(self) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)

    def _note(self, number: int, _frame: FrameType | None) -> None:
        self._noted = number
        self._give_back()  # a second one is heard at once
