"""Tables as CSV: a head of lines `# key: value` says of what they are, then come the names of the columns, and rows.

Text goes as it is, all else as JSON. `pandas.read_csv(file, comment="#")` leaves the head out.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

_MARK = "# "


def head(about: Mapping[str, Any]) -> str:
    """The lines that say of what a table is, each with its end."""
    return "".join(f"{_MARK}{key}: {_value(value)}\n" for key, value in about.items())


def _value(value: Any) -> str:
    return " ".join(value.split()) if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def heading(name: str, unit: str) -> str:
    """The name of a column, with the unit of its values where they have one."""
    return f"{name} [{unit}]" if unit else name


def text(about: Mapping[str, Any], names: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A whole table."""
    out = io.StringIO()
    out.write(head(about))
    table = csv.writer(out, lineterminator="\n")
    table.writerow(names)
    table.writerows(rows)
    return out.getvalue()


def write(path: Path, about: Mapping[str, Any], names: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """Write a whole table."""
    path.write_text(text(about, names, rows), encoding="utf-8")


def read(path: Path) -> tuple[dict[str, str], list[dict[str, str]]]:
    """What the head says, by key, and the rows, by column; a table without a head is one of which nothing is said."""
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    first = next((at for at, line in enumerate(lines) if not line.startswith(_MARK)), len(lines))
    said = (line.removeprefix(_MARK).rstrip("\n").partition(": ") for line in lines[:first])
    return {key: value for key, _, value in said}, list(csv.DictReader(lines[first:]))
