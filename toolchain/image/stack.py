"""How deep the stack gets, from the call graph of the Cortex-M3 objects and the compiler's frame sizes.

Calls through pointers are not in the objects: toolchain/f2808/indirect_calls.txt says for every function that makes
one what it may reach, mostly by the edition's tables (hooks.py); a function that is missing there, or a recursion, is a
finding. What is named there and belongs to a feature that is not linked goes for nothing; what no feature has is a
finding. Where the drive has modes that exclude each other, the table says what holds in which, and the deepest counts.
The C28x differs: a call there takes two words, an interrupt saves what CONTEXT_WORDS says; frames are taken as half
their bytes.
"""

import re
import struct
from dataclasses import dataclass, field
from pathlib import Path

from image.elf import CALLS, ObjectFile
from image.hooks import in_other_editions, reached

TABLE = Path(__file__).resolve().parent.parent / "f2808" / "indirect_calls.txt"
CALL_WORDS = 2
CONTEXT_WORDS = 48  # 14 by the CPU, the rest is what __interrupt saves at most
LEVELS = ("main", "control_isr", "window_isr")  # background, and each may be interrupted by the next
PLAYS = "replay_pass_call"  # goes on with a recording, which a host in the loop has brought
_MODE = re.compile(r"\[(.+)\]")


@dataclass
class Depth:
    """The result: words in all, the deepest way of each level, what is wrong."""

    total: int = 0
    lines: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)


@dataclass
class Graph:
    """Frames in words and calls, by function; statics of one name are one function, the larger one."""

    frames: dict[str, int] = field(default_factory=dict)
    calls: dict[str, set[str]] = field(default_factory=dict)
    by_pointer: set[str] = field(default_factory=set)


def _is_indirect(content: bytes, start: int, end: int, marks: list[tuple[int, bool]]) -> bool:
    """A BLX by register, or a BX that is no return, among a function's instructions.

    `marks`: where constants begin (True) and end (False) in the section, in order.
    """
    at = start
    while at + 1 < end:
        if next((is_data for place, is_data in reversed(marks) if place <= at), False):
            at += 2
            continue
        (half,) = struct.unpack_from("<H", content, at)
        if half & 0xFF87 == 0x4780 or (half & 0xFF87 == 0x4700 and half != 0x4770):
            return True
        at += 4 if half >> 11 in (0b11101, 0b11110, 0b11111) else 2  # 32-bit instructions begin so
    return False


def _frames(obj: ObjectFile) -> dict[str, int]:
    usage = obj.path.with_suffix(".su")
    frames = {}
    for line in usage.read_text(encoding="utf-8").splitlines() if usage.exists() else ():
        where, size, kind = line.split("\t")
        if kind.startswith("static"):
            frames[where.rpartition(":")[2]] = (int(size) + 1) // 2
    return frames


def build_graph(objects: list[ObjectFile]) -> Graph:
    """The graph of all objects."""
    graph = Graph()
    functions = {symbol.name for obj in objects for symbol in obj.symbols if symbol.is_function}
    for obj in objects:
        frames = _frames(obj)
        for symbol in (s for s in obj.symbols if s.is_function and s.section):
            section = obj.sections[symbol.section]
            graph.frames[symbol.name] = max(graph.frames.get(symbol.name, 0), frames.get(symbol.name, 0))
            inside = range(symbol.value, symbol.value + symbol.size)
            called = {n for at, kind, n in section.relocations if at in inside and kind in CALLS and n in functions}
            graph.calls.setdefault(symbol.name, set()).update(called)
            marks = sorted(
                (m.value, m.name[1] == "d")
                for m in obj.symbols
                if m.name[:2] in ("$d", "$t") and m.section == symbol.section
            )
            if _is_indirect(section.content, symbol.value, symbol.value + symbol.size, marks):
                graph.by_pointer.add(symbol.name)
    return graph


def _modes() -> dict[str, list[str]]:
    """The table's lines by the mode that they hold in; what stands before the first mode holds in all."""
    always: list[str] = []
    modes: dict[str, list[str]] = {}
    lines = always
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        content = line.partition("#")[0].strip()
        if mode := _MODE.fullmatch(content):
            lines = modes.setdefault(mode[1], list(always))
        elif content:
            lines.append(content)
    return modes or {"": always}


