"""What interrupts may call of the compiler's library: to copy and to fill memory, nothing else.

No float, no 64-bit division, no mathematics: these take hundreds of cycles. Every call of the objects is followed,
those through pointers by the table of indirect calls.
"""

import re
from collections.abc import Iterable

from image.elf import CALLS, ObjectFile
from image.stack import complete_graphs

INTERRUPTS = ("control_isr", "window_isr")
COPIES = re.compile(r"_*(aeabi_)?mem(cpy|set|move|clr)\w*")


def _reached(calls: dict[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = list(INTERRUPTS)
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += calls.get(name, ())
    return found


def _library(objects: Iterable[ObjectFile]) -> dict[str, set[str]]:
    """By function what it calls that no object has."""
    objects = list(objects)
    own = {symbol.name for obj in objects for symbol in obj.symbols if symbol.is_function and symbol.section}
    found: dict[str, set[str]] = {}
    for obj in objects:
        for symbol in (s for s in obj.symbols if s.is_function and s.section):
            inside = range(symbol.value, symbol.value + symbol.size)
            relocations = obj.sections[symbol.section].relocations
            called = {name for at, kind, name in relocations if at in inside and kind in CALLS}
            found.setdefault(symbol.name, set()).update(name for name in called - own if not COPIES.fullmatch(name))
    return found


def dear_calls(objects: list[ObjectFile]) -> list[str]:
    """Functions that interrupts reach and that call what they should not, in words."""
    library = _library(objects)
    reached = set().union(*(_reached(calls) for calls in complete_graphs(objects)))
    return [
        f"{name}, which an interrupt may run, calls {called}"
        for name in sorted(reached)
        for called in sorted(library.get(name, ()))
    ]
