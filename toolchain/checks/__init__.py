"""Checks of the source tree that no compiler makes: who includes whom, 16-bit arithmetic, links of the book.

Each check is a function from the root of the tree to a list of findings; an empty list is a pass.
``toolchain/check.py`` runs them.
"""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong: the file (relative to the root), the line (0: the whole file), and what to do."""

    path: str
    line: int
    message: str

    def __str__(self) -> str:
        place = f"{self.path}:{self.line}" if self.line else self.path
        return f"{place}: {self.message}"


def left(file: Path) -> dict[tuple[str, str], int]:
    """What a list of exceptions bears, ``file: what what``: file and what, with the line that says so."""
    known = {}
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines() if file.exists() else [], start=1):
        source, colon, what = line.partition("#")[0].partition(":")
        known |= {(source.strip(), each): number for each in what.split() if colon}
    return known
