#!/usr/bin/env python3
"""Decision coverage of the drive's C by the C++ tests: lines, branches, and MC/DC of every condition.

Usage: toolchain/mcdc.py [--report]     (make mcdc; --report: of the last run's counts)

A clang of version 18 or newer compiles the drive's C in build/mcdc, and every C++ test runs on it. A condition counts
as covered when the tests have shown that it alone decides (masking MC/DC, as clang counts it); where it is the only
one of its decision, when it was true and false. toolchain/mcdc_unreachable.txt lists the conditions that no input can
make so, each with the reason. Failures: any other condition that is not covered, and an entry of the list that is
covered or does not exist. The table and all uncovered conditions are written to build/mcdc/report.txt.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "mcdc"
UNREACHABLE = ROOT / "toolchain" / "mcdc_unreachable.txt"
FLOORS = ("hal", "control", "svpwm", "estimators", "firmware")
OLDEST = 18  # clang
PROGRAM = re.compile(r"\w+_test(_[a-z]+)?")
# Places in an entry of llvm-cov's export.
TRUE, FALSE, FILE, KIND = 4, 5, 6, 8
OF_SEVERAL = 6  # the kind of a branch whose decision has several conditions
CONDITIONS = 9

Span = tuple[int, int, int, int]  # first line and column, line and column behind the last


@dataclass
class Condition:
    """A condition in the source: how often true and false, and whether it was seen to decide."""

    file: str
    span: Span
    function: str
    several: bool  # its decision has more than this one
    true: int = 0
    false: int = 0
    decides: bool = False
    name: str = ""

    @property
    def covered(self) -> bool:
        """By MC/DC."""
        return self.decides if self.several else self.true > 0 and self.false > 0

    @property
    def lack(self) -> str:
        """What was not seen."""
        if self.true == 0 and self.false == 0:
            return "never reached"
        if self.true == 0 or self.false == 0:
            return "never true" if self.true == 0 else "never false"
        return "never alone decides"


@dataclass
class Folder:
    """The sums of a folder."""

    lines: int = 0
    lines_run: int = 0
    conditions: list[Condition] = field(default_factory=list)
    listed: int = 0

    @property
    def uncovered(self) -> list[Condition]:
        """In the order of the source."""
        return sorted((c for c in self.conditions if not c.covered), key=lambda c: (c.file, c.span))


def tools() -> tuple[str, str, str, Path]:
    """clang, llvm-profdata, llvm-cov and the runtime that writes the counts."""
    found = subprocess.run(["bash", "toolchain/find-clang.sh"], cwd=ROOT, capture_output=True, text=True, check=False)
    clang = found.stdout.strip()
    suffix = clang.removeprefix("clang")
    said = subprocess.run([clang or "false", "--version"], capture_output=True, text=True, check=False).stdout
    version = re.search(r"version (\d+)", said)
    if version is None or int(version.group(1)) < OLDEST:
        raise SystemExit(f"mcdc: needs clang {OLDEST} or newer, there is {clang or 'none'}")
    number = version.group(1)
    profdata, cov = f"llvm-profdata{suffix}", f"llvm-cov{suffix}"
    if shutil.which(profdata) is None or shutil.which(cov) is None:
        raise SystemExit(f"mcdc: no {cov}; run once: sudo apt-get install llvm-{number}")
    where = subprocess.run([clang, "--print-resource-dir"], capture_output=True, text=True, check=True).stdout.strip()
    runtime = next(Path(where).rglob(f"libclang_rt.profile*{os.uname().machine}.a"), None)
    runtime = runtime or next(Path(where).rglob("libclang_rt.profile.a"), None)
    if runtime is None:
        raise SystemExit(
            f"mcdc: {clang} has no profile runtime; run once: sudo apt-get install libclang-rt-{number}-dev"
        )
    return clang, profdata, cov, runtime


def quiet(command: list[str], log: Path) -> None:
    """Runs a command whose words matter only when it fails."""
    with log.open("w", encoding="utf-8") as out:
        done = subprocess.run(command, cwd=ROOT, stdout=out, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        raise SystemExit(f"mcdc: {' '.join(command)}\n{log.read_text(encoding='utf-8')[-4000:]}")


def open_mp() -> list[str]:
    """SUNDIALS asks for OpenMP in C, which the plant has no use for, and a clang without its own is given GCC's."""
    where = subprocess.run(["gcc", "-print-file-name=libgomp.so"], capture_output=True, text=True, check=True)
    library = f"-DOpenMP_gomp_LIBRARY={where.stdout.strip()}"
    return ["-DOpenMP_C_FLAGS=-fopenmp=libgomp", "-DOpenMP_C_LIB_NAMES=gomp", library]


