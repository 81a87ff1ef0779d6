#!/usr/bin/env python3
"""How many small changes of the drive's C the C++ tests notice.

Usage: toolchain/mutants.py [SAMPLE] [near] [seed=NUMBER] [PART...]

make mutants SAMPLE=20 does it for all parts. near: the part's own tests alone; seed: another draw.

Changes sources of the floors one token or statement at a time (toolchain/mutation/mutate.py), a drawn sample of SAMPLE
(or `all`) in every part. What does not compile, and what gives the object code of the original or of an earlier mutant
(-O2), is not a mutant. The others run the part's own tests, and where those pass, the tests above them; one that fails,
crashes or hangs has noticed. The working tree is not touched; all is in build/mutants, where verdicts are kept, so that
a run that was broken off goes on. The score, its 95 % interval and every survivor are written to
build/mutants/report.txt.
"""

import hashlib
import json
import math
import random
import shutil
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mutation.board import BUILD, FLOORS, ROOT, Board, code_of, compiled, linked, make_board, passes
from mutation.board import LEAST_TIME as LEAST
from mutation.mutate import Mutant, mutants

SEED = 2808
WORKERS = 2
VERDICTS = BUILD / "verdicts.jsonl"
REPORT = BUILD / "report.txt"
FIGURES = BUILD / "figures.json"
OF_PROGRAMS = ("survived", "unlinked")  # verdicts that hold for these programs alone
PATIENCE = 4.0  # times what a program takes without a mutant


@dataclass(frozen=True)
class Part:
    """Sources by patterns, and the programs that test them, the nearest first."""

    sources: tuple[str, ...]
    programs: tuple[str, ...]
    near: int = 1  # how many of the programs are the part's own
    without: frozenset[str] = frozenset()  # sources that these programs do not have

    @property
    def files(self) -> list[str]:
        """The sources, from the repository's root."""
        found = {path.relative_to(ROOT).as_posix() for pattern in self.sources for path in ROOT.glob(pattern)}
        return sorted(found - self.without)


FIRMWARE = ("firmware_test", "bench_run_test")
# The drivers on a bus that records, and on the virtual chip; firmware_test has a board of fakes instead.
DRIVERS = ("hal_drivers_test", "hal_on_chip_test", "hal_can_test", "bench_run_test")
# A header of firmware/ is in every source, those of hal/f2808/ are the map, which has a check of its own, and a few
# lines beside it: left out.
PARTS = {
    "hal/qmath": Part(("hal/qmath/*.c", "hal/qmath/*.h"), ("qmath_test", "control_test", "estimators_test")),
    "hal/f2808": Part(("hal/f2808/*.c", "hal/replay.c"), DRIVERS, 3, frozenset({"hal/f2808/flash.c"})),
    "control": Part(("control/*.c", "control/*.h"), ("control_test", "bench_run_test")),
    "svpwm": Part(("svpwm/*.c", "svpwm/*.h"), ("svpwm_test", "bench_run_test")),
    "estimators": Part(("estimators/*.c", "estimators/*.h"), ("estimators_test", "firmware_test", "bench_run_test")),
    # The states and what protects.
    "firmware": Part(
        (
            *("firmware/mode/*.c", "firmware/config/rules.c", "firmware/api/actions.c", "firmware/start/**/*.c"),
            *(f"firmware/drive/{name}.c" for name in ("control_interrupt", "schedule", "sampling", "protection")),
            *(
                f"firmware/drive/{name}.c"
                for name in ("sequence", "bumpless_transfer", "speed", "reset", "brake_release_hold", "polarity_watch")
            ),
            *("firmware/board/*.c", "firmware/commissioning/*.c"),
        ),
        FIRMWARE,
    ),
    # What else a period does.
    "firmware/period": Part(
        (
            *(f"firmware/drive/{name}.c" for name in ("position", "modulation", "inertia", "current", "signals")),
            *(
                "firmware/drive/reload.c",
                "firmware/sources/*/*.c",
                "firmware/hysteresis/*.c",
                "firmware/config/config.c",
            ),
            "firmware/boot/main.c",
            "firmware/boot/serve.c",
        ),
        FIRMWARE,
    ),
    "firmware/console": Part(
        (
            *("firmware/console/**/*.c", "firmware/text/*.c", "firmware/dictionary/*.c"),
            *("firmware/base/clear.c", "firmware/base/edition.c"),
        ),
        FIRMWARE,
    ),
    "firmware/link": Part(
        (
            *("firmware/link/*.c", "firmware/base/octets.c", "firmware/base/crc.c", "firmware/base/crc_block.c"),
            *("firmware/api/comm_watchdog.c", "firmware/api/status.c"),
            *("firmware/hil/*.c", "firmware/scope/*.c"),
        ),
        FIRMWARE,
    ),
    "firmware/can": Part(("firmware/can/*.c",), FIRMWARE),
    "firmware/store": Part(("firmware/store/*.c",), FIRMWARE),
    "firmware/flash_kernel": Part(("firmware/flash_kernel/*.c",), ("flash_kernel_test",)),
    "firmware/lamp": Part(("firmware/lamp/*.c",), ("lamp_test",)),
}


