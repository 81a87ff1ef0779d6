"""What README.md and the book have from data, pieces of pages and pictures, is as what makes it left it."""

from pathlib import Path

from book import records, render

from checks import Finding


def check(root: Path) -> list[Finding]:
    """A finding for every piece that is stale, or that nothing makes, and every picture that is another."""
    try:
        stale = [piece for piece in render(root) if not piece.is_fresh]
    except LookupError as error:
        return [Finding("toolchain/book", 1, str(error))]
    kept = records.load(root).get("pictures", {}).get("figures")
    there = records.sums(root / records.PICTURES)
    others = sorted(name for name in {*kept, *there} if kept.get(name) != there.get(name)) if kept else []
    changed = [Finding(f"{records.PICTURES}/{name}", 1, "is not as make pictures left it") for name in others]
    return changed + [Finding(p.page, p.line, f"{p.name} is stale: run toolchain/render.py") for p in stale]
