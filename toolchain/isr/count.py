#!/usr/bin/env python3
"""Instructions of the control interrupt on a Cortex-M3, counted in QEMU, and the same results bit for bit.

Usage: toolchain/isr/count.py RECORDER OUT     (make isr-cost)

Runs of the virtual drive are recorded natively at the drive's register accesses and replayed on an emulated
Cortex-M3 that runs the whole firmware (tests/m3). A replay that does anything else than the native run, a count above
toolchain/isr/budget.txt, and a charge of isr_cycles.h that the count does not bear out are failures. The table
is printed and written to OUT/table.md, the counts to OUT/figures.json.
"""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402

BUDGET = ROOT / "toolchain" / "isr" / "budget.txt"
CHARGES = ROOT / "firmware" / "interfaces" / "isr_cycles.h"
COMPILER = "arm-none-eabi-gcc"
EMULATOR = "qemu-system-arm"
FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware")
CPU = ("-mcpu=cortex-m3", "-mthumb")
# Left on, the first of these passes move the widening of an operand away from its product, and GCC then multiplies 64
# by 64 bits; the others keep more values alive at once than the Cortex-M3 has registers. Tried one by one and together.
PLAIN = (
    *("-fno-tree-pre", "-fno-tree-vrp", "-fno-tree-fre", "-fno-early-inlining"),
    *("-fno-schedule-insns", "-fno-schedule-insns2", "-fno-tree-ter", "-fno-ssa-phiopt", "-fno-ipa-cp"),
    *("-fno-if-conversion", "-fno-if-conversion2", "-fno-section-anchors", "-fno-reorder-blocks"),
)
COMMON = (*CPU, "-g", "-std=c99", "-Wall", "-Wextra", "-I.")
# The firmware as one program, as the DSP's compiler is run. What counts is not part of that program: a register access
# stays a call of a function that nobody looks into, and the counting itself is the same code whatever the firmware is.
PROGRAM = ("-O3", *PLAIN, "-flto=auto", "-flto-partition=one")
COUNTER = ("-O2",)
# What the virtual chip lets pass (isr_cycles.h) is the worst period of each step, in cycles of the C28x: more than the
# operations of this code give (0.9 to 1.1 cycles for an instruction of the Cortex-M3), and within this share of it.
CYCLES_PER_INSTRUCTION = 1.25
CHARGE_MARGIN = 0.1
CHARGED = {
    "CYCLES_READ_SAMPLES": "samples",
    "CYCLES_ESTIMATE": "estimate",
    "CYCLES_SUPERVISE": "supervise",
    "CYCLES_CONTROL": "control",
    "CYCLES_MODULATE": "modulate",
    "CYCLES_WINDOW": "window",
}
STEPS = ("samples", "estimate", "supervise", "control", "modulate", "hand_over", "link", "all")
PAPER = ("position_source=1", "id_low_speed=5", "window_minimum=20", "window_maximum=20", "synchronism_time=1000")
FLUX = {name: (f"position_source={number}",) for number, name in enumerate(("CONV", "PP-01", "PP-02", "active"), 5)}
SOURCES = {"observer": (), "paper": PAPER, **FLUX}
STEPWISE = ("observer", "paper")  # whose steps have a table


