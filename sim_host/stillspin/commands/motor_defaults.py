"""What a motor's file leaves to the drive's defaults, although it has the dimension of something of a motor's."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from stillspin.entry import Entry

_OF_A_MOTOR = frozenset({"A", "mA", "V", "Nm", "rpm", "rpm/s", "rad/s", "rad/s2", "A2s2", "A/V", "mH", "Vs", "kgm2"})
"""Units of what is larger for a larger or faster motor; times, shares and choices are not."""


def left(known: Iterable[Entry], told: Collection[str]) -> list[Entry]:
    """Parameters that keep a default which was chosen for another motor; 0 and below is off, or means what follows.

    Args:
        known: the firmware's parameters.
        told: names of those that the motor's file states, or that follow from it.
    """
    return [entry for entry in known if entry.name not in told and entry.unit in _OF_A_MOTOR and _of_a_size(entry)]


def _of_a_size(entry: Entry) -> bool:
    return isinstance(entry.default, float) and entry.default > 0


def words(known: Iterable[Entry], told: Collection[str]) -> str:
    """The same for people, with values; empty where there is none."""
    found = [f"{entry.name} {entry.default:g} {entry.unit}" for entry in left(known, told)]
    return f"neither stated nor implied, so the drive's defaults, motor A's, hold: {', '.join(found)}" if found else ""
