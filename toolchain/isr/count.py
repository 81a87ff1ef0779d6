#!/usr/bin/env python3
"""What the interrupts cost on the chip, in expected cycles: the image's program, its instructions counted in QEMU.

Usage: toolchain/isr/count.py RECORDERS IMAGES OUT     (make isr-cost)

IMAGES has, or gets, the build of the editions' images by the stand-in for cl2000. Runs of the virtual drive (runs.py)
are recorded natively at the drive's register accesses and replayed on an emulated Cortex-M3 that runs what the image is
made of (program.py). A replay that does anything else than the native run, a period that is longer than
toolchain/isr/limits.txt allows, and a function of the compiler's library that is not there to copy are failures. What
is beyond its goal is said to be short. The tables are printed; the counts of the edition that has all go to
OUT/figures.json, what those of each come to to OUT/budget.json.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from costs import costs  # noqa: E402
from image import check  # noqa: E402

from isr import counts, hot, program, runs  # noqa: E402
from isr.counts import ALL, PHASES, STEPS, WINDOW, Counts  # noqa: E402
from isr.program import Program  # noqa: E402
from isr.runs import Run  # noqa: E402

ROOT = HERE.parents[1]
LIMITS = HERE / "limits.txt"
CHARGES = ROOT / "firmware" / "interfaces" / "isr_cycles.h"
# What the virtual chip lets pass for a step.
CHARGED = {
    "CYCLES_READ_SAMPLES": "samples",
    "CYCLES_ESTIMATE": "estimate",
    "CYCLES_SUPERVISE": "supervise",
    "CYCLES_CONTROL": "control",
    "CYCLES_MODULATE": "modulate",
    "CYCLES_WINDOW": WINDOW,
}
# Copying and filling memory is all that the compiler may call by itself: no float, no 64-bit division, no mathematics.
COPIES = re.compile(r"_?_?(aeabi_)?mem(cpy|set|move|clr)\w*")

Scheme = dict[str, Counts]  # by run


def write_regions(made: Program, cycles: Mapping[str, Any], file: Path) -> None:
    """What the plugin is told: where each function is, and what an instruction of it costs."""
    lines = [
        f"{each.start:x} {each.start + each.size:x} {round(100 * cycles['ram' if each.in_ram else 'flash'])}"
        for each in made.functions
    ]
    lines += [f"mark {name} {address:x}" for name, address in made.marks.items()]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def replay(made: Program, trace: Path, entry: int, what: str) -> Counts:
    """The counts of one run; an error where it is not the native one."""
    regions, counted = made.image.with_suffix(".regions"), trace.with_suffix(".counts")
    semihosting = f"enable=on,target=native,arg=replay,arg={trace}"
    plugin = f"file={made.plugin},regions={regions},entry={entry},out={counted}"
    machine = ("-M", "mps2-an385", "-nographic", "-monitor", "none", "-serial", "none", "-display", "none")
    command = [program.EMULATOR, *machine, "-semihosting-config", semihosting, "-kernel", made.image, "-plugin", plugin]
    run = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    if run.returncode != 0:
        raise SystemExit(f"isr-cost: {what}: {run.stdout}{run.stderr}")
    found = counts.read(counted)
    counted.unlink()
    return found


def record(recorder: Path, trace: Path, source: str, run: Run) -> None:
    """Records one run natively."""
    numbers = (str(number) for number in (run.rpm, run.load, run.shaft))
    subprocess.run([recorder, trace, *numbers, *runs.SOURCES[source], *run.words], check=True)


def counted(recorder: Path, made: Program, edition: str, source: str) -> Scheme:
    """All runs of a scheme, two at a time."""
    entry = costs(ROOT)["cycles"]["interrupt_entry"]

    def one(numbered: tuple[int, Run]) -> Counts:
        number, run = numbered
        trace = made.image.with_name(f"{number}.trace")
        record(recorder, trace, source, run)
        found = replay(made, trace, entry, f"{edition}, {source}, {run.name}")
        trace.unlink()
        return found

    own = runs.of(edition, source)
    with ThreadPoolExecutor(2) as pool:
        return dict(zip((run.name for run in own), pool.map(one, enumerate(own)), strict=True))


def whole(schemes: Mapping[str, Scheme]) -> Counts:
    """All runs of all schemes as one."""
    return counts.joined(each for scheme in schemes.values() for each in scheme.values())


def budget(schemes: Mapping[str, Scheme], cycles: Mapping[str, Any]) -> dict[str, Any]:
    """Of one edition: what its longest period takes, and what the mean one of a drive that turns."""

    def of(runs_of: Scheme) -> dict[str, Any]:
        total = counts.joined(runs_of.values())
        return {
            "worst_cycles_expected": round(total.worst),
            "worst_cycles_p90": round(total.worst * cycles["p90"]),
            "mean_cycles_expected": round(total.of(ALL, ("turning",)).mean_cycles),
        }

    named = {f"{source}, {name}": each for source, scheme in schemes.items() for name, each in scheme.items()}
    return {
        **of(named),
        "by_source": {source: of(scheme) for source, scheme in schemes.items()},
        "by_scenario": {
            name: {"worst": round(each.worst), "mean": round(each.of(ALL).mean_cycles)} for name, each in named.items()
        },
    }


def steps_of(total: Counts) -> dict[str, Any]:
    """Mean and worst, cycles and instructions: of each step while the drive starts or turns, of all in each phase."""
    rows = {step: total.of(step, ("starting", "turning")) for step in (*STEPS, WINDOW)} | {ALL: total.of(ALL)}
    rows |= {f"{phase} {ALL}": total.of(ALL, (phase,)) for phase in PHASES if total.of(ALL, (phase,)).count}
    return {
        name: {
            "mean": round(cost.mean_cycles),
            "worst": round(cost.worst_cycles),
            "mean_instructions": round(cost.instructions / max(cost.count, 1)),
            "worst_instructions": cost.worst_instructions,
        }
        for name, cost in rows.items()
    }


def functions_of(made: Program, total: Counts, cycles: Mapping[str, Any], words: float) -> list[dict[str, Any]]:
    """Every function that interrupts run, the dearest in the longest period first; cycles of a period."""
    _, longest = total.longest_period()
    periods = max(total.of(ALL, ("turning",)).count, 1)
    rows = []
    for place in sorted(set().union(*total.ran.values())):
        each = made.functions[place]
        cost = cycles["ram" if each.in_ram else "flash"]
        rows.append(
            {
                "function": each.name,
                "file": each.file,
                "in": "RAM" if each.in_ram else "flash",
                "words": round(words * each.size / 2),
                "longest": round(cost * longest.get(place, 0)),
                "mean": round(cost * total.ran.get("turning", {}).get(place, 0) / periods),
            }
        )
    return sorted(rows, key=lambda row: (-row["longest"], -row["mean"], row["function"]))


def figures_of(made: Program, schemes: Mapping[str, Scheme]) -> dict[str, Any]:
    """What the book's tables of an edition are made of."""
    known = costs(ROOT)
    default = counts.joined(schemes[runs.DEFAULT].values())
    return {
        "sources": {
            source: {
                "steps": steps_of(counts.joined(scheme.values())),
                "runs": {name: steps_of(each)[ALL] for name, each in scheme.items()},
            }
            for source, scheme in schemes.items()
        },
        "longest_in": default.longest_period()[0],
        "functions": functions_of(made, default, known["cycles"], known["words"]["expected"]),
    }


