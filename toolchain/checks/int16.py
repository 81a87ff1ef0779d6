"""The drive's C through a compiler whose ``int`` has 16 bits, as the C28x's has.

clang's msp430 front end has int 16, long 32, long long 64 bits. It only parses and types the code: an intermediate
result that is too narrow, a shift by 16 of an int, a constant that does not fit become errors here, while the host's
32-bit int hides them. What the build makes is read as well, and the HAL a second time in the DSP's branch of
hal/f2808/target.h, with the words of toolchain/standin for cl2000's.
"""

import os
import re
import subprocess
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import compose

from checks import Finding

TOOLCHAIN = Path(__file__).resolve().parent.parent

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
DSP = ("-D__TMS320C28XX__", "-include", str(TOOLCHAIN / "standin" / "include.h"))
IDENTITY = "hal/f2808/image/identity.c.in"
_DIAGNOSTIC = re.compile(r"^(?:\./)?(.+?):(\d+):\d+: (?:fatal )?error: (.*)$")


def find_clang() -> str | None:
    """Name of the newest installed clang with the msp430 target."""
    script = TOOLCHAIN / "find-clang.sh"
    found = subprocess.run(["bash", str(script)], capture_output=True, text=True, check=False)
    return found.stdout.strip() or None


def check_file(clang: str, root: Path, name: str, text: str | None, more: tuple[str, ...]) -> list[Finding]:
    """Findings for one C file, given relative to ``root``, or for a text in its place."""
    command = [clang, *FLAGS, *more, "-I.", *((name,) if text is None else ("-x", "c", "-"))]
    run = subprocess.run(command, cwd=root, input=text, capture_output=True, text=True, check=False)
    if run.returncode == 0:
        return []
    findings = []
    for line in run.stderr.splitlines():
        match = _DIAGNOSTIC.match(line)
        if match:
            findings.append(Finding(match[1], int(match[2]), match[3]))
    return findings or [Finding(name, 0, f"{' '.join(command)} failed: {run.stderr.strip()}")]


def check_all(root: Path, units: Mapping[str, str | None]) -> list[Finding]:
    """Findings for files, or texts in their place; those of the HAL as the DSP has them, too."""
    clang = find_clang()
    if clang is None:
        return [Finding("toolchain/find-clang.sh", 0, "no clang with the msp430 target: run `make setup`")]
    runs: list[tuple[str, tuple[str, ...]]] = [(name, ()) for name in units]
    runs += [(name, DSP) for name in units if name.startswith("hal/")]
    with TemporaryDirectory() as made, ThreadPoolExecutor(os.cpu_count()) as pool:
        if (root / compose.EDITIONS).is_dir():
            compose.write(Path(made), root=root)
        results = pool.map(lambda run: check_file(clang, root, run[0], units[run[0]], (f"-I{made}", *run[1])), runs)
        # A header's fault is reported by every file that includes it: once is enough.
        return list(dict.fromkeys(finding for result in results for finding in result))


def check_sources(root: Path) -> list[Finding]:
    """Findings for every C file of the drive."""
    files = (path.relative_to(root).as_posix() for folder in FOLDERS for path in (root / folder).rglob("*.c"))
    return check_all(root, dict.fromkeys(sorted(files)))


def check_generated(root: Path) -> list[Finding]:
    """Findings for what the build makes: the packed texts, and the identity with 0, the narrowest, for its numbers."""
    made = {
        **{
            f"firmware/{name}": text
            for name, text in compose.made(compose.read_edition("lab", root), root).items()
            if name.endswith(".c")
        },
        IDENTITY: re.sub(r"@\w+@", "0", (root / IDENTITY).read_text(encoding="utf-8")),
    }
    return check_all(root, {name: f'#line 1 "{name}"\n{text}' for name, text in made.items()})


def check(root: Path) -> list[Finding]:
    """Findings for all of it."""
    return list(dict.fromkeys([*check_sources(root), *check_generated(root)]))
