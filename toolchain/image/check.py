#!/usr/bin/env python3
"""Builds the image of each edition by the stand-in for cl2000, and says whether it fits its chip.

Usage: toolchain/image/check.py OUT     (make image-check)

A build that fails, and a figure beyond its limit in toolchain/f2808/image_limits.txt, are failures; what is beyond its
goal is said to be short. The figures go to OUT/figures.json, what they come to to OUT/budget.json.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from costs import costs  # noqa: E402

from image import classes  # noqa: E402
from image.elf import read_object  # noqa: E402
from image.sizes import object_words  # noqa: E402

ROOT = HERE.parents[1]
STANDIN = ROOT / "toolchain" / "standin"
LIMITS = ROOT / "toolchain" / "f2808" / "image_limits.txt"
EDITIONS = ("lab",)
RAM = 18432  # words of the chip
FIGURES = "hal/f2808/image/stillspin_f2808.json"  # what the link leaves, in the build's folder
MAPS = ("stillspin_f2808", "stillspin_flash_kernel", "stillspin_lamp")
WHAT = {
    "thumb": "code, half words of Thumb-2",
    "code": "of these in flash, with TI's library",
    "ram_code": "of these running from RAM",
    "flash_expected": "the whole flash (A to D), expected",
    "flash_p90": "the same, at 90 % not exceeded",
    "flash_by_class": "the same by the classes of the instructions",
    "strings": "strings, a word for a character, and packed texts",
    "constants": "other constants",
    "resident": "half words and words that stay in sector A",
    "update": "half words and words that an update writes (B to D)",
    "globals": "globals in RAM",
    "scope": "of these: the scope's buffer",
    "stack": "stack, by the call graph",
    "ram": "RAM: globals, stack, hot code as expected",
}


def configure(edition: str, folder: Path) -> None:
    """Prepares the build of an edition. CalledProcessError where that fails; its output is in FOLDER.log."""
    options = (f"-DSTILLSPIN_EDITION={edition}", f"-DF2808_FLASH_API={STANDIN / 'Flash2808_API.lib'}")
    environment = os.environ | {"C2000_CG_ROOT": str(STANDIN)}
    run("configure", ["cmake", "--preset", "f2808", "-B", str(folder), *options], folder, environment)


def build(folder: Path) -> None:
    """All that can be built. CalledProcessError where that is not all of it."""
    run("build", ["cmake", "--build", str(folder), "--parallel", "2", "--", "-k", "0"], folder)


def run(what: str, command: list[str], folder: Path, environment: Mapping[str, str] = os.environ) -> None:
    """One step, its output in a file beside the folder; the end of that where it fails."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    log = folder.with_suffix(f".{what}.log")
    with log.open("w", encoding="utf-8") as file:
        done = subprocess.run(command, cwd=ROOT, env=environment, stdout=file, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        print(f"image-check: {folder.name}: {what} failed ({log})")
        print("\n".join(log.read_text(encoding="utf-8").splitlines()[-30:]))
        raise subprocess.CalledProcessError(done.returncode, command)


def parts_of(objects: list[str], folder: Path) -> dict[str, dict[str, int]]:
    """By folder of the tree: half words of Thumb-2, and words by half words and by the classes of instructions."""
    known = costs(ROOT)
    paths = [folder / name for name in objects]
    parts: dict[str, dict[str, float]] = {}
    for file, counts in classes.counted(classes.disassembled(paths)).items():
        part = next(name for name in Path(file).relative_to(folder).parts if name != "CMakeFiles")
        row = parts.setdefault(part, {"half_words": 0, "by_class": 0})
        row["by_class"] += classes.words(counts, known["classes"])
        sections = object_words(read_object(Path(file)))
        row["half_words"] += sections.get(".text", 0) + sections.get("ramfuncs", 0)
    for row in parts.values():
        row["expected"] = known["words"]["expected"] * row["half_words"]
    return {part: {name: round(value) for name, value in row.items()} for part, row in sorted(parts.items())}


def figures_of(counted: Mapping[str, int], by_class: int) -> dict[str, int]:
    """What the link counted, and what it comes to in words of the C28x."""
    words = costs(ROOT)["words"]
    thumb = counted["code"] + counted["ram_code"] - counted["library"]  # that is of the C28x already
    rest = counted["flash"] - thumb
    expected = words["expected"] * thumb
    hot = round(words["expected"] * counted["ram_code"])
    return {
        **counted,
        "thumb": thumb,
        "flash_expected": round(rest + expected),
        "flash_p90": round(rest + expected * words["p90"]),
        "flash_by_class": rest + by_class,
        "ram_code_expected": hot,
        "ram": counted["globals"] + counted["stack"] + hot,
    }


def budget(figures: Mapping[str, int]) -> dict[str, int]:
    """What the chip has, and what an edition takes of it."""
    return {
        "flash_words_expected": figures["flash_expected"],
        "flash_words_p90": figures["flash_p90"],
        "flash_words_by_class": figures["flash_by_class"],
        "flash_words_available": figures["flash_room"],
        "ram_words": figures["ram"],
        "ram_words_available": RAM,
        "ram_code_words": figures["ram_code_expected"],
        "ram_code_available": figures["ram_code_room"],
        "stack_words": figures["stack"],
    }


def limits() -> dict[str, dict[str, tuple[int, int]]]:
    """By edition and figure: goal and limit."""
    found: dict[str, dict[str, tuple[int, int]]] = {}
    for line in LIMITS.read_text(encoding="utf-8").splitlines():
        fields = [field.strip() for field in line.partition("#")[0].split("|")]
        if len(fields) == 4:
            found.setdefault(fields[0], {})[fields[1]] = int(fields[2]), int(fields[3])
    return found


def judged(edition: str, figures: Mapping[str, int]) -> tuple[list[str], list[str]]:
    """What is beyond its goal, and what is beyond its limit."""
    short, beyond = [], []
    for key, (goal, limit) in limits().get(edition, {}).items():
        what = f"{edition}, {WHAT[key]}: {figures[key]}"
        if figures[key] > goal:
            short.append(f"{what}, goal {goal}")
        if figures[key] > limit:
            beyond.append(f"{what}, limit {limit}")
    return short, beyond


def published(edition: str, figures: Mapping[str, int]) -> dict[str, Any]:
    """What the book's tables are made of."""
    goals = limits().get(edition, {})
    rows = {key: {"what": what, "words": figures[key]} for key, what in WHAT.items()}
    return {key: row | ({"goal": goals[key][0]} if key in goals else {}) for key, row in rows.items()}


def main() -> int:
    """Build, print, judge."""
    out = Path(sys.argv[1]).resolve()
    figures: dict[str, dict[str, int]] = {}
    parts: dict[str, dict[str, dict[str, int]]] = {}
    failed, short, beyond = False, [], []
    for edition in EDITIONS:
        folder = out / edition
        made = folder / FIGURES
        for left in (made, made.with_suffix(".out")):  # so that it is linked again
            left.unlink(missing_ok=True)
        try:
            configure(edition, folder)
            build(folder)
        except subprocess.CalledProcessError:
            failed = True
        if not made.exists():
            continue
        linked = json.loads(made.read_text(encoding="utf-8"))
        parts[edition] = parts_of(linked.pop("objects"), folder)
        figures[edition] = figures_of(linked, sum(part["by_class"] for part in parts[edition].values()))
        for name in MAPS:
            print(f"{edition}, {name}:\n{made.with_name(f'{name}.map').read_text(encoding='utf-8')}")
        judgement = judged(edition, figures[edition])
        short += judgement[0]
        beyond += judgement[1]
    if not figures:
        return 1
    budgets = {"editions": {edition: budget(own) for edition, own in figures.items()}}
    (out / "budget.json").write_text(json.dumps(budgets, indent=1), encoding="utf-8")
    details = {edition: published(edition, own) for edition, own in figures.items()}
    (out / "figures.json").write_text(json.dumps({**budgets, "details": details, "parts": parts}), encoding="utf-8")
    for edition, own in budgets["editions"].items():
        print(f"{edition}: " + ", ".join(f"{name} {value}" for name, value in own.items()))
        for part, row in parts[edition].items():
            print(f"  {part:12}" + "".join(f"{name.replace('_', ' '):>12} {value:6}" for name, value in row.items()))
    for line in short:
        print(f"image-check: short: {line}")
    for line in beyond:
        print(f"image-check: {line}")
    return 1 if failed or beyond else 0


if __name__ == "__main__":
    sys.exit(main())
