"""Code for a C28x that has more than an F2808: the first instruction of a floating-point unit and its like.

Code is followed from where the boot ROM jumps to: branches both ways, calls of fixed addresses. So a table of constants
is never taken for code; what only a pointer leads to is not seen here, and traps when it runs.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from stillspin.c28x.disassembler import Line, disassemble
from stillspin.flash import layout
from stillspin.flash.names import Names
from stillspin.flash.program import Program
from stillspin.flash.sections import Section

_EXTENSIONS = frozenset({0xAD, 0xB5, 0xBD, 0xBF, *range(0xE0, 0xEA)})
"""First octets that mean nothing to a fixed-point C28x, and that FPU, VCU and TMU use (SPRUHS1, opcode maps)."""
_CALLS = frozenset({"lcr", "lc", "ffc"})
_BRANCHES = frozenset({"branch", "branch_short", "banz", "bar_eq", "bar_neq", "lb", "xb_cond"})
_ENDS = frozenset({"lb", "lb_xar7", "lret", "lrete", "lretr", "iret", "xb_al", "xb_arp"})
_TARGET = re.compile(r"0x[0-9a-f]+")


def said(program: Program, parts: Sequence[Section], names: Names) -> str:
    """In words, with the place; empty where there is none."""
    place = _first(program, parts)
    if place is None:
        return ""
    return (
        f"{names.place(place)} is an instruction of a C28x with a floating-point unit (or VCU, TMU), which an F2808 "
        "has not: compile without --float_support, --vcu_support and --tmu_support, and link rts2800_ml.lib"
    )


def _first(program: Program, parts: Sequence[Section]) -> int | None:
    if not any(word >> 8 in _EXTENSIONS for block in program.blocks for word in block.words):
        return None
    moved = [(part.run, part.words, part.load - part.run) for part in parts if part.load not in {None, part.run}]
    entry = program.entry if program.word(layout.BOOT_ENTRY) is None else layout.BOOT_ENTRY
    todo, known = [] if entry is None else [entry], set[int]()
    while todo:
        place = todo.pop()
        while place not in known:
            known.add(place)
            words = _words(program, moved, place)
            if not words:
                break
            if words[0] >> 8 in _EXTENSIONS:
                return place
            line = disassemble(words, place)
            todo += _targets(line)
            if _ends(line):
                break
            place += line.words
    return None


def _words(program: Program, moved: Sequence[tuple[int, int, int]], place: int) -> list[int]:
    """The one or two words at a place, also of code that is copied to it."""
    found = []
    for address in (place, place + 1):
        word = program.word(address)
        for run, count, offset in moved if word is None else ():
            word = program.word(address + offset) if run <= address < run + count else word
        if word is None:
            break
        found.append(word)
    return found


def _targets(line: Line) -> list[int]:
    if line.form is None or line.form.operation not in _CALLS | _BRANCHES:
        return []
    return [int(text, 16) for text in _TARGET.findall(line.text)]


def _ends(line: Line) -> bool:
    """Whether nothing comes behind it."""
    if line.form is None or line.form.operation in _ENDS:
        return True
    return line.form.operation in _BRANCHES and line.text.endswith(",UNC")
