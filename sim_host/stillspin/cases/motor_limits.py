"""How far a parameter may go where the limit is set by other parameters: asked of the drive's own rules."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping

from stillspin import core
from stillspin.entry import Entry

_HALVINGS = 40
_TOGETHER = "machine's parameters"
_MACHINE = (
    *("pole_pairs", "stator_resistance", "inductance_d", "inductance_q", "magnet_flux"),
    *("inertia", "map_current", "speed_limit"),
)
"""What the rule that speaks of all of the machine's parameters may mean; its words name quantities."""


def conflict(native: core.NativeCore, parameters: Mapping[str, float]) -> str:
    """Which rule the parameters break, empty when they fit together."""
    try:
        native.check_parameters(dict(parameters))
    except ValueError as error:
        return str(error).removeprefix("firmware parameters: ")
    return ""


def ways_out(
    native: core.NativeCore, known: Mapping[str, Entry], parameters: Mapping[str, float], broken: str
) -> list[str]:
    """For each parameter that a broken rule names, up to where it may go or from where on, with the others as they are.

    Of all of the machine's parameters together, those that alone would mend it.

    Args:
        native: the drive.
        known: its parameters.
        parameters: their values, the default of those that are not there.
        broken: the rule in words.
    """
    together = _TOGETHER in broken
    words = _MACHINE if together else re.findall(r"[a-z][a-z0-9_]+", broken)
    named = [name for name in dict.fromkeys(words) if name in known]
    told = {name: float(parameters.get(name, known[name].default)) for name in named}
    found = []
    for name in named:

        def said(value: float, name: str = name) -> str:
            return conflict(native, {**parameters, name: value})

        bound = _bound(known[name], told[name], said)
        if bound:
            rest = [] if together else [other for other in named if other != name]
            others = [f"{other} = {told[other]:g} {known[other].unit}".rstrip() for other in rest]
            found.append(f"{bound}{' with ' if others else ''}{', '.join(others)}")
    return found


def _bound(entry: Entry, now: float, said: Callable[[float], str]) -> str:
    """How far this parameter alone has to move until no rule is broken; empty when that does not help."""
    broken = said(now)
    for end, word in ((entry.minimum, "at most"), (entry.maximum, "at least")):
        if end is None or said(end) == broken:
            continue
        wrong, right = now, end  # at the end another rule may be broken
        for _ in range(_HALVINGS):
            middle = (wrong + right) / 2.0
            wrong, right = (middle, right) if said(middle) == broken else (wrong, middle)
        steps = round(right * 10**entry.places, 3)
        bound = (math.floor(steps) if right < now else math.ceil(steps)) / 10**entry.places
        if not said(bound):
            value = f"{now:g} {entry.unit}".rstrip()
            return f"{entry.name} = {value}: {word} {bound:.{entry.places}f} {entry.unit}".rstrip()
    return ""
