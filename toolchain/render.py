#!/usr/bin/env python3
"""Brings the pieces of README.md and the book that are made from data up to date (toolchain/book).

Usage: toolchain/render.py [--check]        --check changes nothing; exit status 1 when a piece is stale
"""

import sys
from pathlib import Path

from book import render

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    """Write, or check."""
    check = sys.argv[1:] == ["--check"]
    stale = [piece for piece in render(ROOT, write=not check) if not piece.is_fresh]
    for piece in stale:
        print(f"{piece.page}:{piece.line}: {piece.name} {'is stale' if check else 'renewed'}")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
