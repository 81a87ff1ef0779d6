#!/usr/bin/env python3
"""Runs a command of the Makefile, keeps what it measured as a record, and brings the tables made from it up to date.

Usage: toolchain/keep.py NAME [COMMAND...]        NAME: one of COMMANDS in toolchain/book/records.py

What a command measured is kept when it fails, too: a count beyond its limit is what the book has to say. The exit
status is the command's. Without a command what lies there is kept.
"""

import json
import subprocess
import sys
import time
from pathlib import Path

from book import records, render

ROOT = Path(__file__).resolve().parent.parent


def main(name: str, *command: str) -> int:
    """See the module's text."""
    made = records.COMMANDS[name]
    result, made_of, begun = ROOT / made.result, records.sources_of(ROOT, name), time.time()
    program = [sys.executable] if command and command[0].endswith(".py") else []
    status = subprocess.run([*program, *command], check=False).returncode if command else 0
    if status != 0 and not (result.exists() and result.stat().st_mtime >= begun):
        return status
    figures = records.sums(result) if result.is_dir() else json.loads(result.read_text(encoding="utf-8"))
    figures = figures[made.part] if made.part else figures
    before = records.load(ROOT).get(name, {})
    records.keep(ROOT, name, made.command, figures, made_of)
    if before.get("figures") != figures:
        print(f"{records.FOLDER}/{name}.json: renewed")
    for piece in render(ROOT, write=True):
        if not piece.is_fresh:
            print(f"{piece.page}: {piece.name} renewed")
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
