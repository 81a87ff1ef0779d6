"""How a task tells the campaign, wherever that is, how far it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[int, float], bool]


def _nobody_listens(_slot: int, _share: float) -> bool:
    return True


_listeners: list[Report] = [_nobody_listens]
"""The last one is whom the tasks of this process report to."""


def report(slot: int, share: float) -> bool:
    """Tell the campaign of a task how far it is, 0 … 1; false when nobody waits for it any more.

    `slot`: which of the campaign's shares this is.
    """
    return _listeners[-1](slot, share)


@contextmanager
def reporting(to: Report) -> Iterator[None]:
    """Let `report` of this process reach somebody."""
    _listeners.append(to)
    try:
        yield
    finally:
        _listeners.remove(to)


def listen(to: Report) -> None:
    """The same from now on, in a process that does nothing else."""
    _listeners.append(to)
