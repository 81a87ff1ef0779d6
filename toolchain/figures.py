#!/usr/bin/env python3
"""Runs what the tables of README.md and the book have their figures from, and brings the tables up to date.

Usage: toolchain/figures.py [--long] [--again] [NAME]...     (make figures, make figures-long)

Each command below writes docs/figures/NAME.json. One whose file was made by the same command from the same sources is
left out, so a run that was broken off goes on where it ended; --again leaves out nothing. --long adds what takes
longer than the rest together. Exit status 1 when a command failed.
"""

import argparse
import hashlib
import json
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from book import render
from book.gather import gather

ROOT = Path(__file__).resolve().parent.parent
STILLSPIN = ROOT / ".venv/bin/stillspin"
DATA, WORK = ROOT / "docs/figures", ROOT / "build/figures"
# What decides a figure: the drive, what it runs on, what is done with it, and how it is judged.
SOURCES = (
    *("control", "estimators", "firmware", "hal", "svpwm"),
    *(
        f"sim_host/{name}"
        for name in ("bench", "chip", "devices", "plant", "motors", "profiles", "scenarios", "schemes")
    ),
    *(f"sim_host/stillspin/{name}" for name in ("cases", "measure", "runs")),
)
SUFFIXES = {".c", ".h", ".cpp", ".hpp", ".toml", ".py"}


@dataclass(frozen=True)
class Step:
    """A command of `stillspin`; `OUT` in it is where its results go."""

    name: str
    command: str
    is_long: bool = False


STEPS = (
    Step("bench", "reproduce --no-paper-scheme --out OUT"),
    Step("ideal", "reproduce --profile ideal --no-paper-scheme --no-nameplate --out OUT"),
    Step("commission", "commission --seed 2 --out OUT/params.toml"),
    Step("drift", "drift --out OUT"),
    Step("loads", "reproduce S02 S03 S04 S05 --no-paper-scheme --out OUT"),
    Step("motor-b", "reproduce S06 --no-paper-scheme --no-nameplate --out OUT"),
    Step("flux", "reproduce --motor B --no-paper-scheme --no-nameplate --out OUT"),
    Step("flux-ideal", "reproduce --motor B --profile ideal --no-paper-scheme --no-nameplate --out OUT"),
    Step("flux-beside", "reproduce S07 S08 S09 S10 S11 --no-paper-scheme --no-nameplate --out OUT", is_long=True),
    Step("startup", "startup-matrix --out OUT", is_long=True),
    Step("hil-serial", "hil all --check --port virtual --jobs 2 --json OUT/hil.json --resume", is_long=True),
    Step("hil-can", "hil all --check --can virtual --jobs 2 --json OUT/hil.json --resume", is_long=True),
    Step(
        "hil-whole",
        "hil A10 A12 A16 A18b B17 --can virtual --jobs 2 --json OUT/hil.json --resume",
        is_long=True,
    ),
)


def sources() -> str:
    """A sum over everything that decides a figure."""
    files = sorted(path for tree in SOURCES for path in (ROOT / tree).rglob("*") if path.suffix in SUFFIXES)
    total = hashlib.sha256()
    for path in files:
        total.update(f"{path.relative_to(ROOT)}\0".encode() + path.read_bytes() + b"\0")
    return total.hexdigest()[:16]


def _is_fresh(step: Step, made_of: str) -> bool:
    path = DATA / f"{step.name}.json"
    if not path.exists():
        return False
    known = json.loads(path.read_text(encoding="utf-8"))
    return (known["command"], known["sources"]) == (f"stillspin {step.command}", made_of)


def carry_out(step: Step, made_of: str) -> bool:
    """Run a command and keep its figures; False when it failed."""
    out = WORK / step.name
    if "--resume" not in step.command:
        shutil.rmtree(out, ignore_errors=True)  # what an earlier run left is no result of this one
    if not step.command.startswith("reproduce") and step.name != "drift":
        out.mkdir(parents=True, exist_ok=True)
    arguments = [word.replace("OUT", str(out)) for word in step.command.split()]
    log = WORK / f"{step.name}.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as said:  # the bar of progress is on the other stream
        status = subprocess.run([STILLSPIN, *arguments], cwd=ROOT, stdout=said, check=False).returncode
    found = gather(out) if out.exists() else {}
    if status not in (0, 1) or not found:  # 1: a goal is missed, which is a result
        print(f"figures: {step.name}: exit status {status}; see {log}", file=sys.stderr)
        return False
    content = {"command": f"stillspin {step.command}", "sources": made_of, "figures": found}
    DATA.mkdir(exist_ok=True)
    text = json.dumps(content, indent=1, ensure_ascii=False, sort_keys=True)
    (DATA / f"{step.name}.json").write_text(text + "\n", encoding="utf-8")
    return True


def main() -> int:
    """See the module's text."""
    parser = argparse.ArgumentParser(description="Renews the figures of README.md and the book.")
    parser.add_argument("--long", action="store_true", help="also what takes long")
    parser.add_argument("--again", action="store_true", help="also what is fresh")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(step.name for step in STEPS))
    options = parser.parse_args()
    if unknown := set(options.names) - {step.name for step in STEPS}:
        parser.error(f"no such step: {', '.join(sorted(unknown))}")
    made_of = sources()
    named = [
        step
        for step in STEPS
        if step.name in options.names or (not options.names and (options.long or not step.is_long))
    ]
    todo = [step for step in named if options.again or not _is_fresh(step, made_of)]
    print(f"figures: {len(todo)} of {len(named)} commands to run, {len(named) - len(todo)} fresh", flush=True)
    failed = False
    for k, step in enumerate(todo, 1):
        print(f"figures: {k} of {len(todo)}: stillspin {step.command}", flush=True)
        begun = time.monotonic()
        failed = not carry_out(step, made_of) or failed
        print(f"figures: {step.name} took {time.monotonic() - begun:.0f} s", flush=True)
    for piece in render(ROOT, write=True):
        if not piece.is_fresh:
            print(f"figures: {piece.page}: {piece.name} renewed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