@dataclass
class Verdicts:
    """What was found out before, kept in a file."""

    known: dict[str, str] = field(default_factory=dict)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def load(self) -> None:
        """What an earlier run left; a last line that was cut off is ignored."""
        for line in VERDICTS.read_text(encoding="utf-8").splitlines() if VERDICTS.exists() else ():
            try:
                key, verdict = json.loads(line)
            except ValueError:
                continue
            self.known[key] = verdict

    def note(self, key: str, verdict: str) -> None:
        """Remembers one, at once."""
        with self.lock:
            self.known[key] = verdict
            with VERDICTS.open("a", encoding="utf-8") as out:
                out.write(json.dumps([key, verdict]) + "\n")


@dataclass
class Score:
    """What became of a part's mutants."""

    changes: int  # that there are in the part, drawn or not
    distinct: int = 0
    killed: dict[str, int] = field(default_factory=dict)  # by program
    survivors: list[Mutant] = field(default_factory=list)
    invalid: int = 0
    equal: int = 0

    @property
    def mutants(self) -> float:
        """How many distinct ones the part has, by the share of those that were drawn."""
        return self.changes * self.distinct / max(self.distinct + self.invalid + self.equal, 1)

    @property
    def share(self) -> float:
        """Of the distinct ones, those that were killed."""
        return sum(self.killed.values()) / max(self.distinct, 1)

    @property
    def variance(self) -> float:
        """Of the share, by two more killed and two more left (Agresti and Coull): of 60 killed of 60 it is not 0."""
        n = self.distinct + 4
        p = (sum(self.killed.values()) + 2) / n
        return p * (1 - p) / n

    def interval(self) -> tuple[float, float]:
        """Of the share at 95 %, in percent, by Wilson."""
        n = max(self.distinct, 1)
        p, z2 = sum(self.killed.values()) / n, 1.96**2
        middle, half = p + z2 / 2 / n, 1.96 * math.sqrt(p * (1 - p) / n + z2 / 4 / n / n)
        return 100 * (middle - half) / (1 + z2 / n), 100 * (middle + half) / (1 + z2 / n)

    def published(self) -> dict[str, Any]:
        """What the book's table is made of."""
        low, high = self.interval()
        return {"noticed": sum(self.killed.values()), "of": self.distinct, "low": low, "high": high}

    def line(self, name: str) -> str:
        """As printed."""
        killed, n = sum(self.killed.values()), max(self.distinct, 1)
        p, (low, high) = killed / n, self.interval()
        by = ", ".join(f"{program} {count}" for program, count in self.killed.items())
        dropped = f"{self.invalid} do not compile, {self.equal} change nothing"
        score = f"{killed:5d} / {self.distinct:5d} {100 * p:6.1f} %  [{low:.1f}, {high:.1f}]"
        return f"{name:21} {score}  {by}; {dropped}; some {self.mutants:.0f} in all"


def together(scores: list[Score]) -> dict[str, float]:
    """Parts together, each with the weight of its mutants; the draws are independent, so their variances add up."""
    every = max(sum(score.mutants for score in scores), 1.0)
    share = sum(score.mutants * score.share for score in scores) / every
    spread = sum((score.mutants / every) ** 2 * score.variance for score in scores)
    return {"percent": 100 * share, "plus_minus": 196 * math.sqrt(spread), "mutants": every}


def of_all(scores: list[Score]) -> str:
    """The same as printed."""
    name, of = "all" if len(scores) == len(PARTS) else f"these {len(scores)}", together(scores)
    return f"{name:21} {of['percent']:21.1f} %  +-{of['plus_minus']:.1f}  of some {of['mutants']:.0f} mutants"


