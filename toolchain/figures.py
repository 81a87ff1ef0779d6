#!/usr/bin/env python3
"""Runs what the tables of README.md and the book have their figures from, and brings the tables up to date.

Usage: toolchain/figures.py [--long] [--again] [--list | --confirm] [NAME]...     (make figures, make figures-long)

Each command below writes docs/figures/NAME.json. One whose file was made by the same command from the same sources is
left out, so a run that was broken off goes on where it ended; --again leaves out nothing. --long adds what takes
longer than the rest together, and the commands of the Makefile that keep records of their own, but for the mutants.
--list runs nothing: it says which records are of older sources, and the exit status is 1 when there are any. --confirm
is for sources that were changed and do as before: it runs one scenario of each command, and where all of them have
their recorded figures to the last digit, the records count as made of today's sources (toolchain/book/probes.py); else
the exit status is 1. Exit status 1 when a command failed.
"""

import argparse
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from book import probes, records, render
from book.gather import gather, worst

ROOT = Path(__file__).resolve().parent.parent
STILLSPIN = ROOT / ".venv/bin/stillspin"
WORK = ROOT / "build/figures"


@dataclass(frozen=True)
class Step:
    """A command of `stillspin`; `OUT` in it is where its results go, `SEED` a seed.

    Attributes:
        seeds: it is run with so many, from 1 on, and the worst of the figures are kept.
    """

    name: str
    command: str
    is_long: bool = False
    seeds: int = 1


_PAPER_A = "reproduce A10 A11 A15 A16 A17 A18a A18b A18c A19 S12 S13 --scheme paper"
_PAPER_B = "reproduce B07 B09 B14 B15 B16 B17 B18 B19 B20 B21 B22 B23 B24"
_SEEDS = "reproduce A10 A11 A15 A16 A17 A18a A18b A18c S13 --scheme paper --seed SEED"
_NOISE = "--profile build/figures/ideal-noise.toml"  # as `stillspin run ID --profile ideal --set adc.noise=1.2`
_LOW_PASS = "toolchain/book/cases/paper_flux_low_pass.toml"
_ALONE = "--no-paper-scheme --no-nameplate --out OUT"
_TRIPS = "round-trips --may-lose 1"
_MAKE_THEIR_OWN = ("reproduce", "drift", "explain", "round-trips")  # the directory, whole or not at all

PAPERS = (
    Step("papers-a-ideal", f"{_PAPER_A} --profile ideal {_ALONE}", is_long=True),
    Step("papers-a-noise", f"{_PAPER_A} {_NOISE} {_ALONE}", is_long=True),
    Step("papers-a-bench", f"{_PAPER_A} {_ALONE}", is_long=True),
    Step("papers-seeds-noise", f"{_SEEDS} {_NOISE} {_ALONE}", is_long=True, seeds=5),
    Step("papers-seeds-bench", f"{_SEEDS} {_ALONE}", is_long=True, seeds=5),
    Step("papers-b-ideal", f"{_PAPER_B} --scheme paper_flux --profile ideal {_ALONE}", is_long=True),
    Step("papers-b-noise", f"{_PAPER_B} --scheme paper_flux {_NOISE} {_ALONE}", is_long=True),
    Step("papers-b-bench", f"{_PAPER_B} --scheme paper_flux {_ALONE}", is_long=True),
    Step("papers-b-low-pass", f"{_PAPER_B} --scheme {_LOW_PASS} --profile ideal {_ALONE}", is_long=True),
    Step("papers-trips-ideal", f"{_TRIPS} --scheme paper --profile ideal --out OUT", is_long=True),
    Step("papers-trips-noise", f"{_TRIPS} --scheme paper --profile ideal --set adc.noise=1.2 --out OUT", is_long=True),
    Step("papers-trips-bench", f"{_TRIPS} --scheme paper --out OUT", is_long=True),
    Step("trips-ideal", f"{_TRIPS} --profile ideal --out OUT", is_long=True),
    Step("trips-bench", f"{_TRIPS} --out OUT", is_long=True),
)
"""The papers' own drives."""

