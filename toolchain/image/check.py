#!/usr/bin/env python3
"""Builds the image of each edition by the stand-in for cl2000, and says whether it fits its chip.

Usage: toolchain/image/check.py OUT [EDITION]...     (make image-check)

Beside EDITIONS, of each EDITION, a list in firmware/editions/ or the path of one. All are linked of the same objects,
which are compiled once. A build that fails, and a figure beyond its limit in toolchain/f2808/image_limits.txt, are
failures; what is beyond its goal is said to be short. The figures go to OUT/figures.json, what they come to to
OUT/budget.json.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import compose  # noqa: E402
from costs import costs  # noqa: E402

from image import classes, features  # noqa: E402
from image.elf import read_object  # noqa: E402
from image.resident import changed  # noqa: E402
from image.sizes import object_words  # noqa: E402

ROOT = HERE.parents[1]
STANDIN = ROOT / "toolchain" / "standin"
LIMITS = ROOT / "toolchain" / "f2808" / "image_limits.txt"
WHOLE, *OTHERS = EDITIONS = ("lab", "drive", "hil", "minimal")  # the first has all that there is
RAM = 18432  # words of the chip
IMAGES = "hal/f2808/image"  # in the build's folder
FIGURES = "stillspin_f2808.json"  # what the link of one leaves
PROGRAMS = ("stillspin_flash_kernel", "stillspin_lamp")  # that know no edition
WHAT = {
    "thumb": "code, half words of Thumb-2",
    "code": "of these in flash, with TI's library",
    "ram_code": "of these running from RAM",
    "flash_expected": "the whole flash (A to D), expected",
    "flash_p90": "the same, at 90 % not exceeded",
    "flash_by_class": "the same by the classes of the instructions",
    "strings": "strings, a word for a character, and packed texts",
    "constants": "other constants",
    "resident": "what stays in sector A, expected",
    "update": "what an update writes (B to D), expected",
    "globals": "globals in RAM",
    "scope": "of these: the scope's buffer",
    "stack": "stack, by the call graph",
    "ram": "RAM: globals, stack, hot code as expected",
}


def configure(folder: Path, more: Iterable[str] = OTHERS) -> None:
    """Prepares the build of the images. CalledProcessError where that fails; its output is in FOLDER.log."""
    editions = (f"-DSTILLSPIN_EDITION={WHOLE}", f"-DSTILLSPIN_MORE_EDITIONS={';'.join(more)}")
    options = (*editions, f"-DF2808_FLASH_API={STANDIN / 'Flash2808_API.lib'}")
    environment = os.environ | {"C2000_CG_ROOT": str(STANDIN)}
    run("configure", ["cmake", "--preset", "f2808", "-B", str(folder), *options], folder, environment)


def build(folder: Path) -> None:
    """All that can be built. CalledProcessError where that is not all of it."""
    run("build", ["cmake", "--build", str(folder), "--parallel", "2", "--", "-k", "0"], folder)


def linked(folder: Path, edition: str) -> Path:
    """What the link of an edition's image leaves."""
    return folder / IMAGES / ("" if edition == WHOLE else edition) / FIGURES


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


def counted(objects: Iterable[Path]) -> dict[Path, tuple[int, float]]:
    """Of each object its half words of Thumb-2, and words by the classes of their instructions."""
    known = costs(ROOT)["classes"]
    found = {}
    for file, counts in classes.counted(classes.disassembled(sorted(objects))).items():
        sections = object_words(read_object(Path(file)))
        half_words = sections.get(".text", 0) + sections.get("ramfuncs", 0)
        found[Path(file)] = half_words, classes.words(counts, known)
    return found


def parts_of(objects: Mapping[Path, tuple[int, float]], folder: Path) -> dict[str, dict[str, int]]:
    """By folder of the tree: half words of Thumb-2, and words by half words and by the classes of instructions."""
    parts: dict[str, dict[str, float]] = {}
    for file, (half_words, by_class) in objects.items():
        part = next(name for name in file.relative_to(folder).parts if name != "CMakeFiles")
        row = parts.setdefault(part, {"half_words": 0, "by_class": 0})
        row["half_words"] += half_words
        row["by_class"] += by_class
    for row in parts.values():
        row["expected"] = costs(ROOT)["words"]["expected"] * row["half_words"]
    return {part: {name: round(value) for name, value in row.items()} for part, row in sorted(parts.items())}


