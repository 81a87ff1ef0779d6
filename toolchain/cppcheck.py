#!/usr/bin/env python3
"""cppcheck over the drive's C with the C28x's widths: a character, a short and an int of 16 bits.

Usage: toolchain/cppcheck.py [--defects]     (make cppcheck)

With --defects, pieces of code that only a 16-bit int makes wrong are looked at instead: each has to be found.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import compose

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware")
PLATFORM = ROOT / "toolchain" / "cppcheck" / "c28x.xml"
# The widths by their C types: by its own tables uint16_t would be 2 characters, which are a long on the C28x.
WIDTHS = ROOT / "toolchain" / "int16" / "include"
# Left out: the right shift of a negative number. hal/qmath/qarith.h asks the compiler that it is arithmetic.
FLAGS = (
    *("--quiet", "--std=c99", "--enable=warning,portability", "--suppress=shiftNegativeLHS", "--error-exitcode=1"),
    *(f"--platform={PLATFORM}", f"-I{WIDTHS}", f"-I{ROOT}", "-D__attribute__(x)=", f"-j{os.cpu_count()}"),
)
DEFECTS = {
    "a 16-bit number shifted by 16": "uint32_t f(uint16_t x) { return x << 16; }",
    "a constant that does not fit": "int32_t f(void) { return 3000 * 24; }",
    "an int shifted by 20": "int32_t f(int x) { return x << 20; }",
    "a member that is not set": "typedef struct { int a, b; } s_t;\ns_t f(void) { s_t s; s.a = 1; return s; }",
    "an index behind the end": "int f(void) { static const int t[4] = {1, 2, 3, 4}; return t[4]; }",
    "a division by zero": "int f(int x) { const int none = 0; return x / none; }",
}


def look_at(sources: list[str], folder: Path) -> tuple[bool, str]:
    """Whether nothing is found, and what is."""
    done = subprocess.run(["cppcheck", *FLAGS, *sources], cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode == 0, done.stdout + done.stderr


def plant() -> int:
    """Looks at the defects one by one."""
    missed = []
    with tempfile.TemporaryDirectory() as name:
        for what, code in DEFECTS.items():
            (Path(name) / "x.c").write_text(f"#include <stdint.h>\n{code}\n", encoding="utf-8")
            clean, _ = look_at(["x.c"], Path(name))
            missed += [what] if clean else []
    found = len(DEFECTS) - len(missed)
    print("; ".join([f"cppcheck: {found} of {len(DEFECTS)} planted defects found", *(f"missed: {w}" for w in missed)]))
    return 1 if missed else 0


def main() -> int:
    """The drive, or the defects."""
    if "--defects" in sys.argv:
        return plant()
    made = ROOT / "build" / "cppcheck"
    compose.write(made)
    sources = sorted(p.relative_to(ROOT).as_posix() for folder in FOLDERS for p in (ROOT / folder).rglob("*.c"))
    clean, said = look_at([f"-I{made}", *sources], ROOT)
    print(said if said.strip() else f"cppcheck: {len(sources)} sources with the C28x's widths, nothing found")
    return 0 if clean else 1


if __name__ == "__main__":
    sys.exit(main())
