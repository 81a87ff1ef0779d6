"""Pieces of README.md and the book that are made from data stand there as their data make them."""

from pathlib import Path

from book import render

from checks import Finding


def check(root: Path) -> list[Finding]:
    """A finding for every piece that is stale, or that nothing makes."""
    try:
        stale = [piece for piece in render(root) if not piece.is_fresh]
    except LookupError as error:
        return [Finding("toolchain/book", 1, str(error))]
    return [Finding(p.page, p.line, f"{p.name} is stale: run toolchain/render.py") for p in stale]
