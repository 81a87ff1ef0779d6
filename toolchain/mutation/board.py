"""Programs, sources and objects of `make mutants`: what is compiled again for a mutant, and what runs it.

A build folder of its own holds the tests as `make build` makes them. A mutant's object is linked before the library
that has the original, which is then not taken from the library. A changed header is laid over the tree by the include
path, for the floors' sources that use it and for the tests that include it, or by a header of theirs.
"""

import hashlib
import json
import math
import os
import resource
import shlex
import signal
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "mutants"
TREE = BUILD  # as deep as build/release, so that ccache knows the tests' objects
FLOORS = ("hal", "control", "svpwm", "estimators", "firmware")
MEMORY = 4 << 30  # of a test program
LEAST_TIME = 5.0  # s, before a program counts as hanging
WAITING = 20.0  # times as long on the clock, before one that does nothing does
# Of the whole runs those with the fast integrator, which look at the drive and not at the bench.
CHOSEN = {
    "bench_run_test": "Sources/*:Source.*:Limits.*:Each/*:Angles/*:Standing.*:Speeds/*:Blocked.*:Fault.*:Commission.*"
}


def said(command: list[str]) -> str:
    """What a command prints; an end with its words when it fails."""
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"mutants: {' '.join(command)}\n{(done.stdout + done.stderr)[-4000:]}")
    return done.stdout


@dataclass
class Program:
    """A test program: how it is linked, how long the processor takes, what it was made of."""

    name: str
    link: list[str]
    seconds: float = 0.0
    digest: str = ""

    @property
    def path(self) -> Path:
        """As built."""
        return TREE / self.link[self.link.index("-o") + 1]


@dataclass
class Board:
    """The build of the unchanged tree."""

    programs: dict[str, Program] = field(default_factory=dict)
    commands: dict[str, list[str]] = field(default_factory=dict)  # by source, from the root
    objects: dict[str, str] = field(default_factory=dict)  # by source, from the build folder
    needs: dict[str, set[str]] = field(default_factory=dict)  # a source's files

    def uses(self, file: str) -> list[str]:
        """The floors' sources that a changed file changes, and the tests that include it, or by a header of theirs."""
        if file.endswith(".c"):
            return [file]
        told = f'#include "{file}"'

        def includes(source: str, files: set[str]) -> bool:
            own = (path for path in (source, *files) if path.startswith("tests/"))
            return source.startswith("tests/") and any(told in (ROOT / path).read_text("utf-8") for path in own)

        return sorted(
            source
            for source, files in self.needs.items()
            if file in files and (source.startswith(FLOORS) or includes(source, files))
        )


def make_board(names: list[str]) -> Board:
    """Builds the test programs and reads how."""
    TREE.mkdir(parents=True, exist_ok=True)
    said(["cmake", "-G", "Ninja", "-S", ".", "-B", str(TREE), "-DCMAKE_BUILD_TYPE=Release", "-DSTILLSPIN_PYTHON=OFF",
          f"-DPython_EXECUTABLE={ROOT / '.venv/bin/python'}"])  # fmt: skip
    said(["cmake", "--build", str(TREE), "--parallel", str(os.cpu_count()), "--target", *names])
    board = Board()
    for entry in json.loads((TREE / "compile_commands.json").read_text(encoding="utf-8")):
        path = Path(entry["file"])
        words = shlex.split(entry["command"])
        words = [w for w in words if Path(w).name != "ccache"]
        if path.is_relative_to(ROOT) and not path.is_relative_to(TREE):
            source = path.relative_to(ROOT).as_posix()
            board.commands[source] = words
            board.objects[source] = words[words.index("-o") + 1]
    read_needs(board)
    for name in names:
        board.programs[name] = program(name)
    return board


def read_needs(board: Board) -> None:
    """Which files each source includes, by what the compiler told ninja."""
    by_object = {obj: source for source, obj in board.objects.items()}
    source = None
    for line in said(["ninja", "-C", str(TREE), "-t", "deps"]).splitlines():
        if not line.startswith(" "):
            source = by_object.get(line.partition(":")[0])
            continue
        path = Path(os.path.normpath(TREE / line.strip()))
        if source is not None and path.is_relative_to(ROOT):
            board.needs.setdefault(source, set()).add(path.relative_to(ROOT).as_posix())


def program(name: str) -> Program:
    """How a program is linked, and how long it takes when nothing is wrong."""
    last = said(["ninja", "-C", str(TREE), "-t", "commands", name]).splitlines()[-1]
    link = next(shlex.split(part) for part in last.split(" && ") if " -o " in part and "cmake" not in part)
    made = Program(name, link)
    made.digest = hashlib.sha256(made.path.read_bytes()).hexdigest()
    start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    if not passes(made.path, 900.0):
        raise SystemExit(f"mutants: {name} fails without a mutant")
    made.seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start
    return made


def passes(path: Path, limit: float) -> bool:
    """Whether a test program passes within a time of the processor, s: one that waits for others does not hang."""
    chosen = f"--gtest_filter={CHOSEN.get(path.name, '*')}"
    command = [
        "prlimit",
        f"--as={MEMORY}",
        f"--cpu={math.ceil(limit)}",
        str(path),
        chosen,
        "--gtest_fail_fast",
        "--gtest_brief=1",
    ]
    with tempfile.TemporaryDirectory(dir=BUILD) as place:
        run = subprocess.Popen(command, cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)  # fmt: skip
        try:
            return run.wait(WAITING * limit) == 0
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            run.wait()
            return False


def compiled(board: Board, source: str, text: str | None, overlay: Path, out: Path) -> bool:
    """Compiles a source, changed or with a header laid over it; false when it does not compile."""
    words = list(board.commands[source])
    words[words.index("-o") + 1] = str(out)
    words = [w for w in words if w not in ("-g", "-Werror")]
    place = words.index(str(ROOT / source))
    if text is not None:
        changed = overlay / source
        changed.parent.mkdir(parents=True, exist_ok=True)
        changed.write_text(text, encoding="utf-8")
        words[place] = str(changed)
    words[1:1] = [f"-I{overlay}", "-w"]
    words += ["-O2"] if source.endswith(".c") else ["-O0"]
    return subprocess.run(words, cwd=TREE, capture_output=True, check=False).returncode == 0


def code_of(path: Path) -> bytes:
    """The object's code and data without names of files."""
    plain = path.with_suffix(".plain")
    subprocess.run(["objcopy", "-R", ".comment", "--strip-debug", "--strip-unneeded", path, plain], check=True)
    try:
        return plain.read_bytes()
    finally:
        plain.unlink()


def linked(board: Board, name: str, changed: dict[str, Path], out: Path) -> bool:
    """Links a program with changed objects: a test's in the place of its own, the others before the libraries."""
    words = list(board.programs[name].link)
    target = words.index("-o")
    words[target + 1] = str(out)
    first = [str(path) for source, path in changed.items() if not source.startswith("tests/")]
    for source, path in changed.items():
        if source.startswith("tests/"):
            words = [str(path) if word == board.objects[source] else word for word in words]
    words[target + 2 : target + 2] = first
    return subprocess.run(words, cwd=TREE, capture_output=True, check=False).returncode == 0