def figures_of(counted: Mapping[str, int], by_class: int) -> dict[str, int]:
    """What the link counted, and what it comes to in words of the C28x."""
    words = costs(ROOT)["words"]
    thumb = counted["code"] + counted["ram_code"] - counted["library"]  # that is of the C28x already
    rest = counted["flash"] - thumb
    expected = words["expected"] * thumb
    hot = round(words["expected"] * counted["ram_code"])
    resident = counted["resident"] + (words["expected"] - 1) * counted["resident_code"]
    return {
        **counted,
        "thumb": thumb,
        "flash_expected": round(rest + expected),
        "flash_p90": round(rest + expected * words["p90"]),
        "flash_by_class": rest + by_class,
        "resident": round(resident),
        "update": round(rest + expected - resident),
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


def by_feature(objects: Mapping[str, list[Path]]) -> tuple[dict[str, Any], list[str]]:
    """What each feature takes of the whole image, and in which editions it is; what is wrong.

    Wrong is an edition that is not the whole image less what it leaves out.
    """
    editions = {name: {feature.name for feature in compose.read_edition(name).features} for name in EDITIONS}
    linked_ = {name: features.read(objects[name]) for name in EDITIONS}
    whole, always = linked_[WHOLE], set.intersection(*editions.values())
    rows = features.taken(whole, always)
    differences = {
        name: features.difference(whole, own, editions[WHOLE] - editions[name], rows) for name, own in linked_.items()
    }
    figures = {
        "rows": [
            {
                "features": row,
                "flash": round(words.flash),
                "ram": round(words.ram),
                "editions": [name for name, has in editions.items() if not row or has.intersection(row)],
            }
            for row, words in rows.items()
        ],
        "tables": {
            name: round(features.words_of(features.tables(own).values()).flash) for name, own in linked_.items()
        },
    }
    return figures, [
        f"{name} takes {words.flash:.0f} words of flash and {words.ram:.0f} of RAM too many"
        for name, words in differences.items()
        if abs(words.flash) >= 1 or abs(words.ram) >= 1
    ]


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
    folder = out / "build"
    more = [*OTHERS, *(str(Path(name).resolve()) if name.endswith(".txt") else name for name in sys.argv[2:])]
    names = [WHOLE, *(Path(name).stem for name in more)]
    figures: dict[str, dict[str, int]] = {}
    parts: dict[str, dict[str, dict[str, int]]] = {}
    failed, short, beyond = False, [], []
    for edition in names:
        for old in (linked(folder, edition), linked(folder, edition).with_suffix(".out")):  # so that it is linked again
            old.unlink(missing_ok=True)
    try:
        configure(folder, more)
        build(folder)
    except subprocess.CalledProcessError:
        failed = True
    left = {name: json.loads(file.read_text("utf-8")) for name in names if (file := linked(folder, name)).exists()}
    objects = {name: [folder / obj for obj in of.pop("objects")] for name, of in left.items()}
    beyond += changed({name: of.pop("kept") for name, of in left.items()}) if left else []
    of_objects = counted(set().union(*objects.values()))
    for edition, of in left.items():
        parts[edition] = parts_of({obj: of_objects[obj] for obj in objects[edition] if obj in of_objects}, folder)
        figures[edition] = figures_of(of, sum(part["by_class"] for part in parts[edition].values()))
        print(f"{edition}:\n{linked(folder, edition).with_suffix('.map').read_text(encoding='utf-8')}")
        judgement = judged(edition, figures[edition])
        short += judgement[0]
        beyond += judgement[1]
    for name in PROGRAMS if figures else ():
        print(f"{name}:\n{(folder / IMAGES / f'{name}.map').read_text(encoding='utf-8')}")
    if not figures:
        return 1
    budgets = {"editions": {edition: budget(own) for edition, own in figures.items()}}
    (out / "budget.json").write_text(json.dumps(budgets, indent=1), encoding="utf-8")
    found: dict[str, Any] = {
        "editions": {edition: budgets["editions"][edition] for edition in EDITIONS if edition in figures},
        "details": {edition: published(edition, figures[edition]) for edition in EDITIONS if edition in figures},
        "parts": {edition: parts[edition] for edition in EDITIONS if edition in parts},
    }
    if set(EDITIONS) <= objects.keys():
        found["features"], faults = by_feature(objects)
        beyond += faults
    (out / "figures.json").write_text(json.dumps(found), encoding="utf-8")
    for edition, own in budgets["editions"].items():
        print(f"{edition}: " + ", ".join(f"{name} {value}" for name, value in own.items()))
        for part, row in parts[edition].items():
            print(f"  {part:12}" + "".join(f"{name.replace('_', ' '):>12} {value:6}" for name, value in row.items()))
    for row in found.get("features", {}).get("rows", ()):
        name = ", ".join(row["features"]) or "every edition"
        print(f"{name:16} flash {row['flash']:6} RAM {row['ram']:6}  {', '.join(row['editions'])}")
    for line in short:
        print(f"image-check: short: {line}")
    for line in beyond:
        print(f"image-check: {line}")
    return 1 if failed or beyond else 0


if __name__ == "__main__":
    sys.exit(main())
