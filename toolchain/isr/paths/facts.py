"""What the code does not say by itself: the table of loops, of calls through pointers, of what a mode leaves out.

    loop FUNCTION N                 a loop of this function goes round N times at most; N may be a #define of the source
    calls FUNCTION -> A B @TABLE    what it calls through pointers: functions, or all in a table
    step ends in FUNCTION           where it calls target_elapse a step of the interrupt ends
    never A B                       nothing of these functions runs
    one of KINDS, NAME: A B C       of all functions in the lines of KINDS those run in such a period, and no others
                                    (more than one line of a name are taken together)
    at most N                       the bound that this mode has to keep; modes without are for others to build on
    [MODE]                          what follows holds in this mode alone, what stands before the first in all
    [MODE: OTHER, OTHER]            the same, and all that holds in the others

Functions are those of the source, inlined ones included: NAME, FILE:NAME where there are more of one name, FILE:LINE.
A loop belongs to the innermost of them that all of it comes from, a call to the innermost.
"""

import re
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Facts:
    """What holds in one mode."""

    loops: dict[str, int] = field(default_factory=dict)
    calls: dict[str, list[str]] = field(default_factory=dict)
    step_ends: set[str] = field(default_factory=set)
    never: set[str] = field(default_factory=set)
    kinds: dict[str, dict[str, set[str]]] = field(default_factory=dict)
    most: int = 0

    def add(self, other: "Facts") -> None:
        """What holds in another mode holds here, too; not its bound."""
        self.loops |= other.loops
        self.calls |= other.calls
        self.step_ends |= other.step_ends
        self.never |= other.never
        self.kinds |= deepcopy(other.kinds)

    def left_out(self) -> dict[str, set[str]]:
        """What does not run, for each name out of all kinds."""
        found = {"": set(self.never)}
        for kind in self.kinds.values():
            some = set().union(*kind.values())
            found = {
                ", ".join(filter(None, (before, name))): left | (some - run)
                for before, left in found.items()
                for name, run in kind.items()
            }
        return found

    def take(self, line: str, constants: Mapping[str, int]) -> bool:
        """Adds a line; false where it is not understood."""
        if (found := re.fullmatch(r"loop (\S+) (\w+)", line)) and (found[2].isdigit() or found[2] in constants):
            self.loops[found[1]] = constants[found[2]] if found[2] in constants else int(found[2])
        elif found := re.fullmatch(r"calls (\S+) -> (.+)", line):
            self.calls[found[1]] = found[2].split()
        elif found := re.fullmatch(r"step ends in (\S+)", line):
            self.step_ends.add(found[1])
        elif found := re.fullmatch(r"at most (\d+)", line):
            self.most = int(found[1])
        elif found := re.fullmatch(r"never (.+)", line):
            self.never.update(found[1].split())
        elif found := re.fullmatch(r"one of (\w+), ([^:]+):(.*)", line):
            self.kinds.setdefault(found[1], {}).setdefault(found[2], set()).update(found[3].split())
        else:
            return False
        return True


def read_facts(table: Path, constants: Mapping[str, int]) -> dict[str, Facts]:
    """The facts of each mode, with the source's constants. ValueError with the line that is not understood."""
    modes = {"": Facts()}
    facts = modes[""]
    for line in table.read_text(encoding="utf-8").splitlines():
        content = " ".join(line.partition("#")[0].split())
        if mode := re.fullmatch(r"\[([^:]+)(?:: (.+))?\]", content):
            facts = modes[mode[1]] = Facts()
            for other in ["", *(mode[2].split(", ") if mode[2] else [])]:
                if other not in modes:
                    raise ValueError(f"{table.name}: there is no mode {other} above {content}")
                facts.add(modes[other])
        elif content and not facts.take(content, constants):
            raise ValueError(f"{table.name}: not understood: {content}")
    return modes
