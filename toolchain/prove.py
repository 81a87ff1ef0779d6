#!/usr/bin/env python3
"""Absence of run-time errors with a 16-bit int, by Frama-C: EVA over the drive's C, WP for the arithmetic's contracts.

Usage: toolchain/prove.py OUT [--defects] [PART ...]     (make prove)

Every part (toolchain/proof/parts.py) has a driver in tests/prove/ that calls the drive's functions with any input that
their headers admit. EVA follows all of that at once, with intervals, and reports an alarm wherever it cannot exclude
an undefined operation: overflow of a signed number, division by zero, a shift, an index or a pointer that is out of
range, a value that was never set. WP proves contracts of tests/prove/, function by function. What neither excludes
stands in tests/prove/alarms.txt, by part, function and kind: more than that is an error. With --defects, those
of toolchain/proof/defects.py are planted into a copy of the sources, and each has to be found in the function where it
is. What was read of a part is kept in OUT/kept as long as nothing changes that it was read from.
"""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path
from subprocess import PIPE, STDOUT

import compose
import planted
from proof import kept
from proof.defects import DEFECTS
from proof.part import Part
from proof.parts import LONGEST, PARTS, PROVED, SHOWN_ELSEWHERE
from proof.shown import Shown

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware", "tests/prove")
MADE = "made"
KEPT = "kept"
ASK_THE_EDITION = {"firmware/dictionary/parameters.c", "firmware/drive/signals.c", "firmware/text/catalogue.c"}
KNOWN = "tests/prove/alarms.txt"
SECONDS = 1500
FALSE_SHARE = 4  # of a goal's time: still some ten times what is true of the planted functions takes
AT_ONCE = 2
OPEN = ("Unknown", "Invalid", "Inconsistent", "Never tried")

Alarm = tuple[str, str]  # function, kind


@dataclass(frozen=True)
class Read:
    """What a part's reading leaves open, and how much of the code it has been through or proved."""

    alarms: Counter[Alarm]
    words: str
    seconds: float


def sources_of(part: Part, tree: Path, out: Path) -> list[str]:
    """Its files: those of the tree, those that the build makes, and with the texts their table."""
    found = [path.relative_to(tree).as_posix() for pattern in part.sources for path in sorted(tree.glob(pattern))]
    made = [name for name in part.sources if name.startswith(f"{MADE}/")]
    made += [f"{MADE}/{compose.TEXTS}"] if "firmware/text/packed_text.c" in found else []
    if ASK_THE_EDITION & set(found):
        found.append("firmware/base/edition.c")
        made.append(f"{MADE}/left_out.c")
    return [*found, *(str(out / name) for name in made)]


def summary(part: Part, rows: list[dict[str, str]], said: str) -> str:
    """How much was read or proved."""
    reached = re.search(r"(\d+) functions analyzed.*?(\d+) statements reached \(out of (\d+)\)", said, re.DOTALL)
    if reached:
        return f"{reached[1]} functions, {reached[2]} of {reached[3]} statements reached"
    proved = sum(row["status"].startswith("Valid") for row in rows)
    return f"{len(part.proved)} functions, {proved} properties proved"


def plain(function: str) -> str:
    """The copies of an inline function, one for each file, are one function; so is what they need."""
    return re.sub(r"_\d+$", "", function)


def is_open(part: Part, row: dict[str, str]) -> bool:
    """Whether that is left open.

    What a function needs is shown where it is called, what it promises where it is read by itself or where WP proves
    it; EVA does not try what it does not reach, and WP nothing but what it is to prove.
    """
    status, kind, function = row["status"], row["property kind"], plain(row["function"])
    if kind == "precondition" or not status.startswith(OPEN) or status.endswith("dead"):
        return False
    if part.proved:
        return function in part.proved
    related = kind.startswith("precondition of ") and function in part.related
    given = bool(part.given) and function in (*part.given.split(","), *SHOWN_ELSEWHERE)
    promised = kind == "postcondition" and (given or function in PROVED)
    return not related and not promised and status != "Never tried"


def options_of(part: Part, out: Path) -> list[str]:
    """Those of the preprocessor."""
    return ["-I.", f"-I{out / MADE}", "-std=c99", *(word for name in part.headers for word in ("-include", name))]


