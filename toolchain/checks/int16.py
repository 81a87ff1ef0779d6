"""The drive's C through a compiler whose ``int`` has 16 bits, as the C28x's has.

clang's msp430 front end has int 16, long 32, long long 64 bits. It only parses and types the code: an intermediate
result that is too narrow, a shift by 16 of an int, a constant that does not fit become errors here, while the host's
32-bit int hides them.
"""

import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from checks import Finding

FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware")
FLAGS = (
    "--target=msp430",
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wshadow",
    "-Wundef",
    "-Werror",
    "-fsyntax-only",
    "-ffreestanding",
    "-fno-color-diagnostics",
)
_DIAGNOSTIC = re.compile(r"^(?:\./)?(.+?):(\d+):\d+: (?:fatal )?error: (.*)$")


def find_clang() -> str | None:
    """Name of the newest installed clang with the msp430 target."""
    script = Path(__file__).parent.parent / "find-clang.sh"
    found = subprocess.run(["bash", str(script)], capture_output=True, text=True, check=False)
    return found.stdout.strip() or None


def check_file(clang: str, root: Path, source: Path) -> list[Finding]:
    """Findings for one C file, given relative to ``root``."""
    command = [clang, *FLAGS, "-I.", source.as_posix()]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return []
    findings = []
    for line in run.stderr.splitlines():
        match = _DIAGNOSTIC.match(line)
        if match:
            findings.append(Finding(match[1], int(match[2]), match[3]))
    return findings or [Finding(source.as_posix(), 0, f"{' '.join(command)} failed: {run.stderr.strip()}")]


def check(root: Path) -> list[Finding]:
    """Findings for every C file of the drive."""
    clang = find_clang()
    if clang is None:
        return [Finding("toolchain/find-clang.sh", 0, "no clang with the msp430 target: run `make setup`")]
    files = sorted(path.relative_to(root) for folder in FOLDERS for path in (root / folder).rglob("*.c"))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda file: check_file(clang, root, file), files)
        # A header's fault is reported by every file that includes it: once is enough.
        return list(dict.fromkeys(finding for result in results for finding in result))
