"""Probes: a small part of a command, run anew, whose figures must be those of its record to the last digit.

A change that leaves the drive's behaviour as it is makes every record one of older sources, and some take an hour. Runs
are the same to the bit for the same sources and seed; so where a scenario of each command gives what was recorded, the
others of the same sources are taken to do so as well, and the record says which sources it was made of in truth.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

_SCENARIO = re.compile(r"[A-Z]\d\d[a-c]?")
_OF_MOTOR = {"B": "B17"}
_USUAL = "A16"

Records = Mapping[str, Mapping[str, Any]]


def probe_of(command: str) -> str:
    """The same with one scenario alone, which is its first; empty where a command has no such part."""
    first, *words = command.split()
    if first != "reproduce" or "SEED" in words:
        return ""
    named = [word for word in words if _SCENARIO.fullmatch(word)]
    motor = words[words.index("--motor") + 1] if "--motor" in words else ""
    one = named[0] if named else _OF_MOTOR.get(motor, _USUAL)
    return " ".join([first, one, *(word for word in words if word not in named)])


def is_as_recorded(found: Mapping[str, Any], recorded: Mapping[str, Any]) -> bool:
    """Whether the scenarios of a probe have the figures that its record has of them."""
    metrics = found.get("metrics", {})
    return bool(metrics) and all(recorded["metrics"].get(name) == figures for name, figures in metrics.items())


def vouched(old: Records, commands: Mapping[str, str], holds: Callable[[str, str], bool]) -> Iterable[tuple[str, bool]]:
    """Of each record of older sources, whether the probes of those sources hold.

    Args:
        old: the records, by name.
        commands: what made each of them.
        holds: runs the probe of a record and compares.
    """
    groups: dict[str, list[str]] = {}
    for name, record in old.items():
        groups.setdefault(record["sources"].split("+")[0], []).append(name)
    for names in groups.values():
        probes = {name: probe for name in names if (probe := probe_of(commands[name]))}
        held = [holds(name, probe) for name, probe in probes.items()]
        yield from ((name, bool(held) and all(held)) for name in names)
