"""Whether the facts about periods hold in runs: what the emulator logs of the functions that they name.

QEMU logs where the pieces of code begin that it translates and runs. A function of the source that has some of its own
in a period has run in it.
"""

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path

from isr.paths.facts import Facts
from isr.paths.program import Program

RANGES = 32  # fewer log much that nobody asked for, more are slow to search
PERIOD = "drive_control_step"  # begins a period
_EXECUTED = re.compile(r"Trace \d+: \S+ \[[^/]*/([0-9a-f]+)/")


def _joined(ranges: Iterable[tuple[int, int]], gap: int) -> list[tuple[int, int]]:
    """Sorted ranges, those with such a gap between them as one."""
    joined: list[tuple[int, int]] = []
    for start, end in ranges:
        if joined and start - joined[-1][1] <= gap:
            joined[-1] = joined[-1][0], max(end, joined[-1][1])
        else:
            joined.append((start, end))
    return joined


class Regions:
    """Where functions of the source are in the program."""

    def __init__(
        self,
        program: Program,
        names: set[str],
        reached: Iterable[str],
        marks: Iterable[str],
    ) -> None:
        """Of the linked functions that are reached; of marks, linked functions too, and PERIOD the entry counts."""
        found: list[tuple[int, int, frozenset[str]]] = []
        for function in reached:
            for block in program.function(function).blocks.values():
                of = frozenset(name for name in names if block.is_of({name}))
                if of:
                    found.append((block.address, block.instructions[-1] + 2, of))
        for mark in (*marks, PERIOD):
            entry = program.function(mark).entry
            found.append((entry, entry + 2, frozenset((mark,))))
        self._found = sorted(found, key=lambda region: region[0])
        self._starts = [start for start, _, _ in self._found]

    def filter(self) -> str:
        """Ranges that cover them, for QEMU's option -dfilter, which tries one after the other: so they are few."""
        joined = _joined(((start, end) for start, end, _ in self._found), 0)
        gaps = sorted((after[0] - before[1] for before, after in pairwise(joined)), reverse=True)
        covering = _joined(joined, gaps[RANGES - 1]) if len(gaps) >= RANGES else joined
        return ",".join(f"{start:#x}..{end - 1:#x}" for start, end in covering)

    def at(self, address: int) -> frozenset[str]:
        """Whose code begins to run there."""
        k = bisect_right(self._starts, address) - 1
        return self._found[k][2] if k >= 0 and address < self._found[k][1] else frozenset()


def periods(log: Path, regions: Regions, marks: Iterable[str]) -> Iterator[tuple[str, set[str]]]:
    """Mark and functions of each period that one of the marks ended."""
    ends = set(marks)
    run: set[str] = set()
    with log.open(encoding="utf-8") as lines:
        for line in lines:
            if not (executed := _EXECUTED.match(line)):
                continue
            here = regions.at(int(executed[1], 16))
            if mark := here & ends:
                yield next(iter(mark)), run
                run = set()
            elif PERIOD in here:
                run = set()
            else:
                run |= here


def contradiction(facts: Facts, run: set[str]) -> str:
    """What contradicts the facts in a period in which these functions ran; empty where nothing does."""
    if against := run & facts.never:
        return f"{' '.join(sorted(against))} never run"
    for name, kind in facts.kinds.items():
        some = run & set().union(*kind.values())
        if not any(some <= allowed for allowed in kind.values()):
            return f"none of the {name} has {' '.join(sorted(some))} together"
    return ""
