"""Records: what one command gave, docs/figures/NAME.json, which the tables of README.md and the book are made from.

A record says which command made it, of which sources (a sum over their text), and the figures. The runs of `stillspin`
are kept by toolchain/figures.py; commands of the Makefile keep their own (toolchain/keep.py). Where the sources changed
since and the figures were seen not to (figures.py --confirm), it says of which they are now, and of which it was made.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

FOLDER = "docs/figures"
SUFFIXES = {".c", ".h", ".cpp", ".hpp", ".toml", ".py", ".cmd", ".js", ".css", ".html"}
PICTURES = "docs/images"
DRIVE = ("control", "estimators", "firmware", "hal", "svpwm")
# What decides a figure of a run: the drive, what it runs on, what is done with it, and how it is judged. Every such run
# is of the drive's C made for this machine, so the core that runs an image's machine code has no part in it; nor has
# which process carries a run out.
RUNS = (
    *DRIVE,
    *(f"sim_host/{name}" for name in ("bench", "chip", "devices", "plant", "profiles", "scenarios", "schemes")),
    *(f"sim_host/motors/{name}.toml" for name in ("A", "B", "B-SPM")),
    *(f"sim_host/stillspin/{name}" for name in ("cases", "measure", "runs", "studies")),
    *(f"!sim_host/chip/{name}" for name in ("c28x", "code_cpu", "code_flash_library")),
    *(f"!sim_host/stillspin/runs/{name}.py" for name in ("cluster", "held_interrupt", "reporting", "workers")),
)
# What a run of `stillspin` is made of beside these, by the record's name.
BESIDE = {
    "type-test": ("sim_host/stillspin/type_test", "sim_host/stillspin/campaign", "sim_host/motors"),
    **dict.fromkeys(("hil-serial", "hil-can", "hil-whole"), ("sim_host/stillspin/hil",)),
}
# The C++ tests in which the drive's C runs.
TESTS = tuple(
    f"tests/{name}" for name in ("bench", "control", "estimators", "firmware", "fuzz", "hal", "qmath", "svpwm")
)
UNKNOWN = "unknown"
"""Sources of a record whose figures were taken from an older page."""


@dataclass(frozen=True)
class Made:
    """A command of the Makefile that keeps a record.

    Attributes:
        command: that renews it; result: the file that it leaves, or the folder of pictures, of which the record has
            sums; sources: what decides its figures; part: what of the result is kept, all where it is empty.
    """

    command: str
    result: str
    sources: tuple[str, ...]
    part: str = ""


COMPOSER = tuple(
    f"toolchain/{name}.py" for name in ("compose", "edition_tables", "pack_text", "row_lists", "word_code")
)
COMMANDS = {
    "image": Made(
        "make image-check",
        "build/image-check/figures.json",
        (
            *DRIVE,
            *("hal/f2808/image/boot.asm", "toolchain/c28x", "toolchain/f2808", "toolchain/image"),
            *("toolchain/standin/bin/cl2000", *COMPOSER, "toolchain/costs.py"),
        ),
    ),
    "isr-cost": Made(
        "make isr-cost",
        "build/isr-cost/figures.json",
        (
            *DRIVE,
            *("toolchain/isr", "toolchain/f2808", "toolchain/standin/bin/cl2000", "toolchain/c28x-cl2000.cmake"),
            *(*COMPOSER, "toolchain/costs.py", "tests/m3"),
        ),
    ),
    "prove": Made(
        "make prove", "build/prove/figures.json", (*DRIVE, "tests/prove", "toolchain/prove.py", "toolchain/proof")
    ),
    "mcdc": Made("make mcdc", "build/mcdc/figures.json", (*DRIVE, *TESTS, "toolchain/mcdc.py")),
    "mutants": Made(
        'make mutants SAMPLE="20 near seed=59"',
        "build/mutants/figures.json",
        (*DRIVE, *TESTS, "toolchain/mutants.py", "toolchain/mutation"),
    ),
    "speed": Made("make bench", "build/bench/figures.json", RUNS),
    "c28x": Made("make bench", "build/bench/c28x.json", ("sim_host/chip", "tests/c28x", "tests/python/c28x_speed.py")),
    "catalogue": Made(
        "make catalogue",
        "build/catalogue/figures.json",
        (*RUNS, "sim_host/motors", "sim_host/stillspin/catalogue.py"),
        "motors",
    ),
    "pictures": Made(
        "make pictures",
        PICTURES,
        (*RUNS, "sim_host/stillspin/tune", "toolchain/overview.py", "toolchain/tuning_pictures.py"),
    ),
}


def _files(root: Path, trees: tuple[str, ...]) -> list[Path]:
    """The files of `trees`, each a folder or a file; less those whose path begins with what stands behind a `!`."""
    found: set[Path] = set()
    for tree in trees:
        where = root / tree
        found |= {where} if where.is_file() else {path for path in where.rglob("*") if path.suffix in SUFFIXES}
    without = tuple(str(root / tree[1:]) for tree in trees if tree.startswith("!"))
    return sorted(path for path in found if not str(path).startswith(without))


def sources(root: Path, trees: tuple[str, ...] = RUNS) -> str:
    """A sum over everything that decides a record's figures."""
    total = hashlib.sha256()
    for path in _files(root, trees):
        total.update(f"{path.relative_to(root)}\0".encode() + path.read_bytes() + b"\0")
    return total.hexdigest()[:16]


def sources_of(root: Path, name: str) -> str:
    """The sum for a record by its name, as the sources are now; behind `+` that of what it alone is made of beside."""
    if name in COMMANDS:
        return sources(root, COMMANDS[name].sources)
    beside = f"+{sources(root, BESIDE[name])}" if name in BESIDE else ""
    return sources(root) + beside


def load(root: Path) -> dict[str, dict[str, Any]]:
    """All records, by name."""
    files = sorted((root / FOLDER).glob("*.json"))
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in files}


def sums(folder: Path) -> dict[str, str]:
    """A sum of each picture of a folder."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest()[:16] for path in sorted(folder.glob("*.png"))}


def keep(root: Path, name: str, command: str, figures: Any, made_of: str = "") -> None:
    """Write a record; `made_of`: the sum over its sources when the command began, where that is not now."""
    content = {"command": command, "sources": made_of or sources_of(root, name), "figures": figures}
    _write(root, name, content)


def confirm(root: Path, name: str, seen_of: str) -> None:
    """Say of a record that its figures are those of other sources as well; `seen_of`: the sum over these."""
    content = load(root)[name]
    _write(root, name, {"made_of": content["sources"], **content, "sources": seen_of})


def outdated(root: Path) -> dict[str, str]:
    """Records whose sources have changed since they were made, and what renews each."""
    return {
        name: record["command"] if name in COMMANDS else f"toolchain/figures.py {name}"
        for name, record in load(root).items()
        if record["sources"] != sources_of(root, name)
    }


def _write(root: Path, name: str, content: dict[str, Any]) -> None:
    (root / FOLDER).mkdir(parents=True, exist_ok=True)
    text = json.dumps(content, indent=1, ensure_ascii=False, sort_keys=True)
    (root / FOLDER / f"{name}.json").write_text(text + "\n", encoding="utf-8")