STEPS = (
    Step("bench", "reproduce --no-paper-scheme --out OUT"),
    Step("ideal", "reproduce --profile ideal --no-paper-scheme --no-nameplate --out OUT"),
    Step("commission", "commission --seed 2 --out OUT/params.toml"),
    Step("drift", "drift --out OUT"),
    Step("explain", "explain A09 --no-alone --out OUT"),
    Step("loads", "reproduce S02 S03 S04 S05 --no-paper-scheme --out OUT"),
    Step("motor-b", "reproduce S06 --no-paper-scheme --no-nameplate --out OUT"),
    Step("flux", "reproduce --motor B --no-paper-scheme --no-nameplate --out OUT"),
    Step("flux-ideal", "reproduce --motor B --profile ideal --no-paper-scheme --no-nameplate --out OUT"),
    *PAPERS,
    Step("flux-beside", "reproduce S07 S08 S09 S10 S11 --no-paper-scheme --no-nameplate --out OUT", is_long=True),
    Step("startup", "startup-matrix --out OUT", is_long=True),
    Step("type-test", "type-test --catalogue --few --out OUT", is_long=True),
    Step("hil-serial", "hil all --check --port virtual --jobs 2 --json OUT/hil.json --resume", is_long=True),
    Step("hil-can", "hil all --check --can virtual --jobs 2 --json OUT/hil.json --resume", is_long=True),
    Step(
        "hil-whole",
        "hil A10 A12 A16 A18b B17 --can virtual --jobs 2 --json OUT/hil.json --resume",
        is_long=True,
    ),
)


LONGEST = "mutants"
"""Hours: runs only where it is named."""


def _is_fresh(step: Step) -> bool:
    known = records.load(ROOT).get(step.name)
    now = (f"stillspin {step.command}", records.sources_of(ROOT, step.name))
    return known is not None and (known["command"], known["sources"]) == now


def make_noisy() -> None:
    """Profile `ideal` with the noise of a converter, which is all that a command of its own would change."""
    ideal = (ROOT / "sim_host/profiles/ideal.toml").read_text(encoding="utf-8")
    WORK.mkdir(parents=True, exist_ok=True)
    (WORK / "ideal-noise.toml").write_text(ideal.replace("\nnoise = 0.0\n", "\nnoise = 1.2\n"), encoding="utf-8")


def _run(step: Step, out: Path, seed: int) -> tuple[int, dict[str, Any]]:
    """Run a command: its exit status, and the figures that it left."""
    if "--resume" not in step.command:
        shutil.rmtree(out, ignore_errors=True)  # what an earlier run left is no result of this one
    if not step.command.startswith(_MAKE_THEIR_OWN):
        out.mkdir(parents=True, exist_ok=True)
    words = {"OUT": str(out), "SEED": str(seed)}
    arguments = [re.sub("OUT|SEED", lambda found: words[found[0]], word) for word in step.command.split()]
    log = WORK / f"{step.name}.log"
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w", encoding="utf-8") as said:  # the bar of progress is on the other stream
        status = subprocess.run([STILLSPIN, *arguments], cwd=ROOT, stdout=said, check=False).returncode
    return status, gather(out) if out.exists() else {}


def carry_out(step: Step) -> bool:
    """Run a command and keep its figures; False when it failed."""
    each, made_of = [], records.sources_of(ROOT, step.name)
    for seed in range(1, step.seeds + 1):
        status, found = _run(step, WORK / step.name, seed)
        if status not in (0, 1) or not found:  # 1: a goal is missed, which is a result
            log = WORK / f"{step.name}.log"
            print(f"figures: {step.name}: exit status {status}; see {log}", file=sys.stderr)
            return False
        each.append(found)
    found = each[0] if step.seeds == 1 else {"metrics": worst([one["metrics"] for one in each])}
    records.keep(ROOT, step.name, f"stillspin {step.command}", found, made_of)
    return True


