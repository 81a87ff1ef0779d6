#!/usr/bin/env python3
"""Runs the checks of the source tree and says for each whether it passed.

Usage: toolchain/check.py [--fix] [NAME]...     (default: all of them; --fix rewrites files where a tool can)
Exit status 0 when every check passed, 1 when one did not, 2 for a name that is no check.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from checks import (
    Finding,
    arrows,
    circles,
    command_files,
    comparisons,
    conditionals,
    faces,
    glossary,
    inside,
    int16,
    interrupt,
    links,
    packages,
    pieces,
    registers,
    tables,
    writers,
)
from checks.preprocessor import SOURCE_FOLDERS, SUFFIXES

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(sys.executable).parent
PYTHON_TREES = ("sim_host/stillspin", "tests/python", "toolchain")
PYPROJECT = "sim_host/pyproject.toml"


def _formatted_files() -> list[str]:
    trees = (*SOURCE_FOLDERS, "tests")
    files = (path for tree in trees for path in (ROOT / tree).rglob("*") if path.suffix in SUFFIXES)
    return sorted(path.relative_to(ROOT).as_posix() for path in files)


def _commands(fix: bool) -> dict[str, list[list[str]]]:
    """Outside tools, each with its command lines; a non-zero exit status is a failed check."""
    clang_format = ["clang-format", "-i"] if fix else ["clang-format", "--dry-run", "-Werror"]
    ruff = ["ruff", "check", "--quiet", "--config", PYPROJECT, *(["--fix"] if fix else []), *PYTHON_TREES]
    ruff_format = ["ruff", "format", "--quiet", "--config", PYPROJECT, *([] if fix else ["--check"]), *PYTHON_TREES]
    return {
        "format": [[*clang_format, *_formatted_files()]],
        "ruff": [ruff, ruff_format],
        "mypy": [["mypy", "--no-error-summary", "--config-file", PYPROJECT, "-p", "stillspin"]],
        "book": [["mkdocs", "build", "--quiet", "--strict", "--config-file", "toolchain/mkdocs.yml"]],
    }


TREE_CHECKS: dict[str, Callable[[Path], list[Finding]]] = {
    "arrows": arrows.check,
    "faces": faces.check,
    "comparisons": comparisons.check,
    "interrupt": interrupt.check,
    "writers": writers.check,
    "inside": inside.check,
    "circles": circles.check,
    "conditionals": conditionals.check,
    "int16": int16.check,
    "registers": registers.check,
    "linker": command_files.check,
    "links": links.check,
    "glossary": glossary.check,
    "packages": packages.check,
    "pieces": pieces.check,
    "tables": tables.check,
}
DESCRIPTIONS = {
    "arrows": "includes point downward",
    "faces": "the firmware's headers are small",
    "comparisons": "nobody asks which position source is chosen",
    "interrupt": "interrupts read the configuration, no parameters",
    "writers": "what a period has is written by its owner",
    "inside": "tests see the drive by names of the field",
    "circles": "imports in the Python package point downward",
    "conditionals": "no code that only one build sees",
    "int16": "C compiles with a 16-bit int",
    "registers": "the register map agrees with the tables of the chip",
    "linker": "the linker command files keep to the memory of the chip",
    "links": "links and paths in the book exist",
    "glossary": "abbreviations are explained",
    "packages": "every Python package is installed",
    "pieces": "what the book generates is up to date",
    "tables": "no table of figures is kept by hand",
    "format": "clang-format",
    "ruff": "Python lint and format",
    "mypy": "Python types, strict",
    "book": "the book builds",
}


def _run_tool(commands: list[list[str]]) -> list[str]:
    """What the commands printed, for those that failed."""
    complaints = []
    for program, *arguments in commands:
        run = subprocess.run(
            [str(BIN / program), *arguments],
            cwd=ROOT,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            check=False,
        )
        if run.returncode != 0:
            complaints.append(run.stdout.strip() or f"{program} failed with exit status {run.returncode}")
    return complaints


def main(arguments: Sequence[str]) -> int:
    """Runs the named checks; see the module's text."""
    parser = argparse.ArgumentParser(description="Checks of the source tree.")
    parser.add_argument("--fix", action="store_true", help="let the formatters rewrite the files")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(DESCRIPTIONS))
    options = parser.parse_args(arguments)
    unknown = set(options.names) - set(DESCRIPTIONS)
    if unknown:
        parser.error(f"no such check: {', '.join(sorted(unknown))}; there are {', '.join(DESCRIPTIONS)}")
    commands = _commands(options.fix)

    def complaints_of(name: str) -> list[str]:
        return list(map(str, TREE_CHECKS[name](ROOT))) if name in TREE_CHECKS else _run_tool(commands[name])

    names = options.names or list(DESCRIPTIONS)
    failed = False
    # Several at a time, told in their order; one by one where they rewrite what the others read.
    with ThreadPoolExecutor(1 if options.fix else os.cpu_count()) as pool:
        for name, complaints in zip(names, pool.map(complaints_of, names), strict=True):
            print(f"{'FAILED' if complaints else 'ok':7} {name}: {DESCRIPTIONS[name]}", flush=True)
            for complaint in complaints:
                print(complaint, flush=True)
            failed = failed or bool(complaints)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
