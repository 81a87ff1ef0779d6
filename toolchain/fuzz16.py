#!/usr/bin/env python3
"""A short search over the drive with a 16-bit int, always the same way, and planted defects that it has to find.

Usage: toolchain/fuzz16.py BUILD RUNS     (make fuzz16)

BUILD is where toolchain/fuzz.sh builds tests/fuzz. Each search makes RUNS executions from an empty corpus with a fixed
seed and must end clean. Then each of DEFECTS is planted into a copy of the source that it is in, which takes the
place of the right one among the drive's objects: the first input, the empty one, must not show it, and the same search
must end at it. A 32-bit int forgives those that are marked: only a search over the 16-bit objects sees them.
"""

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import planted

ROOT = Path(__file__).resolve().parent.parent
LIBRARY = "libstillspin_drive16.so"
FIXED = ("-seed=1", "-max_len=300", "-len_control=0", "-verbosity=0", "-print_funcs=0")
SEARCHES = {"link16": ("-dict=tests/fuzz/link.dict",), "bus16": ()}
TRAP, ADDRESS = "libFuzzer: deadly signal", "AddressSanitizer"  # what a search says at its end


@dataclass(frozen=True)
class Defect:
    """A wrong piece of source, and what has to see it."""

    what: str
    search: str
    said: str
    file: str
    right: str
    wrong: str
    only16: bool = False


DEFECTS = (
    Defect(
        *("a sign bit shifted out of an int", "link16", TRAP, "firmware/base/octets.c"),
        *("(uint16_t)(take_u8(r) << 8)", "(uint16_t)((int16_t)take_u8(r) << 8)", True),
    ),
    Defect(
        *("a product beyond an int", "bus16", TRAP, "firmware/can/command.c"),
        *("speed_steps * RPM_Q16_PER_STEP", "(int16_t)speed_steps * (int16_t)RPM_Q16_PER_STEP", True),
    ),
    Defect(
        *("a line one character too long", "link16", TRAP, "firmware/console/editor.c"),
        *("l->count >= EDITOR_LINE", "l->count > EDITOR_LINE"),
    ),
    Defect(
        *("a word behind the last one", "link16", TRAP, "firmware/text/catalogue.c"),
        *("return kind < CATALOGUES && code <", "return code <"),
    ),
    Defect(
        *("a record that is too short for its CRC", "bus16", ADDRESS, "firmware/link/record.c"),
        *("if (count < RECORD_MIN || count > RECORD_MAX)", "if (count > RECORD_MAX)"),
    ),
)


def search(build: Path, name: str, runs: int, library: Path) -> tuple[bool, str]:
    """Whether it ends clean, and what it says."""
    found = build / "found16"
    found.mkdir(exist_ok=True)
    command = [str(build / f"stillspin_fuzz_{name}"), f"-runs={runs}", f"-artifact_prefix={found}/{name}-", *FIXED]
    paths = {"LD_LIBRARY_PATH": str(library), "ASAN_OPTIONS": "quarantine_size_mb=16"}
    done = subprocess.run(
        [*command, *SEARCHES[name]], cwd=ROOT, env=os.environ | paths, capture_output=True, text=True, check=False
    )
    return done.returncode == 0, done.stderr


def compile_planted(build: Path, defect: Defect, folder: Path) -> list[str]:
    """The library with the defect; complaints when it cannot be planted."""
    tree = folder / "tree"
    complaints = planted.plant(tree, (str(Path(defect.file).parent),), [(defect.file, defect.right, defect.wrong)])
    if complaints:
        return complaints
    objects = folder / "objects"
    options = (build / "int16_options.txt").read_text(encoding="utf-8").split()
    places = [f"--tree={tree}", f"--rest={build / 'int16_objects'}"]
    compiler = [sys.executable, "toolchain/int16/compile.py", str(objects), *options, *places, defect.file]
    subprocess.run(compiler, cwd=ROOT, check=True)
    subprocess.run(["gcc", "-shared", "-o", str(folder / LIBRARY), str(objects / "all.o")], check=True)
    return []


def find(build: Path, number: int, runs: int) -> str | None:
    """What is wrong with the search for a defect."""
    defect = DEFECTS[number]
    folder = build / f"planted{number}"
    folder.mkdir(exist_ok=True)
    complaints = compile_planted(build, defect, folder)
    if complaints:
        return "; ".join(complaints)
    if not search(build, defect.search, 0, folder)[0]:
        return f"{defect.what} in {defect.file} needs no search"
    clean, said = search(build, defect.search, runs, folder)
    if clean or defect.said not in said:
        return f"{defect.what} was not found in {defect.file}: {said[-500:]}"
    return None


def main() -> int:
    """The right drive, then the defects."""
    build, runs = Path(sys.argv[1]).resolve(), int(sys.argv[2])
    for name in SEARCHES:
        clean, said = search(build, name, runs, build)
        if not clean:
            print(f"fuzz16: {name} breaks the drive with a 16-bit int, see {build}/found16\n{said[-4000:]}")
            return 1
        print(f"fuzz16: {name}, {runs} runs clean", flush=True)
    missed = [wrong for number in range(len(DEFECTS)) if (wrong := find(build, number, runs)) is not None]
    print("\n".join([f"fuzz16: {len(DEFECTS) - len(missed)} of {len(DEFECTS)} planted defects found", *missed]))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