def _add_indirect(
    graph: Graph, objects: list[ObjectFile], lines: list[str], depth: Depth
) -> dict[str, tuple[int, str]]:
    """Completes the graph; returns the callers that may nest: how often, by which function."""
    known: set[str] = set()
    nested: dict[str, tuple[int, str]] = {}

    def missing(name: str) -> bool:
        """Whether this edition has no such function; a complaint where no edition has."""
        if name not in graph.frames and not in_other_editions(objects, name):
            depth.complaints.append(f"{TABLE.name}: {name} is no function")
        return name not in graph.frames

    for line in lines:
        caller, arrow, callees = line.partition(" -> ")
        caller = caller.strip()
        if not arrow:
            never = line.removesuffix(" is not called")
            if never == line:
                depth.complaints.append(f"{TABLE.name}: not understood: {line}")
            elif not missing(never):
                for below in graph.calls.values():
                    below.discard(never)
            continue
        if missing(caller):
            continue
        known.add(caller)
        times = re.fullmatch(r"\s*(\d+) x (\w+)\s*", callees)
        if times:
            nested[caller] = (int(times[1]), times[2])
            continue
        for word in callees.split():
            found = reached(objects, word[1:]) if word.startswith("@") else {word}
            if found is None:
                depth.complaints.append(f"{TABLE.name}: {word} is no table")
            graph.calls.setdefault(caller, set()).update(name for name in found or () if not missing(name))
    for caller in sorted(graph.by_pointer - known):
        depth.complaints.append(f"{caller} calls through a pointer: add it to {TABLE.name}")
    for caller in sorted(known - graph.by_pointer):
        if in_other_editions(objects, caller):
            continue
        depth.complaints.append(f"{TABLE.name}: {caller} calls nothing through a pointer")
    return nested


Ways = dict[str, tuple[int, tuple[str, ...]]]


def _deepest(graph: Graph, name: str, way: tuple[str, ...], known: Ways, depth: Depth) -> tuple[int, tuple[str, ...]]:
    """Words with this function and below, and the way there."""
    if name in known:
        return known[name]
    if name in way:
        depth.complaints.append("recursion: " + " > ".join((*way[way.index(name) :], name)))
        return 0, ()
    below = [_deepest(graph, callee, (*way, name), known, depth) for callee in sorted(graph.calls.get(name, ()))]
    words, path = max(below, default=(0, ()))
    known[name] = (graph.frames.get(name, 0) + CALL_WORDS + words, (name, *path))
    return known[name]


def _depth_in(mode: str, lines: list[str], objects: list[ObjectFile]) -> Depth:
    """Background and both interrupts on top of one another, in one mode of the drive."""
    depth, graph = Depth(), build_graph(objects)
    for caller, (times, callee) in _add_indirect(graph, objects, lines, depth).items():
        graph.frames[caller] = graph.frames.get(caller, 0) + times * _deepest(graph, callee, (), {}, depth)[0]
    _add_levels(graph, LEVELS, f", {mode}" if mode else "", depth)
    return depth


def complete_graphs(objects: list[ObjectFile]) -> list[dict[str, set[str]]]:
    """Of each of the drive's modes who calls whom, through pointers, too."""
    found = []
    for lines in _modes().values():
        graph = build_graph(objects)
        _add_indirect(graph, objects, lines, Depth())
        found.append(graph.calls)
    return found


def _add_levels(graph: Graph, levels: tuple[str, ...], where: str, depth: Depth) -> set[str]:
    """The levels' depths on top of one another; all functions that are reached."""
    known: Ways = {}
    for level in levels:
        if level not in graph.frames:
            depth.complaints.append(f"there is no function {level}")
            continue
        words, path = _deepest(graph, level, (), known, depth)
        depth.total += words + (CONTEXT_WORDS if level != levels[0] else 0)
        ways = " > ".join(f"{name} {graph.frames.get(name, 0)}" for name in path)
        depth.lines.append(f"stack of {level}{where}: {words} words: {ways}")
    return set(known)


def stack_depth(objects: list[ObjectFile], levels: tuple[str, ...] = LEVELS) -> Depth:
    """The deepest of the drive's modes, and the ways of each; or another program's levels on top of one another.

    Of another program no call through a pointer is known, and it plays no recording.
    """
    if levels != LEVELS:
        depth, graph = Depth(), build_graph(objects)
        for below in graph.calls.values():
            below.discard(PLAYS)
        reached = _add_levels(graph, levels, "", depth)
        depth.complaints += [f"{name} calls through a pointer" for name in sorted(graph.by_pointer & reached)]
        return depth
    depths = [_depth_in(mode, lines, objects) for mode, lines in _modes().items()]
    complaints = dict.fromkeys(complaint for depth in depths for complaint in depth.complaints)
    shown = [line for depth in depths for line in depth.lines]
    return Depth(max(depth.total for depth in depths), shown, list(complaints))