@dataclass(frozen=True)
class Run:
    """A start and a load step: speed in rpm, load in N m, speed of the shaft at the start in rpm."""

    rpm: int
    load: int
    shaft: int = 0
    more: str = ""  # what else is different
    parameters: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its row."""
        return f"{self.rpm}{self.more and ', '}{self.more}"


HELD = ("hold_time=500",)
MAPPED = ("map_current=14", "lqq_1=97", "lqq_2=94", "lqq_3=90", "lqq_4=85", "ldq_2=0.05", "ldq_4=0.1", "map_known=1")
# The paper's scheme loses a shaft that it has to bring up from standstill; caught at 600 rpm it holds it. At 80 rpm
# both of its estimators are at work.
RUNS = {
    "observer": (
        *(Run(0, 5), Run(0, 5, 0, "held", HELD), Run(60, 5), Run(600, 8), Run(1200, 5), Run(1500, 5)),
        *(Run(600, 5, 600, "caught"), Run(600, 2, 0, "turned", ("start_method=1",))),
        *(Run(600, 5, 0, "charged", ("bootstrap_time=15",)), Run(1500, 5, 1500, "caught")),
        *(Run(1500, 5, 0, "mapped", MAPPED), Run(2000, 5), Run(3000, 1), Run(3000, 1, -3000, "reversed")),
    ),
    "paper": (Run(0, 0), Run(80, 0, 600), Run(600, 5, 600), Run(1500, 3, 600), Run(2000, 3, 600), Run(3000, 1, 600)),
    # At 425 rpm the observer hands over and both are at work; above the flux is alone.
    **dict.fromkeys(FLUX, (Run(425, 5), Run(1000, 5, 600), Run(2000, 3, 600), Run(3000, 1, 600))),
}

# The scope is no step: it costs what the worst period of a run is longer with it.
BARE, SCOPED = Run(600, 8), Run(600, 8, 0, "scope", ("scope=1",))


@dataclass
class Cost:
    """Periods, mean and worst instructions of one step."""

    periods: int
    mean: float
    worst: int


Table = dict[str, Cost]  # by phase and step


def missing_tools() -> list[str]:
    """What is not installed, as Debian packages."""
    packages = []
    if shutil.which(COMPILER) is None:
        packages.append("gcc-arm-none-eabi libnewlib-arm-none-eabi")
    if shutil.which(EMULATOR) is None:
        packages.append("qemu-system-arm")
    return packages


def build(out: Path) -> Path:
    """The firmware with the replaying target as an image for the emulator."""
    found = (path.relative_to(ROOT) for folder in FOLDERS for path in (ROOT / folder).rglob("*.c"))
    sources = sorted(path for path in found if "image" not in path.parts)  # the DSP's own start
    counters = [Path("tests/m3/replay.c"), Path("tests/m3/startup.c")]
    made = compose.write(out.resolve() / "made")
    ccache = [tool] if (tool := shutil.which("ccache")) else []

    def compile_one(source: Path) -> Path:
        target = out / source.as_posix().strip("/").replace("/", "_").replace(".c", ".o")
        flags = (*COMMON, f"-I{out.resolve() / 'made'}", *(COUNTER if source in counters else PROGRAM))
        subprocess.run([*ccache, COMPILER, *flags, "-c", source.as_posix(), "-o", target], cwd=ROOT, check=True)
        return target

    with ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(compile_one, [*sources, *made, *counters]))

    def start_file(name: str) -> str:
        found = subprocess.run([COMPILER, *CPU, f"-print-file-name={name}"], capture_output=True, text=True, check=True)
        return found.stdout.strip()

    image = out / "replay.elf"
    link = [COMPILER, *CPU, *PROGRAM, "-T", "tests/m3/m3.ld", "-nostartfiles", "--specs=rdimon.specs"]
    first = [start_file("crti.o"), start_file("rdimon-crt0.o")]
    subprocess.run([*link, *first, *objects, start_file("crtn.o"), "-o", image], cwd=ROOT, check=True)
    return image


def replay(image: Path, trace: Path, *more: str) -> Table:
    """The counts of one run, with more options of the emulator; an error where it is not the native one."""
    semihosting = f"enable=on,target=native,arg=replay,arg={trace}"
    machine = ["-M", "mps2-an385", "-nographic", "-monitor", "none", "-serial", "none"]
    clock = ["-icount", "shift=8,sleep=off"]
    command = [EMULATOR, *machine, *clock, "-semihosting-config", semihosting, "-kernel", str(image), *more]
    run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    if run.returncode != 0:
        raise SystemExit(f"isr-cost: {trace.name}: {run.stdout}{run.stderr}")
    table = {}
    for line in run.stdout.splitlines():
        words = line.split()
        if len(words) == 6:
            table[f"{words[0]} {words[1]}"] = Cost(int(words[2]), float(words[3]), int(words[4]))
    return table


def record(recorder: Path, out: Path, source: str, run: Run) -> Path:
    """Records one run natively."""
    trace = out / f"{source}-{run.rpm}{run.more}.trace"
    numbers = (str(number) for number in (run.rpm, run.load, run.shaft))
    subprocess.run([recorder, trace, *numbers, *SOURCES[source], *run.parameters], check=True)
    return trace


def joined(tables: Iterable[Table]) -> Table:
    """All runs as one: worst of all, mean over all."""
    total: Table = {}
    for table in tables:
        for key, cost in table.items():
            before = total.get(key, Cost(0, 0.0, 0))
            periods = before.periods + cost.periods
            mean = (before.mean * before.periods + cost.mean * cost.periods) / periods
            total[key] = Cost(periods, mean, max(before.worst, cost.worst))
    return total


def pair(cost: Cost | None) -> str:
    """Mean and worst of a cell."""
    return f"{cost.mean:.0f} | {cost.worst}" if cost else "  | "


def rows_of(results: dict[str, dict[str, Table]]) -> list[str]:
    """The published table."""
    totals = {source: joined(runs.values()) for source, runs in results.items()}
    lines = []

    def head(first: str, sources: Iterable[str]) -> None:
        titles = " | ".join(f"{source}: mean | worst" for source in sources)
        lines.extend([f"| {first} | {titles} |", f"|---{'|---|---' * len(tuple(sources))}|"])

    def row(name: str, tables: dict[str, Table], key: str) -> None:
        cells = " | ".join(pair(table.get(key)) for table in tables.values())
        lines.append(f"| {name} | {cells} |")

    head("", STEPWISE)
    stepwise = {source: totals[source] for source in STEPWISE}
    for step in STEPS:
        row("**all**" if step == "all" else step.replace("_", " "), stepwise, f"turning {step}")
    row("a window's own interrupt", stepwise, "turning window")
    row("all, during the start", stepwise, "starting all")
    lines.append("")
    head("at rpm", SOURCES)
    rows = {run.name: run.rpm for runs in RUNS.values() for run in runs}
    for name in sorted(rows, key=rows.__getitem__):
        row(name, {source: runs.get(name, {}) for source, runs in results.items()}, "turning all")
    return lines


def published(results: dict[str, dict[str, Table]]) -> dict[str, Any]:
    """What the book's tables are made of: the steps of each source over all runs, and the whole run by run."""
    return {
        source: {
            "steps": {key: asdict(cost) for key, cost in joined(runs.values()).items()},
            "runs": {name: asdict(table["turning all"]) for name, table in runs.items()},
        }
        for source, runs in results.items()
    }


