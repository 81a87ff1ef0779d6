"""What a motor's file leaves to the drive's defaults, although it has the dimension of something of a motor's."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from stillspin import core
from stillspin.cases import similarity
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


def _shown(known: Mapping[str, Entry], values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} {value:g} {known[name].unit}" for name, value in values.items())


def notes(
    known: Mapping[str, Entry], plant: core.Plant, told: Mapping[str, float], by_rule: Collection[str]
) -> list[str]:
    """For people, with values: what has its value by the size of the machine, and what keeps a default.

    Args:
        known: the firmware's parameters at the drive's scales.
        plant: what the motor's file states of machine and board.
        told: what the drive is told.
        by_rule: parameters among them that a rule says (cases/similarity.py).
    """
    kept = {entry.name: float(entry.default) for entry in left(known.values(), {*told, *similarity.RULES})}
    rows = (
        ("by rules, for a machine of this size", {name: told[name] for name in by_rule}),
        ("neither stated nor implied, so the drive's defaults, motor A's, hold", kept),
    )
    return [f"{title}: {_shown(known, values)}" for title, values in rows if values]
