#!/usr/bin/env python3
"""Keeps what a command of the Makefile measured as a record, and brings the tables made from it up to date.

Usage: toolchain/keep.py NAME        NAME: one of COMMANDS in toolchain/book/records.py
"""

import json
import sys
from pathlib import Path

from book import records, render

ROOT = Path(__file__).resolve().parent.parent


def main(name: str) -> int:
    """See the module's text."""
    made = records.COMMANDS[name]
    result = ROOT / made.result
    figures = records.sums(result) if result.is_dir() else json.loads(result.read_text(encoding="utf-8"))
    before = records.load(ROOT).get(name, {})
    records.keep(ROOT, name, made.command, figures)
    if before.get("figures") != figures:
        print(f"{records.FOLDER}/{name}.json: renewed")
    for piece in render(ROOT, write=True):
        if not piece.is_fresh:
            print(f"{piece.page}: {piece.name} renewed")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
