"""The reference page of all parameters, from their list, the editions' and what docs/what_you_see.toml says of them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import compose
from board_table import read
from row_lists import Lists, rows

UNITS, SEEN = "firmware/dictionary/unit_list.h", "docs/what_you_see.toml"
BOARD = "hal/boards/bench.h"
EDITIONS = "firmware/editions"
ACCESS = {"STOPPED": "may change only while the power stage is off", "ALWAYS": "may change at any time"}
WHO = {
    "you": "for you to tune",
    "motor": "of the motor: set it before the first start",
    "board": "of the board: as it is built and wired",
    "found": "found by [commissioning](commissioning.md)",
    "papers": "for comparisons with the papers: leave it alone",
}
_HEADING = re.compile(r"(?:^|\n\n)// (?P<title>[^\n]+)\n", re.MULTILINE)


@dataclass(frozen=True)
class Parameter:
    """A row of the list; numbers as people read them."""

    group: str
    number: str
    name: str
    unit: str
    least: str
    most: str
    default: str
    access: str
    meaning: str


def parameters(root: Path) -> Iterator[Parameter]:
    """All of them, in the order of the list; what the board decides is that of `bench`."""
    board = {name: text.rstrip("u") for name, text in read(root / BOARD).values.items()}
    units = {token: text for token, text, *_ in rows((root / UNITS).read_text(encoding="utf-8"), "UNIT")}
    text = Lists(root).text("parameter_list.h")
    starts = list(_HEADING.finditer(text))
    for k, match in enumerate(starts):
        part = text[match.end() : starts[k + 1].start() if k + 1 < len(starts) else len(text)]
        title = match["title"].partition(" (")[0].partition(":")[0]
        for number, name, unit, _, decimals, *limits, access, meaning in rows(part, "PARAMETER"):
            least, most, default = (_written(board.get(limit, limit), int(decimals)) for limit in limits)
            yield Parameter(title, number, name, units[unit], least, most, default, access, meaning)


def editions(root: Path) -> dict[str, list[str]]:
    """Of parameters that not every edition has, by their numbers: those that have them, the largest first."""
    lists = [compose.read_edition(path.stem, root) for path in sorted((root / EDITIONS).glob("*.txt"))]
    found: dict[str, list[str]] = {}
    for edition in sorted(lists, key=lambda each: -len(each.features)):
        for number in (number for feature in edition.features for number in feature.parameters):
            found.setdefault(str(number), []).append(edition.name)
    return {number: names for number, names in found.items() if len(names) < len(lists)}


def _written(raw: str, decimals: int) -> str:
    return f"{int(raw) / 10**decimals:.{decimals}f}"


def seen(root: Path) -> dict[str, dict[str, str]]:
    """Who sets a parameter and what one sees of it, by its name."""
    return tomllib.loads((root / SEEN).read_text(encoding="utf-8"))


def page(root: Path) -> str:
    """The page below its introduction.

    Raises:
        LookupError: docs/what_you_see.toml is about a parameter that there is not, or leaves one out.
    """
    known, about = list(parameters(root)), seen(root)
    _compare({each.name for each in known}, about)
    groups = list(dict.fromkeys(each.group for each in known))
    within = editions(root)
    # Numbered, so that no group's anchor is a parameter's name.
    return "\n".join(
        line
        for k, group in enumerate(groups, 1)
        for line in (f"## {k}. {group}\n", *_group(group, known, about, within))
    )


def _compare(known: set[str], about: dict[str, dict[str, str]]) -> None:
    if gone := about.keys() - known:
        raise LookupError(f"{SEEN} is about parameters that there are not: {', '.join(sorted(gone))}")
    if missing := known - about.keys():
        raise LookupError(f"{SEEN} says nothing of {', '.join(sorted(missing))}")
    for name, entry in about.items():
        if entry.get("who") not in WHO or (entry["who"] == "you" and not entry.get("see")):
            raise LookupError(f"{SEEN}: {name} needs who ({', '.join(WHO)}), and for you also see")


def _group(
    group: str, known: list[Parameter], about: dict[str, dict[str, str]], within: dict[str, list[str]]
) -> Iterator[str]:
    for each in (parameter for parameter in known if parameter.group == group):
        entry = about[each.name]
        unit = f" {each.unit}" if each.unit else ""
        yield f"### {each.name}\n"
        yield f"{each.meaning[0].upper()}{each.meaning[1:]}.\n"
        yield f"- {each.least} … {each.most}{unit}, default {each.default}{unit}; number {each.number}"
        yield f"- {ACCESS[each.access]}; {WHO[entry['who']]}"
        if each.number in within:
            yield f"- editions: {', '.join(f'`{name}`' for name in within[each.number])}"
        yield ""
        if "see" in entry:
            yield f"**What you see:** {entry['see'].strip()}\n"
