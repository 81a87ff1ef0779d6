"""What in the book and in README.md is made from data: pieces of pages between two marks.

    <!-- NAME: made by toolchain/render.py -->
    … the piece …
    <!-- end of NAME -->

A piece is either a template, toolchain/book/pieces/NAME.md.j2, filled with the figures that runs have given
(docs/figures/*.json), or made by a function that is named in PIECES.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from book import c28x, figures, parameters
from stillspin import exit_codes

PIECES: dict[str, Callable[[Path], str]] = {
    "parameters": parameters.page,
    "c28x-instructions": c28x.page,
    "c28x-counts": c28x.counts,
    "exit-codes": lambda _root: exit_codes.table(),
}
_PIECE = re.compile(
    r"(?P<begin><!-- (?P<name>[\w-]+): made by toolchain/render\.py -->\n)"
    r"(?P<body>.*?)(?P<end><!-- end of (?P=name) -->)",
    re.DOTALL,
)


@dataclass(frozen=True)
class Piece:
    """A piece of a page.

    Attributes:
        page: relative to the repository; line: of its first mark.
        name: of the piece; is_fresh: whether it stands there as its data make it.
    """

    page: str
    line: int
    name: str
    is_fresh: bool


def _made(root: Path, name: str) -> str:
    body = PIECES[name](root) if name in PIECES else figures.piece(root, name)
    return "\n".join(line.rstrip() for line in body.strip("\n").split("\n")) + "\n"


def pages(root: Path) -> list[Path]:
    """README.md and the pages of the book."""
    return [root / "README.md", *sorted((root / "docs").rglob("*.md"))]


def render(root: Path, *, write: bool = False) -> Iterator[Piece]:
    """Every piece of every page; with `write` the pages are brought up to date.

    Raises:
        LookupError: a piece that nothing makes, or a figure that there is not.
    """
    for path in pages(root):
        text = path.read_text(encoding="utf-8")
        fresh = _PIECE.sub(lambda match: match["begin"] + _made(root, match["name"]) + match["end"], text)
        for match in _PIECE.finditer(text):
            name, line = match["name"], text.count("\n", 0, match.start()) + 1
            yield Piece(path.relative_to(root).as_posix(), line, name, match["body"] == _made(root, name))
        if write and fresh != text:
            path.write_text(fresh, encoding="utf-8")