def command_of(part: Part, sources: list[str], out: Path) -> list[str]:
    """How Frama-C is called to read a part."""
    machine = ("-machdep", "gcc_x86_16", f"-cpp-extra-args={' '.join(options_of(part, out))}")
    given = ("-eva-use-spec", part.given) if part.given else ()
    named = ("-wp-fct", ",".join(part.proved)) if part.proved else ()
    table = out / f"{part.name}.csv"
    return ["frama-c", *machine, *sources, *part.flags, *given, *named, "-then", "-report-csv", str(table)]


def read_or_kept(part: Part, out: Path) -> Read:
    """What was read of the drive's part before, if that still holds; otherwise it is read, and kept."""
    sources = sources_of(part, ROOT, out)
    key = kept.key_of(command_of(part, sources, out), sources, options_of(part, out), ROOT, out)
    known_of = kept.load(out / KEPT, part.name, key)
    if known_of is not None:
        alarms = Counter({(function, kind): count for function, kind, count in known_of["alarms"]})
        return Read(alarms, known_of["words"], 0)
    done = read(part, ROOT, out)
    rows = [[function, kind, count] for (function, kind), count in sorted(done.alarms.items())]
    kept.save(out / KEPT, part.name, key, {"alarms": rows, "words": done.words})
    return done


def read(part: Part, tree: Path, out: Path, defective: Collection[str] = ()) -> Read:
    """Lets Frama-C read a part; with defective functions no further than until each of them has shown itself."""
    table, log = out / f"{part.name}.csv", out / f"{part.name}.log"
    sources = sources_of(part, tree, out)
    command = command_of(part, sources, out)
    begin = time.monotonic()
    headers = [path.relative_to(tree).as_posix() for folder in FOLDERS for path in (tree / folder).rglob("*.h")]
    own = [file for file in sources if not Path(file).is_absolute()]
    if not says_all(command, tree, log, Shown(tree, {*own, *headers}, defective)):
        return Read(Counter((function, "shown") for function in defective), "", time.monotonic() - begin)
    with table.open(encoding="utf-8", newline="") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t", quoting=csv.QUOTE_NONE))
    alarms = Counter((plain(row["function"]), plain(row["property kind"])) for row in rows if is_open(part, row))
    proved = {plain(row["function"]) for row in rows if row["status"].startswith("Valid")}
    alarms.update((function, "nothing proved") for function in part.proved if function not in proved)
    return Read(alarms, summary(part, rows, log.read_text(encoding="utf-8")), time.monotonic() - begin)


def says_all(command: list[str], tree: Path, log: Path, shown: Shown) -> bool:
    """Runs Frama-C; False where it was ended because what it had said was enough. RuntimeError where it fails."""
    # It believes PWD more than where it is.
    home = {**os.environ, "PWD": str(tree), "WHY3CONFIG": str(log.parent / "why3.conf")}
    timed = ["timeout", str(SECONDS), *command]
    with (
        log.open("w", encoding="utf-8") as kept,
        subprocess.Popen(
            timed, cwd=tree, env=home, stdout=PIPE, stderr=STDOUT, text=True, start_new_session=True
        ) as run,
    ):
        for line in run.stdout or ():
            kept.write(line)
            if shown.is_complete_with(line):
                os.killpg(run.pid, signal.SIGTERM)
                return False
    if run.returncode != 0:
        raise RuntimeError(f"frama-c fails with {run.returncode}, see {log}: {log.read_text(encoding='utf-8')[-1500:]}")
    return True


def known() -> dict[str, Counter[Alarm]]:
    """The alarms that are known, by part."""
    found: dict[str, Counter[Alarm]] = {part.name: Counter() for part in PARTS}
    for line in (ROOT / KNOWN).read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words:
            found[words[0]][words[1], " ".join(words[2:-1])] = int(words[-1])
    return found


def more_than(alarms: Counter[Alarm], bound: Counter[Alarm]) -> dict[Alarm, int]:
    """What there is more of than is known."""
    return {alarm: count for alarm, count in sorted(alarms.items()) if count > bound[alarm]}


def at_once(work: Callable[[Part], Read], parts: list[Part]) -> Iterator[tuple[Part, Read | RuntimeError]]:
    """The parts' readings, two at a time, or why one could not be read."""
    ordered = sorted(parts, key=lambda part: part.name not in LONGEST)

    def tried(part: Part) -> Read | RuntimeError:
        try:
            return work(part)
        except RuntimeError as error:
            return error

    with ThreadPoolExecutor(AT_ONCE) as pool:
        begun = {pool.submit(tried, part): part for part in ordered}
        yield from ((begun[ended], ended.result()) for ended in as_completed(begun))


