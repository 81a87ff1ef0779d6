"""Nobody asks which position source is chosen: a source says of itself what others have to know (interfaces/source.h).

``position_source``, and the names of its values, stand in firmware/ as what a table is looked up by, and nowhere else;
the row that the table gives is compared with no other, by whatever name it has been given in a function; whether there
is one may be asked.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from checks import Finding
from checks.calls import code

TABLE = "position_sources"
NAMES = "firmware/dictionary/parameters.h"  # of the values
_ENUM = re.compile(r"enum\s*\{([^}]*\bPOSITION_ENCODER\b[^}]*)\}")
_LOOKED_UP = re.compile(rf"\b(?:{TABLE}\s*\[[^\]]*\]|position_source_variants\s*\[[^\]]*\](?!\s*[=!<>]))")
_ROW = r"(?:&\s*\w+_source\b|\bedition_\w+_source\b(?!\s*->))"
_COMPARED = re.compile(rf"[=!]=\s*(?:{_ROW}|{TABLE}\b)|(?:{_ROW}|{TABLE}\s*\[[^\]]*\])\s*[=!]=")
_NAMED = r"((?:\w+(?:->|\.))*\w+)\s*=\s*(?:{})"  # an expression that such a row is assigned to


def _names(body: str) -> set[str]:
    """What means a row of the table in the rest of a function, by way of other names as well."""
    found: set[str] = set()
    rows = [_ROW, rf"{TABLE}\s*\[[^\]]*\]"]
    while fresh := set(re.findall(_NAMED.format("|".join(rows)), body)) - found:
        found |= fresh
        rows += [rf"{re.escape(name)}\b(?!\s*(?:->|\.))" for name in fresh]
    return found


def _compared_by_name(text: str) -> Iterator[int]:
    """Where a row is compared by a name that it has, with anything but NULL."""
    start = 0
    for end in (match.end() for match in re.finditer(r"^(?:\S.*)?\}$|\Z", text, re.MULTILINE)):
        body = text[start:end]
        for name in map(re.escape, _names(body)):
            asked = rf"(?<!NULL)(?<!NULL )[=!]=\s*{name}\b(?!\s*(?:->|\.))|(?<![\w.>]){name}\s*[=!]=(?!\s*NULL\b)"
            yield from (start + match.start() for match in re.finditer(asked, body))
        start = end


def _values(root: Path) -> list[str]:
    enum = _ENUM.search(code(path)) if (path := root / NAMES).exists() else None
    return re.findall(r"\b(POSITION_\w+)", enum[1]) if enum else []


def _asked(text: str, values: list[str]) -> Iterator[int]:
    """Where a source, or its number, is asked for."""
    names = re.compile(rf"(?:\.|->)\s*position_source\b|\b(?:{'|'.join(['ID_position_source', *values])})\b")
    yield from (match.start() for match in _COMPARED.finditer(text))
    yield from _compared_by_name(text)
    rest = _LOOKED_UP.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    yield from (match.start() for match in names.finditer(rest))


def check(root: Path) -> list[Finding]:
    """Findings for every place where a source, or its number, is asked for."""
    values = _values(root)
    findings = []
    for path in sorted((root / "firmware").rglob("*.[ch]")):
        source = path.relative_to(root).as_posix()
        if source == NAMES:
            continue
        text = code(path)
        for line in sorted({text.count("\n", 0, at) + 1 for at in _asked(text, values)}):
            message = "asks which position source is chosen: what it has to know is a trait or a hook of the source"
            findings.append(Finding(source, line, message))
    return findings
