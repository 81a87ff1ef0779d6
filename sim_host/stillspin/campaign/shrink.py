"""From a case that fails to the smallest departure from nominal that still does (delta debugging).

What is not needed goes first, in ever smaller groups of departures, fault and noise; then each departure that is left
is halved as often as the case still fails. Neither order nor result depends on anything but the case.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from stillspin.campaign.draw import Case

HALVINGS = 8
"""At most, of one departure: beyond that it is below half a per cent of what was drawn."""

Fails = Callable[[Case], bool]


@dataclass(frozen=True)
class Shrunk:
    """What is left of a case, and how many runs that took."""

    case: Case
    runs: int


def shrink(case: Case, fails: Fails) -> Shrunk:
    """The smallest departure from nominal that still fails.

    Args:
        case: which fails.
        fails: whether another one does.
    """
    tried = 0

    def still(other: Case) -> bool:
        nonlocal tried
        tried += 1
        return fails(other)

    return Shrunk(_halved(_without(case, still), still), tried)


def _without(case: Case, still: Fails) -> Case:
    """Without all that can go: all of it, halves, quarters, until no single one can go any more."""
    held, size = case.parts, len(case.parts)
    while size:
        at, gone = 0, False
        while at < len(held):
            smaller = held[:at] + held[at + size :]
            if still(case.only(smaller)):
                held, gone = smaller, True
            else:
                at += size
        if size == 1 and not gone:
            break
        size = max(size // 2, 1)
    return case.only(held)


def _halved(case: Case, still: Fails) -> Case:
    for name in case.drawn:
        for _ in range(HALVINGS):
            smaller = replace(case, drawn={**case.drawn, name: case.drawn[name] / 2.0})
            if not still(smaller):
                break
            case = smaller
    return case