def check(out: Path, wanted: list[str]) -> int:
    """Reads the parts; prints a line for each, and what is new. Of all of them, the book's table goes to OUT."""
    status, bounds, rows = 0, known(), []
    parts = [part for part in PARTS if not wanted or part.name in wanted]
    for part, done in at_once(lambda part: read_or_kept(part, out), parts):
        if isinstance(done, RuntimeError):
            status = 1
            print(f"prove: {part.name}: {done}", flush=True)
            continue
        bound = bounds[part.name]
        rows.append({"part": part.name, "words": done.words, "open": done.alarms.total()})
        left = f"{done.alarms.total()} left open ({bound.total()} known)"
        spent = f"{done.seconds:.0f} s" if done.seconds else "as read before"
        print(f"prove: {part.name}: {done.words}, {left}, {spent}", flush=True)
        for (function, kind), count in more_than(done.alarms, bound).items():
            status = 1
            print(f"{part.name} {function} {kind} {count}  # known are {bound[function, kind]}")
    if len(rows) == len(PARTS):
        rows.sort(key=lambda row: str(row["part"]))
        (out / "figures.json").write_text(json.dumps(rows), encoding="utf-8")
    return status


def of_these(part: Part, functions: tuple[str, ...]) -> Part:
    """A proof of some of its functions alone. What is not true is tried until the time is over, so there is less."""
    seconds = int(part.flags[part.flags.index("-wp-timeout") + 1]) // FALSE_SHARE
    return replace(part, proved=functions, flags=(*part.flags, "-wp-timeout", str(seconds)))


def plant(out: Path, wanted: list[str]) -> int:
    """Plants the defects, those of a part together, and looks where they show."""
    complaints, bounds = [], known()
    defects = {part.name: [d for d in DEFECTS if d.part == part.name] for part in PARTS}
    parts = [part for part in PARTS if defects[part.name] and (not wanted or part.name in wanted)]
    for part in parts:
        changes = [(d.file, d.right, d.wrong) for d in defects[part.name]]
        complaints += planted.plant(out / "trees" / part.name, FOLDERS, changes)
    parts = [of_these(part, tuple(d.function for d in defects[part.name])) if part.proved else part for part in parts]

    def look(part: Part) -> Read:
        functions = {d.function for d in defects[part.name]}
        # One that shows something anyway is only seen when it shows more, and that is counted at the end.
        countable = any(function in functions for function, _ in bounds[part.name])
        return read(part, out / "trees" / part.name, out, () if countable else functions)

    for part, done in at_once(look, parts):
        if isinstance(done, RuntimeError):
            complaints.append(f"{part.name}: {done}")
            continue
        seen = {function for function, _ in more_than(done.alarms, bounds[part.name])}
        print(f"prove: {part.name}: {len(defects[part.name])} defects planted, {done.seconds:.0f} s", flush=True)
        complaints += [f"{d.function}: {d.wrong!r} is not found" for d in defects[part.name] if d.function not in seen]
    planned = sum(len(defects[part.name]) for part in parts)
    print(f"prove: {planned} defects planted, {len(complaints)} not found where they are")
    for complaint in complaints:
        print(f"prove: {complaint}")
    return 1 if complaints else 0


def main() -> int:
    """The drive, or the defects."""
    words = [word for word in sys.argv[1:] if not word.startswith("-")]
    options = [word for word in sys.argv[1:] if word.startswith("-")]
    if not words or set(options) - {"--defects"}:
        print(__doc__.strip())
        return 0 if options == ["--help"] else 2
    out = Path(words[0]).resolve()
    names = words[1:]
    known_names = [part.name for part in PARTS]
    if unknown := [name for name in names if name not in known_names]:
        print(f"prove: no part {', '.join(unknown)}; there are {', '.join(known_names)}")
        return 2
    out.mkdir(parents=True, exist_ok=True)
    subprocess.run(["why3", "-C", str(out / "why3.conf"), "config", "detect"], capture_output=True, check=True)
    compose.write(out / MADE)
    return plant(out, names) if options else check(out, names)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, subprocess.SubprocessError) as error:
        print(f"prove: {error}")
        sys.exit(1)