def table(head: str, rows: Mapping[str, Mapping[str, Any]], columns: Iterable[str]) -> list[str]:
    """For people in front of a terminal."""
    columns = tuple(columns)
    lines = [f"{head:34}" + "".join(f"{column.replace('_', ' '):>20}" for column in columns)]
    return lines + [f"{name:34}" + "".join(f"{row[column]:>20}" for column in columns) for name, row in rows.items()]


def limits() -> list[tuple[str, str, int, int]]:
    """Edition, scheme, goal, limit, both in expected cycles of the longest period."""
    rows = [line.partition("#")[0].split("|") for line in LIMITS.read_text(encoding="utf-8").splitlines()]
    fields = [[field.strip() for field in row] for row in rows if len(row) == 4]
    return [(edition, source, int(goal), int(limit)) for edition, source, goal, limit in fields]


def judged(budgets: Mapping[str, Any], period: int) -> tuple[list[str], list[str]]:
    """What is longer than its goal, and what is longer than its limit."""
    short, beyond = [], []
    for edition, source, goal, limit in limits():
        if edition not in budgets:
            continue
        worst = budgets[edition]["by_source"][source]["worst_cycles_expected"]
        what = f"{edition}, {source}: {worst} cycles, {100 * worst / period:.0f} % of the period"
        if worst > goal:
            short.append(f"{what}, goal {goal}")
        if worst > limit:
            beyond.append(f"{what}, limit {limit}")
    return short, beyond