def run_tests(clang: str, profdata: str, runtime: Path) -> None:
    """Builds, runs every C++ test, merges the counts. A test that fails is a failure here too."""
    BUILD.mkdir(parents=True, exist_ok=True)
    link = f"-Wl,-u,__llvm_profile_runtime {runtime}"
    chosen = [f"-DCMAKE_C_COMPILER={clang}", f"-DCMAKE_EXE_LINKER_FLAGS={link}"]
    quiet(["cmake", "--preset", "mcdc", *chosen, *open_mp()], BUILD / "configure.log")
    raw = BUILD / "raw"
    shutil.rmtree(raw, ignore_errors=True)
    os.environ["LLVM_PROFILE_FILE"] = str(BUILD / "discovery.profraw")  # the build lists the tests
    jobs = str(os.cpu_count())
    quiet(["cmake", "--build", "--preset", "mcdc", "--parallel", jobs], BUILD / "build.log")
    # Whole programs, not case by case as ctest runs them: each end writes all counts.
    os.environ["LLVM_PROFILE_FILE"] = str(raw / "%p.profraw")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = [pool.submit(quiet, [str(path), "--gtest_brief=1"], BUILD / f"{path.name}.log") for path in programs()]
        for run in runs:
            run.result()
    counts = sorted(str(path) for path in raw.glob("*.profraw"))
    quiet([profdata, "merge", "-sparse", "-o", str(BUILD / "counts.profdata"), *counts], BUILD / "merge.log")


def programs() -> list[Path]:
    """The test programs, those of other editions among them."""
    found = (path for path in (BUILD / "tests").rglob("*_test*") if PROGRAM.fullmatch(path.name))
    return sorted(path for path in found if path.is_file() and os.access(path, os.X_OK))


def export(cov: str) -> dict[str, Any]:
    """What the tests did, as llvm-cov says it."""
    first, *others = programs()
    objects = [word for other in others for word in ("-object", str(other))]
    command = [cov, "export", "-format=text", f"-instr-profile={BUILD / 'counts.profdata'}", str(first), *objects]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"mcdc: {done.stderr}")
    data: dict[str, Any] = json.loads(done.stdout)["data"][0]
    return data


def inside(name: str) -> str | None:
    """A file of the floors, from the repository's root; None for any other."""
    path = Path(name)
    if not path.is_relative_to(ROOT):
        return None
    relative = path.relative_to(ROOT)
    return relative.as_posix() if relative.parts[0] in FLOORS else None


def within(inner: Span, outer: Span) -> bool:
    """Whether one span lies in another."""
    return outer[:2] <= inner[:2] and inner[2:] <= outer[2:]


class Source:
    """The conditions of all functions; a function in a header stands once, however often it is compiled."""

    def __init__(self) -> None:
        """Empty."""
        self.found: dict[tuple[str, Span], Condition] = {}

    def add(self, function: dict[str, Any]) -> None:
        """One compiled function."""
        files = [inside(name) for name in function["filenames"]]
        name = function["name"].rpartition(":")[2]
        several: dict[int, list[Span]] = defaultdict(list)
        for branch in function["branches"]:
            file = files[branch[FILE]]
            if file is None:
                continue
            span: Span = (branch[0], branch[1], branch[2], branch[3])
            of_several = branch[KIND] == OF_SEVERAL
            condition = self.found.setdefault((file, span), Condition(file, span, name, of_several))
            condition.true += branch[TRUE]
            condition.false += branch[FALSE]
            if of_several:
                several[branch[FILE]].append(span)
        # The innermost decisions first: what is theirs is not a condition of those around them.
        for record in sorted(function["mcdc_records"], key=lambda r: (r[2] - r[0], r[3] - r[1])):
            self.decide(record, files[record[FILE]], several[record[FILE]])

    def decide(self, record: list[Any], file: str | None, spans: list[Span]) -> None:
        """The conditions of one decision, in the order of the source."""
        if file is None:
            return
        decision: Span = (record[0], record[1], record[2], record[3])
        own = sorted(span for span in spans if within(span, decision))
        if len(own) != len(record[CONDITIONS]):
            raise SystemExit(f"mcdc: {file}:{decision[0]}: {len(record[CONDITIONS])} conditions, {len(own)} places")
        for span, covered in zip(own, record[CONDITIONS], strict=True):
            self.found[file, span].decides |= bool(covered)
            spans.remove(span)

    def conditions(self) -> list[Condition]:
        """All, each with a name that is its own within its function: the text, and its number when it comes again."""
        texts: dict[str, list[str]] = {}
        seen: Counter[tuple[str, str, str]] = Counter()
        for condition in sorted(self.found.values(), key=lambda c: (c.file, c.span)):
            lines = texts.setdefault(condition.file, (ROOT / condition.file).read_text("utf-8").splitlines())
            text = text_of(lines, condition.span)
            seen[condition.file, condition.function, text] += 1
            again = seen[condition.file, condition.function, text]
            condition.name = text if again == 1 else f"{text} #{again}"
        return list(self.found.values())