class Run:
    """One run over parts."""

    def __init__(self, board: Board, near: bool, seed: int) -> None:
        """With the build of the unchanged tree; near: without the tests above a part; seed: of the draw."""
        self.board = board
        self.near = near
        self.seed = seed
        self.verdicts = Verdicts()
        self.verdicts.load()
        self.plain: dict[str, bytes] = {}  # object code of the original by source
        self.plain_lock = threading.Lock()
        self.text: dict[str, str] = {}

    def source(self, file: str) -> str:
        """A file's text when the run began."""
        return self.text.setdefault(file, (ROOT / file).read_text(encoding="utf-8"))

    def objects(self, mutant: Mutant, part: Part, place: Path) -> dict[str, Path] | None:
        """The objects that a mutant changes, by source; None where one does not compile."""
        source = self.source(mutant.file)
        made = {}
        is_header = mutant.file.endswith(".h")
        home = str(Path(mutant.file).parent)
        if is_header:
            (place / mutant.file).parent.mkdir(parents=True)
            (place / mutant.file).write_text(mutant.applied(source), encoding="utf-8")
        for use in self.board.uses(mutant.file):
            if is_header and not use.startswith((f"{home}/", f"tests/{Path(home).name}/")):
                continue
            out = place / (use.replace("/", "_") + ".o")
            text = None if is_header else mutant.applied(source)
            if not compiled(self.board, use, text, place, out):
                return None
            if code_of(out) != self.original(use):
                made[use] = out
        return made

    def original(self, source: str) -> bytes:
        """The object code of an unchanged source."""
        with self.plain_lock:
            if source not in self.plain:
                with tempfile.TemporaryDirectory(dir=BUILD) as name:
                    out = Path(name) / "plain.o"
                    text = self.source(source) if source.startswith(FLOORS) else None
                    if not compiled(self.board, source, text, Path(name), out):
                        raise SystemExit(f"mutants: {source} does not compile")
                    self.plain[source] = code_of(out)
            return self.plain[source]

    def key(self, mutant: Mutant) -> str:
        """Of the source as it is and of the change."""
        text = f"{mutant.file}\0{self.source(mutant.file)}\0{mutant.at}\0{mutant.end}\0{mutant.new}"
        return hashlib.sha256(text.encode()).hexdigest()

    def judge(self, mutant: Mutant, part: Part) -> str:
        """`invalid`, `equal`, `killed PROGRAM`; of these programs `survived` or `unlinked`, with what they are."""
        key = self.key(mutant)
        known = self.verdicts.known.get(key, "")
        programs = part.programs[: part.near] if self.near or mutant.file.endswith(".h") else part.programs
        state = hashlib.sha256("".join(self.board.programs[name].digest for name in programs).encode()).hexdigest()
        if known and (not known.startswith(OF_PROGRAMS) or known.endswith(f" {state}")):
            return known
        place = Path(tempfile.mkdtemp(dir=BUILD))
        try:
            verdict = self.run_in(mutant, part, programs, place)
        finally:
            shutil.rmtree(place)
        verdict = f"{verdict} {state}" if verdict in OF_PROGRAMS else verdict
        self.verdicts.note(key, verdict)
        return verdict

    def run_in(self, mutant: Mutant, part: Part, programs: tuple[str, ...], place: Path) -> str:
        """Compiles, links, runs."""
        changed = self.objects(mutant, part, place)
        if changed is None:
            return "invalid"
        if not changed:
            return "equal"
        links = False
        for name in programs:
            out = place / name
            if not linked(self.board, name, changed, out):
                continue  # a program without this source has not what it needs
            links = True
            if not passes(out, PATIENCE * self.board.programs[name].seconds + LEAST):
                return f"killed {name}"
        return "survived" if links else "unlinked"

    def part(self, name: str, sample: int | None) -> Score:
        """The score of a part."""
        part = PARTS[name]
        every = [mutant for file in part.files for mutant in mutants(file, self.source(file))]
        random.Random(self.seed).shuffle(every)
        score = Score(len(every))
        while every and (sample is None or score.distinct < sample):
            count = 64 if sample is None else max(sample - score.distinct, WORKERS)
            batch, every = every[:count], every[count:]
            with ThreadPoolExecutor(WORKERS) as pool:
                for mutant, verdict in zip(batch, pool.map(lambda m: self.judge(m, part), batch), strict=True):
                    count_in(score, mutant, verdict)
            print(score.line(name), flush=True)
        return score


def count_in(score: Score, mutant: Mutant, verdict: str) -> None:
    """Adds one mutant to a score."""
    if verdict == "equal":
        score.equal += 1
        return
    if verdict.startswith(("invalid", "unlinked")):
        score.invalid += 1
        return
    score.distinct += 1
    if verdict.startswith("survived"):
        score.survivors.append(mutant)
    else:
        by = verdict.partition(" ")[2]
        score.killed[by] = score.killed.get(by, 0) + 1


def main() -> int:
    """Draw, judge, print."""
    words = sys.argv[1:]
    sample = None if "all" in words else next((int(word) for word in words if word.isdigit()), 60)
    chosen = [word for word in words if word in PARTS] or list(PARTS)
    BUILD.mkdir(parents=True, exist_ok=True)
    near = "near" in words
    seed = next((int(word[5:]) for word in words if word.startswith("seed=")), SEED)
    programs = {name for part in chosen for name in PARTS[part].programs[: PARTS[part].near if near else None]}
    run = Run(make_board(sorted(programs)), near, seed)
    for program in run.board.programs.values():
        print(f"{program.name}: {program.seconds:.1f} s")
    lines, survivors, scores = [], [], []
    for name in chosen:
        score = run.part(name, sample)
        scores.append(score)
        lines.append(score.line(name))
        told = sorted(score.survivors, key=lambda m: (m.file, m.at))
        survivors += [mutant.told(run.source(mutant.file)) for mutant in told]
    lines.append(of_all(scores))
    REPORT.write_text("\n".join([*lines, "", "survivors:", *survivors]) + "\n", encoding="utf-8")
    found = {"all": together(scores), "parts": {name: s.published() for name, s in zip(chosen, scores, strict=True)}}
    FIGURES.write_text(json.dumps(found), encoding="utf-8")
    print("\n".join(["", *lines, f"survivors: {REPORT.relative_to(ROOT)}"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