def charges(total: Counts, scope: float) -> list[str]:
    """What the virtual chip lets pass and is less than what is expected. `scope`: cycles of it."""
    text = CHARGES.read_text(encoding="utf-8")
    expected = {name: total.of(step, ("turning",)).worst_cycles for name, step in CHARGED.items()}
    found = {name: re.search(rf"#define {name} (\d+)u", text) for name in (*CHARGED, "CYCLES_SCOPE")}
    charged = {name: int(match[1]) if match else 0 for name, match in found.items()}
    return [
        f"{CHARGES.name}: {name} lets {charged[name]} cycles pass, {cycles:.0f} are expected"
        for name, cycles in (expected | {"CYCLES_SCOPE": scope}).items()
        if charged[name] < cycles
    ]


def called(made: Program, total: Counts) -> list[str]:
    """What of the compiler's library interrupts have called."""
    ran = set().union(*total.ran.values())
    library = sorted({made.functions[place].name for place in ran if not made.functions[place].file})
    return [f"an interrupt calls {name}" for name in library if not COPIES.fullmatch(name)]


def main() -> int:
    """Build, record, replay, print."""
    recorders, images, out = (Path(word).resolve() for word in sys.argv[1:4])
    if missing := program.missing_tools():
        print(f"isr-cost: not installed: {' '.join(missing)}; run once: sudo apt-get install {' '.join(missing)}")
        return 1
    cycles = costs(ROOT)["cycles"]
    figures, budgets = {}, {}
    check.configure(images / "build")
    with suppress(subprocess.CalledProcessError):  # what is wrong with the images is the images' business
        check.build(images / "build")
    objects = program.make(images / "build", out)
    short: list[str] = []
    complaints: list[str] = []
    for edition, sources in runs.EDITIONS.items():
        made = program.link(objects, edition, out / edition)
        write_regions(made, cycles, made.image.with_suffix(".regions"))
        recorder = recorders / f"stillspin_isr_record_{edition}"
        schemes = {source: counted(recorder, made, edition, source) for source in sources}
        own, budgets[edition] = figures_of(made, schemes), budget(schemes, cycles)
        default = schemes[runs.DEFAULT]
        if edition == check.WHOLE:
            figures[edition] = own
            scope = default[runs.SCOPED.name].worst - default[runs.BARE.name].worst
            short += charges(counts.joined(default.values()), scope)
            short += hot.cold(made.functions, set().union(*whole(schemes).ran.values()))
        if edition == hot.EDITION:
            short += hot.hotter(own["functions"])
        complaints += called(made, whole(schemes))
        for source in sources:
            columns = ("mean", "worst", "mean_instructions", "worst_instructions")
            print("\n".join(table(f"{edition}, {source}", own["sources"][source]["steps"], columns)))
            print("\n".join(table("at rpm", own["sources"][source]["runs"], columns)), flush=True)
        dearest = {f"{row['function']}, {row['file'].rpartition('/')[2]}": row for row in own["functions"]}
        shown = dict(list(dearest.items())[:30])
        print("\n".join(table(f"longest period, {own['longest_in']}", shown, ("longest", "mean", "in"))))
    found = {"period_cycles": cycles["period"], "editions": budgets}
    (out / "budget.json").write_text(json.dumps(found, indent=1), encoding="utf-8")
    goals = [{"edition": edition, "source": source, "goal": goal} for edition, source, goal, _ in limits()]
    (out / "figures.json").write_text(json.dumps({**found, "goals": goals, "details": figures}), encoding="utf-8")
    print("every run the same on the Cortex-M3 as natively, bit for bit")
    judgement = judged(budgets, cycles["period"])
    for line in (*short, *judgement[0]):
        print(f"isr-cost: short: {line}")
    for line in (*complaints, *judgement[1]):
        print(f"isr-cost: {line}")
    return 1 if complaints or judgement[1] else 0


if __name__ == "__main__":
    sys.exit(main())