def over_budget(results: dict[str, dict[str, Table]]) -> list[str]:
    """What costs more than the budget allows."""
    complaints = []
    for line in BUDGET.read_text().splitlines():
        words = line.partition("#")[0].split()
        if not words:
            continue
        source, phase, limit = words[0], words[1], int(words[2])
        worst = joined(results[source].values())[f"{phase} all"].worst
        if worst > limit:
            complaints.append(f"{source}, {phase}: {worst} instructions, budget {limit}")
    return complaints


def wrong_charges(table: Table, scope: int) -> list[str]:
    """What isr_cycles.h charges and the count does not bear out. `scope`: instructions of it."""
    text = CHARGES.read_text()
    complaints = []
    counts = {name: table[f"turning {step}"].worst for name, step in CHARGED.items()}
    for name, count in (counts | {"CYCLES_SCOPE": scope}).items():
        found = re.search(rf"#define {name} (\d+)u", text)
        charged = int(found.group(1)) if found else 0
        cycles = count * CYCLES_PER_INSTRUCTION
        if abs(charged - cycles) > CHARGE_MARGIN * cycles:
            complaints.append(f"{CHARGES.name}: {name} is {charged} cycles, the count gives {cycles:.0f}")
    return complaints


def main() -> int:
    """Build, record, replay, print."""
    recorder, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    missing = missing_tools()
    if missing:
        print(f"isr-cost: not installed: {' '.join(missing)}; run once: sudo apt-get install {' '.join(missing)}")
        return 1
    out.mkdir(parents=True, exist_ok=True)
    image = build(out)
    results: dict[str, dict[str, Table]] = {source: {} for source in SOURCES}

    def count(source: str, run: Run) -> Table:
        trace = record(recorder, out, source, run)
        table = replay(image, trace)
        trace.unlink()
        return table

    for source, runs in RUNS.items():
        for run in runs:
            results[source][run.name] = count(source, run)
    bare = results["observer"][BARE.name]["turning all"].worst
    scope = count("observer", SCOPED)["turning all"].worst - bare
    lines = rows_of(results)
    (out / "table.md").write_text("\n".join(lines) + "\n")
    (out / "figures.json").write_text(json.dumps(published(results)))
    print("\n".join(lines))
    print(f"\nthe scope, while it records: {scope}")
    print("every run the same on the Cortex-M3 as natively, bit for bit")
    complaints = over_budget(results) + wrong_charges(joined(results["observer"].values()), scope)
    for complaint in complaints:
        print(f"isr-cost: {complaint}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
