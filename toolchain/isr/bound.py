#!/usr/bin/env python3
"""The longest paths of the interrupts on a Cortex-M3: a bound of their instructions, whatever the drive meets.

Usage: toolchain/isr/bound.py RECORDER OUT [--explain MODE]     (make isr-bound)

The same program whose instructions toolchain/isr/count.py counts is taken apart (toolchain/isr/paths). What the code
does not say by itself, how often loops go round and what excludes each other, stands in toolchain/isr/facts.txt; runs
show whether that is so: each is replayed in QEMU, which logs what is executed. A bound above the one allowed, a fact
that a run contradicts, a step of a run that takes longer than its bound, and a function of the compiler's run-time
library are failures. The table is printed and written to OUT/bounds.md and OUT/figures.json. --explain says which
functions the longest path of a mode goes through.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from isr import count
from isr.paths.bound import Bound, Way
from isr.paths.facts import Facts, read_facts
from isr.paths.program import Program, read_program
from isr.paths.steps import Steps
from isr.paths.watch import Regions, contradiction, periods

FACTS = count.ROOT / "toolchain" / "isr" / "facts.txt"
CONTROL, WINDOW = "control_isr", "window_isr"
WINDOW_MODES = {"any": "hysteresis control", "turning": "modulator"}  # who may make the pulses there
TURNING, STARTING = "turning_period", "starting_period"  # tests/m3/replay.c
ALONE = ("starting alone", "starting with a vector")
# Copying and filling memory is all that the compiler may call by itself: no float, no 64-bit division, no mathematics.
RUN_TIME = re.compile(r"_.*|(sin|cos|tan|atan2?|sqrt|pow|exp|log|fabs|floor|ceil|round|fmod)[fl]?")
CALLER = 3  # instructions of the replay around an interrupt, which are counted with its last step
WINDOW_CALLER = 5  # and around a window's own
# Of every source and every way to start those runs in which most of the facts can show.
WATCHED = {
    "observer": ("0, held", "600", "600, caught", "600, turned", "1500, mapped", "3000, reversed"),
    "paper": ("80", "2000"),
    "CONV": ("425",),
    "PP-01": ("1000",),
    "PP-02": ("425", "2000"),
    "active": ("1000",),
}


@dataclass
class Mode:
    """What is known of a mode: the longest path of each step and of all, and the kind of period it is in."""

    facts: Facts
    steps: list[Way]
    kinds: list[str]

    @property
    def worst(self) -> int:
        """Instructions of the whole."""
        return self.steps[-1].cost


def bound_of(program: Program, facts: Facts) -> Mode:
    """The longest paths over all kinds of periods of a mode."""
    best = Mode(facts, [], [])
    for kind, left_out in facts.left_out().items():
        steps = Steps(Bound(program, facts, left_out), CONTROL).longest()
        if not best.steps:
            best.steps, best.kinds = steps, [kind] * len(steps)
        for k, way in enumerate(steps):
            if way.cost > best.steps[k].cost:
                best.steps[k], best.kinds[k] = way, kind
    return best


def names_of(modes: Iterable[Facts]) -> set[str]:
    """All functions that say when something does not run."""
    found: set[str] = set()
    for facts in modes:
        found |= facts.never.union(*(run for kind in facts.kinds.values() for run in kind.values()))
    return found


def sources() -> list[Path]:
    """The drive's C."""
    return [path for folder in count.FOLDERS for path in (count.ROOT / folder).rglob("*.[ch]")]


def constants() -> dict[str, int]:
    """Whole numbers that the source defines, those of two values left out."""
    values: dict[str, set[int]] = {}
    for path in sources():
        for name, value in re.findall(r"^#define (\w+) (\d+)[uUlL]*\b", path.read_text(encoding="utf-8"), re.MULTILINE):
            values.setdefault(name, set()).add(int(value))
    return {name: value for name, (value, *others) in values.items() if not others}


def definitions(name: str) -> set[str]:
    """The files that define a function of that name, FUNCTION or FILE:FUNCTION."""
    file, _, own = name.rpartition(":")
    found = set()
    for path in sources():
        text = path.read_text(encoding="utf-8") if not file or path.name == file else ""
        begins = r"static inline [\w *]*" if path.suffix == ".h" else r"[a-zA-Z][\w *]*"
        if re.search(rf"^{begins}\b{own}\([^;]*?\{{$", text, re.MULTILINE):
            found.add(path.relative_to(count.ROOT).as_posix())
    return found


def misnamed(modes: dict[str, Facts]) -> list[str]:
    """Names that are no function's, or those of two files."""
    found = {name: sorted(definitions(name)) for name in sorted(names_of(modes.values()))}
    return [
        f"{FACTS.name}: {name} is defined in {' and '.join(files) or 'no file'}"
        for name, files in found.items()
        if len(files) != 1
    ]


def run_time(program: Program) -> list[str]:
    """What of the compiler's run-time library an interrupt may call."""
    reached = [function.name for function in program.taken_apart()]
    return [f"an interrupt may call {name}" for name in reached if RUN_TIME.fullmatch(name)]