def _probe(name: str, command: str) -> bool:
    """Run a part of what made a record: whether it has the record's figures."""
    print(f"figures: probe of {name}: stillspin {command}", flush=True)
    _, found = _run(Step(f"probe-{name}", command), WORK / "probe" / name, seed=1)
    is_same = probes.is_as_recorded(found, records.load(ROOT)[name]["figures"])
    if not is_same:
        print(f"figures: {name} has other figures now: {WORK / 'probe' / name / 'metrics.json'}", flush=True)
    return is_same


def confirm(steps: list[Step]) -> bool:
    """Confirm what was made by the same commands of other sources of the drive; whether that is all that is old."""
    commands = {step.name: step.command for step in steps}
    known, old = records.load(ROOT), records.outdated(ROOT)
    now = {name: records.sources_of(ROOT, name) for name in commands if name in old}
    alike = {
        name: known[name]
        for name, sources in now.items()
        if known[name]["command"] == f"stillspin {commands[name]}"
        and known[name]["sources"].partition("+")[2] == sources.partition("+")[2]
    }
    left = [name for name in now if name not in alike]
    for name, is_same in probes.vouched(alike, commands, _probe):
        if is_same:
            records.confirm(ROOT, name, now[name])
            print(f"figures: {name} confirmed", flush=True)
        else:
            left.append(name)
    for name in left:
        print(f"figures: {name} is of older sources still; renew it: {old[name]}")
    return not left


def carry_out_make(name: str) -> bool:
    """Run a command of the Makefile, which keeps its figures by itself; False when it failed."""
    command = records.COMMANDS[name].command
    return subprocess.run(command, cwd=ROOT, shell=True, check=False).returncode == 0


def _chosen(long: bool, names: list[str]) -> tuple[list[Step], list[str]]:
    """What is asked for: commands of `stillspin`, commands of the Makefile."""
    if names:
        return [step for step in STEPS if step.name in names], [name for name in records.COMMANDS if name in names]
    made = [name for name in records.COMMANDS if long and name != LONGEST]
    return [step for step in STEPS if long or not step.is_long], made


def main() -> int:
    """See the module's text."""
    known = (*(step.name for step in STEPS), *records.COMMANDS)
    parser = argparse.ArgumentParser(description="Renews the figures of README.md and the book.")
    parser.add_argument("--long", action="store_true", help="also what takes hours")
    parser.add_argument("--again", action="store_true", help="also what is up to date")
    parser.add_argument("--list", action="store_true", help="only say what was made from older sources")
    parser.add_argument("--confirm", action="store_true", help="see by a part of each that what is old has not changed")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(known))
    options = parser.parse_args()
    if unknown := set(options.names) - set(known):
        parser.error(f"no such step: {', '.join(sorted(unknown))}")
    old = records.outdated(ROOT)
    if options.list:
        for name, command in old.items():
            print(f"figures: {name} was made from older sources; renew it: {command}")
        return 1 if old else 0
    if options.confirm:
        make_noisy()
        return 0 if confirm([step for step in STEPS if not options.names or step.name in options.names]) else 1
    steps, made = _chosen(options.long, options.names)
    todo = [step for step in steps if options.again or not _is_fresh(step)]
    by_make = [name for name in made if options.again or name in old or name not in records.load(ROOT)]
    count, left = len(todo) + len(by_make), len(steps) + len(made)
    print(f"figures: {count} of {left} commands to run, {left - count} are up to date", flush=True)
    failed = False
    make_noisy()
    for k, step in enumerate(todo, 1):
        print(f"figures: {k} of {count}: stillspin {step.command}", flush=True)
        failed = not carry_out(step) or failed
    for k, name in enumerate(by_make, len(todo) + 1):
        print(f"figures: {k} of {count}: {records.COMMANDS[name].command}", flush=True)
        failed = not carry_out_make(name) or failed
    for piece in render(ROOT, write=True):
        if not piece.is_fresh:
            print(f"figures: {piece.page}: {piece.name} renewed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
