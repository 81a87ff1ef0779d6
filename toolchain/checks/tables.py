"""Tables of figures in README.md and the book are made from data: one that is kept by hand goes stale unseen."""

import re
from collections.abc import Iterator
from pathlib import Path

from book import pages

from checks import Finding

NOT_MEASURED = "<!-- not measured: "
"""Before a table whose numbers are no figures of the drive: what they are."""
_MADE = re.compile(r"<!-- (?P<name>[\w-]+): made by .*?<!-- end of (?P=name) -->", re.DOTALL)
_RULE = re.compile(r"\|[ :|-]+\|")
_ONE = r"[−-]?\d[\d .]*(e-?\d+)?( ?(%|°|µs|ms|s|A|mA|V|W|N m|rad|rpm|cycles|words|instructions|µs|min|steps/s))?"
_NUMBER = re.compile(rf"(\*\*|some )?{_ONE}((;| /|,| of| to| …) ({_ONE}|lost))*(\*\*)?|–|lost|")


def _columns(rows: list[str]) -> list[tuple[str, ...]]:
    cells = [[cell.strip() for cell in row.strip().strip("|").split("|")] for row in rows]
    return list(zip(*cells, strict=False))


def by_hand(text: str) -> Iterator[int]:
    """Lines at which tables begin that no program makes and that have a column of numbers beside the first one."""
    lines = _MADE.sub(lambda made: "\n" * made[0].count("\n"), text).split("\n")
    for k in range(1, len(lines)):
        if not _RULE.fullmatch(lines[k]) or not lines[k - 1].startswith("|"):
            continue
        end = next((j for j in range(k + 1, len(lines)) if not lines[j].startswith("|")), len(lines))
        columns = _columns(lines[k + 1 : end])[1:]
        numbers = [all(map(_NUMBER.fullmatch, column)) and any(map(str.strip, column)) for column in columns]
        if any(numbers) and not any(line.startswith(NOT_MEASURED) for line in lines[max(0, k - 3) : k - 1]):
            yield k


def check(root: Path) -> list[Finding]:
    """A finding for every table of figures that is kept by hand."""
    return [
        Finding(path.relative_to(root).as_posix(), line, "a table of figures that no command makes (toolchain/book)")
        for path in pages(root)
        for line in by_hand(path.read_text(encoding="utf-8"))
    ]