def text_of(lines: list[str], span: Span) -> str:
    """A piece of the source on one line."""
    first, start, last, end = span
    if first == last:
        piece = lines[first - 1][start - 1 : end - 1]
    else:
        piece = " ".join([lines[first - 1][start - 1 :], *lines[first : last - 1], lines[last - 1][: end - 1]])
    return " ".join(piece.split())


def rows(path: Path) -> list[list[str]]:
    """The lines of a table in the repository, without comments."""
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    return [[cell.strip() for cell in line.split(" | ")] for line in lines if line and not line.startswith("#")]


def take_out_unreachable(conditions: list[Condition]) -> tuple[list[Condition], Counter[str], list[str]]:
    """The conditions that are left, how many are listed by folder, and what is wrong with the list."""
    by_key = {(c.file, c.function, c.name): c for c in conditions}
    listed: Counter[str] = Counter()
    wrong = []
    for file, function, name, _reason in rows(UNREACHABLE):
        condition = by_key.pop((file, function, name), None)
        where = f"{UNREACHABLE.name}: {file}, {function}: {name}"
        if condition is None:
            wrong.append(f"{where}: there is no such condition")
        elif condition.covered:
            wrong.append(f"{where}: is covered")
        else:
            listed[Path(file).parent.as_posix()] += 1
    return list(by_key.values()), listed, wrong


def by_folder(data: dict[str, Any]) -> tuple[dict[str, Folder], list[str]]:
    """The sums, and what is wrong with the list of what cannot be reached."""
    source = Source()
    for function in data["functions"]:
        source.add(function)
    conditions, listed, wrong = take_out_unreachable(source.conditions())
    folders: dict[str, Folder] = defaultdict(Folder)
    for file in data["files"]:
        name = inside(file["filename"])
        if name is not None:
            folder = folders[Path(name).parent.as_posix()]
            folder.lines += file["summary"]["lines"]["count"]
            folder.lines_run += file["summary"]["lines"]["covered"]
    for condition in conditions:
        folders[Path(condition.file).parent.as_posix()].conditions.append(condition)
    for name, count in listed.items():
        folders[name].listed = count
    return dict(sorted(folders.items())), wrong


def share(part: int, whole: int) -> str:
    """As `12 / 13  92.3 %`."""
    return f"{part:5d} / {whole:5d} {100.0 * part / max(whole, 1):6.1f} %"


def table(folders: dict[str, Folder]) -> Iterable[str]:
    """The published table."""
    yield f"{'folder':24} {'lines':>22} {'branches':>22} {'conditions (MC/DC)':>22}  unreachable"
    for name, folder in folders.items():
        every = folder.conditions
        branches = sum((c.true > 0) + (c.false > 0) for c in every)
        covered = sum(c.covered for c in every)
        sums = f"{share(folder.lines_run, folder.lines)} {share(branches, 2 * len(every))} {share(covered, len(every))}"
        yield f"{name:24} {sums} {folder.listed:12d}"


def main() -> int:
    """Run, read, print."""
    clang, profdata, cov, runtime = tools()
    if "--report" not in sys.argv:
        run_tests(clang, profdata, runtime)
    folders, complaints = by_folder(export(cov))
    lines = list(table(folders))
    print("\n".join(lines))
    uncovered = [
        f"{c.file}:{c.span[0]}:{c.span[1]} {c.function}: {c.name}: {c.lack}"
        for folder in folders.values()
        for c in folder.uncovered
    ]
    lines += ["", "uncovered:", *uncovered]
    (BUILD / "report.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    counts = {
        name: {"conditions": len(f.conditions), "uncovered": len(f.uncovered), "unreachable": f.listed}
        for name, f in folders.items()
    }
    (BUILD / "figures.json").write_text(json.dumps(counts), encoding="utf-8")
    complaints += uncovered
    for complaint in complaints:
        print(f"mcdc: {complaint}")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
