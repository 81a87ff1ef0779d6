#!/usr/bin/env python3
"""Instructions of the firmware per control interrupt, by source folder and file, from a callgrind record.

Usage: toolchain/isr/host.py callgrind.out [FIGURES RPM]      FIGURES: a file that gets the parts' sums at this speed

Only lines of the firmware's own sources count, wherever they were inlined; the virtual chip behind a register access
and the plant behind it do not. The background loop and the window interrupt are in the sum.
"""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

FOLDERS = ("hal/qmath", "hal/f2808", "control", "svpwm", "estimators", "firmware")
INTERRUPT = "drive_control_interrupt"


def names_of(text: str, table: dict[str, str]) -> str:
    """A name, kept in or looked up from callgrind's compressed table: "(12) name" or "(12)"."""
    match = re.match(r"\((\d+)\)(?: (.*))?$", text)
    if not match:
        return text
    number, name = match.groups()
    if name:
        table[number] = name
    return table[number]


def count(path: Path) -> tuple[dict[str, int], int]:
    """Self cost by source file, and how often the control interrupt was called."""
    files: dict[str, str] = {}
    functions: dict[str, str] = {}
    cost: dict[str, int] = defaultdict(int)
    interrupts = 0
    current = called = ""
    skip = False
    for line in path.read_text().splitlines():
        key, equals, value = line.partition("=")
        if equals and key in {"fl", "fi", "fe"}:
            current = names_of(value, files)
        elif equals and key in {"cfi", "cfl"}:
            names_of(value, files)
        elif equals and key == "fn":
            names_of(value, functions)
        elif equals and key == "cfn":
            called = names_of(value, functions)
        elif equals and key == "calls":
            interrupts += int(value.split()[0]) if called.startswith(INTERRUPT) else 0
            skip = True  # the next line is the inclusive cost of the call
        elif re.match(r"[+\-*\d]", line):
            if not skip:
                cost[current] += int(line.split()[1])
            skip = False
    return cost, interrupts


def folder_of(file: str) -> str | None:
    """The firmware folder that a source file lies in."""
    return next((folder for folder in FOLDERS if f"/{folder}/" in file), None)


def keep(path: Path, rpm: str, parts: dict[str, int]) -> None:
    """Adds a speed's instructions per control interrupt to the figures of the book."""
    known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    path.write_text(json.dumps(known | {rpm: parts}), encoding="utf-8")


def main() -> int:
    """Print the table."""
    cost, interrupts = count(Path(sys.argv[1]))
    if interrupts == 0:
        print("host: no control interrupt in this record", file=sys.stderr)
        return 1
    total = 0.0
    for folder in FOLDERS:
        rows: dict[str, float] = defaultdict(float)  # a compiler cache may name one file by several paths
        for file, instructions in cost.items():
            if folder_of(file) == folder:
                rows[Path(file).name] += instructions / interrupts
        if not rows:
            continue
        largest = ", ".join(f"{n} {c:.0f}" for n, c in sorted(rows.items(), key=lambda r: -r[1])[:4])
        print(f"  {folder:12s} {sum(rows.values()):7.0f}   {largest}")
        total += sum(rows.values())
    print(f"  {'all':12s} {total:7.0f}   over {interrupts} interrupts")
    everything = sum(cost.values())
    parts = {part: sum(c for f, c in cost.items() if f"/sim_host/{part}/" in f) for part in ("plant", "chip")}
    parts["firmware"] = round(total * interrupts)
    parts["rest"] = everything - sum(parts.values())  # libraries (mathematics, memory), bench
    shares = ", ".join(f"{part} {100 * own / everything:.0f} %" for part, own in parts.items())
    print(f"  share of all instructions: {shares}")
    if len(sys.argv) > 2:
        keep(Path(sys.argv[2]), sys.argv[3], {part: round(own / interrupts) for part, own in parts.items()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
