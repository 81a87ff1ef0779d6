#!/usr/bin/env python3
"""Cycles of TI's IQ library on the C28x core of the virtual chip, beside those that TI publishes.

Usage: .venv/bin/python toolchain/c28x_iqmath.py FOLDER [Q]     (after `make build`; default Q is 24)

FOLDER has the library's sources, IQN*.asm (C2000Ware, libraries/math/IQmath/c28/source), which are no part of this
project. The head of each says its cycles, from the call to the return, for code, tables and stack in blocks of RAM of
their own, and for tables in a memory with one wait. Tables are zeros here: how long a routine takes depends on no value
but a denominator of zero. Exit status 0 when every routine is within three cycles, 1 when one is not, 2 for a
folder without routines.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from stillspin.c28x.macros import ExpansionError
from stillspin.c28x.program import Program, assemble
from stillspin.errors import InputError

ROOT = Path(__file__).resolve().parent.parent
DESK = ROOT / "build/release/tests/c28x/c28x_desk"
ALLOWED = 3
CODE, TABLES, STACK, CALLER = 0x3F8000, 0x3FA000, 0x0400, 0x3F9000
BLOCKS = {CODE: 1, CALLER: 1, STACK: 3}
WAITS = (0, 1)
"""Of the memory that the tables are in."""
RETURN_CYCLES = 1
"""Of the ESTOP0 behind the call."""


class Published(NamedTuple):
    """A line of a head."""

    cycles: int
    condition: str

    def holds(self, q: int, waits: int) -> bool:
        """Whether it is of this number of fractional bits and these tables."""
        memory = "1-wait" if waits else "0-wait"
        if "Den" in self.condition or ("-wait" in self.condition and memory not in self.condition):
            return False
        between = re.search(r"(\d+)\s*>=\s*Q\s*>=\s*(\d+)", self.condition)
        if between:
            return int(between[2]) <= q <= int(between[1])
        between = re.search(r"(\d+)\s*<=\s*Q\s*<=\s*(\d+)", self.condition)
        return between is None or int(between[1]) <= q <= int(between[2])


def published(text: str) -> list[Published]:
    """What a head says: `Cycles = N (condition)` and the lines below it that go on."""
    found, within = [], False
    for line in text.splitlines():
        match = re.match(r";+\s*(Cycles\s*)?=?\s*(\d+)\s*(?:\((.*)\))?\s*$", line)
        if match and (match[1] or within):
            found.append(Published(int(match[2]), match[3] or ""))
            within = True
        else:
            within = False
    return found


def names_of_elsewhere(text: str) -> list[str]:
    """Tables and constants that a routine refers to."""
    return sorted(set(re.findall(r"#\(?\s*(_IQ\w+)", text)))


def routine(text: str, q: int) -> tuple[str, Program] | None:
    """The name and the code of the routine for so many fractional bits; None where there is none."""
    symbols = {"GLOBAL_Q": q} | {name: TABLES + 0x100 * (1 + n) for n, name in enumerate(names_of_elsewhere(text))}
    program = assemble(text, sections={"IQmath": CODE}, symbols=symbols)
    entries = [name for name, address in program.labels.items() if address == CODE]
    return (entries[0], program) if entries else None


def measured(program: Program, waits: int) -> int:
    """Cycles from the call to the return.

    The arguments are 1.0 and 0.75 in accumulator and stack, whatever the routine takes of them.
    """
    call = assemble(f" .org {CALLER:#x}\n LCR {CODE:#x}\n ESTOP0\n")
    commands = ["fresh"]
    for address, word in {**program.words, **call.words}.items():
        commands.append(f"put {address:x} {word:x}")
    commands += [f"region {first:x} 400 {block:x} 0 1 1 1 3 0" for first, block in BLOCKS.items()]
    commands += [f"region {TABLES:x} 1000 2 {waits} 1 {1 + waits} {1 + waits} 3 0"]
    commands += [f"put {STACK:x} 0 c0", f"set sp {STACK + 2:x}", "set acc 1000000", "set objmode 1"]
    commands += [f"set pc {CALLER:x}", "go 100000", "cycles"]
    done = subprocess.run([DESK], input="\n".join(commands) + "\n", capture_output=True, text=True, check=True)
    end, spent = done.stdout.splitlines()[:2]
    if end != "breakpoint":
        raise InputError(f"the routine did not return ({end})")
    return int(spent.split()[0]) - RETURN_CYCLES


def main() -> int:
    """Exit status."""
    if not 2 <= len(sys.argv) <= 3 or not Path(sys.argv[1]).is_dir():
        print(__doc__)
        return 2
    q = int(sys.argv[2]) if len(sys.argv) == 3 else 24
    rows = wrong = 0
    print(f"{'routine':<20}{'tables':<14}{'published':>10}{'here':>8}")
    for file in sorted(Path(sys.argv[1]).glob("IQN*.asm")):
        text = file.read_text(encoding="latin-1")
        try:
            found = routine(text, q)
        except (InputError, ExpansionError) as error:
            print(f"{file.name}: not assembled: {error}")
            continue
        for waits in WAITS if found else ():
            said = [line.cycles for line in published(text) if line.holds(q, waits)]
            if not said:
                continue
            name, program = found
            here = measured(program, waits)
            rows += 1
            apart = min(abs(here - cycles) for cycles in said)
            wrong += apart > ALLOWED
            print(
                f"{name:<20}{f'{waits} waits':<14}{'/'.join(map(str, said)):>10}{here:>8}"
                + ("   FAR OFF" if apart > ALLOWED else "")
            )
    if not rows:
        print(f"{sys.argv[1]}: no IQN*.asm with cycles in its head")
        return 2
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
