"""Calls from one file of C to a function that another folder defines, found by name.

A name counts wherever it stands: called, declared, or handed on in a table. What a file has for itself (``static``
functions, variables), members of structures, and names that several folders define do not.
"""

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from checks.preprocessor import without_comments

DEFINITION = re.compile(
    r"^(?!typedef\b)(static\s)?[A-Za-z_][\w \t*]*?[ *](\w+)\((?:[^;{}()]|\([^()]*\))*\)\s*\{", re.MULTILINE
)
_VARIABLE = re.compile(r"(?<!\breturn)[\w*][ ]+\**(\w+)[ ]*[=;)\[]")
_STRING = re.compile(r'"(?:\\.|[^"\\\n])*"')
NAME = re.compile(r"(?<![\w.])(?<!->)[A-Za-z_]\w*")


@dataclass(frozen=True)
class Call:
    """A name in a file and line, and the file that defines it."""

    source: str
    line: int
    name: str
    defined: str


def code(path: Path) -> str:
    """Without comments and texts, line by line as it was; what a table says of a member stays."""
    return _STRING.sub(lambda text: '"' + " " * (len(text[0]) - 2) + '"', without_comments(path.read_text("utf-8")))


def foreign_calls(root: Path, folder: str) -> Iterator[Call]:
    """Each name once a file."""
    texts = {p.relative_to(root).as_posix(): code(p) for p in sorted((root / folder).rglob("*.[ch]")) if p.is_file()}
    own: dict[str, set[str]] = defaultdict(set)
    defined: dict[str, list[str]] = defaultdict(list)
    for source, text in texts.items():
        own[source].update(_VARIABLE.findall(text))
        for static, name in DEFINITION.findall(text):
            if static:
                own[source].add(name)
            else:
                defined[name].append(source)
    for source, text in texts.items():
        seen = set(own[source])
        for match in NAME.finditer(text):
            name = match[0]
            places = defined.get(name, [])
            if name in seen or not places or len({Path(place).parent for place in places}) != 1:
                continue
            seen.add(name)
            if Path(places[0]).parent != Path(source).parent:
                yield Call(source, text.count("\n", 0, match.start()) + 1, name, places[0])
