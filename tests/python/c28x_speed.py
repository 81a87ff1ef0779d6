#!/usr/bin/env python3
"""How fast code of the C28x runs: the core alone, on the virtual chip, and on the whole board with its motor.

Usage: .venv/bin/python tests/python/c28x_speed.py [--least MILLIONS] [FILE]
(after `make build`; FILE gets the figures as JSON)

No part of the tests: machines differ. Of several runs the fastest counts, by the computing time of the process: what
else the machine does is not the core's. With --least it ends with status 1 where the virtual chip, its peripherals
attached, executes fewer million instructions a second.
"""

import argparse
import json
import re
import resource
import subprocess
import time
from pathlib import Path

from c28x_chip import MILLISECOND, ROOT, ask, blocks, program, put

from stillspin import core

REPEATS = 5
ALONE = ROOT / "build/release/tests/c28x/speed_c28x"
LENGTHS = 500, 3500
"""Milliseconds of the chip's time; the difference is without the start of the process."""


def computed(action):
    """What an action gives, and seconds of computing by this process and the ones that it started."""
    before = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    given = action()
    after = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return given, sum(b.ru_utime - a.ru_utime for a, b in zip(before, after, strict=True))


def alone():
    """Million instructions a second of the core without peripherals."""
    said = subprocess.run([ALONE], capture_output=True, text=True, check=True).stdout
    return float(re.match(r"[\d.]+", said)[0])


def on_chip():
    """Million instructions a second with peripherals attached, and the chip's time over computing time."""
    made = put(program("control").words)
    took = []
    for length in LENGTHS:
        answers, seconds = computed(lambda: ask([*made, f"run {length * MILLISECOND:x}", "cycles"]))  # noqa: B023
        took.append((int(answers[-1].split()[1]), seconds))
    (fewer, short), (more, long) = took
    return (more - fewer) / (long - short) / 1e6, (LENGTHS[1] - LENGTHS[0]) / 1e3 / (long - short)


def whole_drive():
    """The same of a board with its motor, which the program drives."""
    plant = {"solver": {"method": "rk4"}}
    board = core.load().VirtualBoard(plant=plant, parameters={}, seed=1, image=blocks(program("control").words))
    try:
        board.advance(LENGTHS[0] * MILLISECOND)
        before = board.code()["instructions"]
        _, seconds = computed(lambda: board.advance(1000 * MILLISECOND))
        return (board.code()["instructions"] - before) / seconds / 1e6, 1.0 / seconds
    finally:
        board.close()


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--least", type=float, default=0.0, metavar="MILLIONS")
    parser.add_argument("file", type=Path, nargs="?")
    chosen = parser.parse_args(arguments)
    began = time.monotonic()
    chip = max(on_chip() for _ in range(REPEATS))
    drive = max(whole_drive() for _ in range(REPEATS))
    figures = {
        "core": {"instructions": max(alone() for _ in range(REPEATS))},
        "chip": {"instructions": round(chip[0], 1), "simulated": round(chip[1], 2)},
        "board": {"instructions": round(drive[0], 1), "simulated": round(drive[1], 2)},
    }
    for name, row in figures.items():
        ratio = f", {row['simulated']} simulated seconds a second" if "simulated" in row else ""
        print(f"{name:6} {row['instructions']:5.1f} million instructions/s{ratio}")
    print(f"measured in {time.monotonic() - began:.0f} s, fastest of {REPEATS}")
    if chosen.file:
        chosen.file.parent.mkdir(parents=True, exist_ok=True)
        chosen.file.write_text(json.dumps(figures, indent=1) + "\n")
    if chip[0] < chosen.least:
        parser.exit(
            1, f"the virtual chip executes {chip[0]:.1f} million instructions/s, the least wanted is {chosen.least:g}\n"
        )


if __name__ == "__main__":
    main()