def watch(image: Path, trace: Path, source: str, regions: Regions, modes: dict[str, Facts]) -> tuple[count.Table, str]:
    """Replays a run; its counts, and the first period that contradicts the facts."""
    family = "flux" if source in count.FLUX else source
    with tempfile.NamedTemporaryFile(dir=trace.parent, suffix=".log") as log:
        logging = ("-d", "exec,nochain", "-dfilter", regions.filter(), "-D", log.name)
        table = count.replay(image, trace, *logging)
        for number, (mark, run) in enumerate(periods(Path(log.name), regions, (TURNING, STARTING))):
            names = (f"{family} turning",) if mark == TURNING else ALONE
            found = [f"{name}: {against}" for name in names if (against := contradiction(modes[name], run))]
            if len(found) == len(names):
                return table, f"period {number}: {'; '.join(found)}"
    return table, ""


def longer_than_bound(table: count.Table, source: str, bounds: dict[str, Mode], window: int) -> list[str]:
    """Steps of a run that take more than their bound. What a flux method takes has a step of its own."""
    found: list[str] = []
    own = table.get("turning window")
    if own and own.worst > window + WINDOW_CALLER:
        found.append(f"a window's own interrupt: {own.worst} instructions, by the bound at most {window}")
    if source in count.FLUX:
        return found
    for phase, names in (("turning", (f"{source} turning",)), ("starting", ALONE)):
        for k, step in enumerate(count.STEPS):
            most = max(bounds[name].steps[k].cost for name in names)
            cost = table.get(f"{phase} {step}")
            if cost and cost.worst > most + CALLER * (k >= len(count.STEPS) - 2):
                found.append(f"{phase}, {step}: {cost.worst} instructions, by the bound at most {most}")
    return found


def rows_of(bounds: dict[str, Mode], windows: dict[str, int]) -> list[str]:
    """The published table."""
    steps = [step.replace("_", " ") for step in count.STEPS]
    lines = [f"| at most | {' | '.join(steps)} | in |", f"|---{'|---' * len(steps)}|---|"]
    for name, mode in bounds.items():
        costs = " | ".join(str(way.cost) for way in mode.steps)
        lines.append(f"| {name} | {costs} | {mode.kinds[-1] or 'any period'} |")
    for name, cost in windows.items():
        lines.append(f"| a window's own interrupt |{'  |' * (len(steps) - 1)} {cost} | {WINDOW_MODES[name]} |")
    return lines


def published(bounds: dict[str, Mode], windows: dict[str, int]) -> dict[str, Any]:
    """What the book's table is made of."""
    modes = {
        name: {"steps": [way.cost for way in mode.steps], "kind": mode.kinds[-1] or "any period"}
        for name, mode in bounds.items()
    }
    return {"modes": modes, "windows": windows}


def explain(name: str, mode: Mode) -> None:
    """Prints where the instructions of a longest path come from."""
    print(f"\n{name}: {mode.worst} instructions in {mode.kinds[-1] or 'any period'}, of these")
    for function, cost in mode.steps[-1].parts.most_common(40):
        print(f"{cost:6} {function}")


def main() -> int:
    """Take apart, bound, watch, print."""
    explained = sys.argv[sys.argv.index("--explain") + 1] if "--explain" in sys.argv else ""
    recorder, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    if missing := count.missing_tools():
        print(f"isr-bound: not installed: {' '.join(missing)}; run once: sudo apt-get install {' '.join(missing)}")
        return 1
    out.mkdir(parents=True, exist_ok=True)
    image = count.build(out)
    program, modes = read_program(image), read_facts(FACTS, constants())
    bounds = {name: bound_of(program, facts) for name, facts in modes.items() if facts.most > 0}
    windows = {name: Bound(program, modes[name], modes[name].never).of_function(WINDOW).cost for name in WINDOW_MODES}
    lines = rows_of(bounds, windows)
    (out / "bounds.md").write_text("\n".join(lines) + "\n")
    (out / "figures.json").write_text(json.dumps(published(bounds, windows)))
    print("\n".join(lines), flush=True)
    if explained:
        explain(explained, bounds[explained])
        return 0
    complaints = [*misnamed(modes), *run_time(program)]
    complaints += [
        f"{name}: {mode.worst} instructions, {mode.facts.most} are allowed"
        for name, mode in bounds.items()
        if not 0 < mode.worst <= mode.facts.most
    ]
    reached = [function.name for function in program.taken_apart()]
    regions = Regions(program, names_of(modes.values()), reached, (TURNING, STARTING))
    runs = [(source, run) for source, named in WATCHED.items() for run in count.RUNS[source] if run.name in named]

    def one(pair: tuple[str, count.Run]) -> list[str]:
        source, run = pair
        trace = count.record(recorder, out, source, run)
        table, against = watch(image, trace, source, regions, modes)
        trace.unlink()
        found = ([against] if against else []) + longer_than_bound(table, source, bounds, windows["turning"])
        print(f"isr-bound: {source}, {run.name} rpm: {len(found)} contradictions to {FACTS.name}", flush=True)
        return [f"{source}, {run.name} rpm: {complaint}" for complaint in found]

    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        complaints += [complaint for found in pool.map(one, runs) for complaint in found]
    for complaint in complaints:
        print(f"isr-bound: {complaint}")
    return 1 if complaints else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (ValueError, subprocess.CalledProcessError) as error:
        print(f"isr-bound: {error}")
        sys.exit(1)
