"""Preprocessor lines of C and C++ files, with comments and line continuations out of the way."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

SOURCE_FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware", "sim_host")
SUFFIXES = {".c", ".h", ".cpp", ".hpp", ".cc", ".hh", ".inc"}

# A string or character literal is matched so that a // inside it does not start a comment.
_COMMENT_OR_LITERAL = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*([a-z_]+)[ \t]*(.*?)[ \t]*$")


@dataclass(frozen=True)
class Directive:
    """``#name rest`` on line ``line`` (1 is the first)."""

    line: int
    name: str
    rest: str


def sources(root: Path) -> list[Path]:
    """All C and C++ files of the six source folders, in a stable order."""
    found = (path for folder in SOURCE_FOLDERS for path in (root / folder).rglob("*"))
    return sorted(path for path in found if path.suffix in SUFFIXES and path.is_file())


def without_comments(text: str) -> str:
    """``text`` with comments blanked out; line numbers stay."""

    def blank(match: re.Match[str]) -> str:
        token = match.group()
        return re.sub(r"[^\n]", " ", token) if token.startswith("/") else token

    return _COMMENT_OR_LITERAL.sub(blank, text)


def lines(text: str) -> Iterator[tuple[int, str]]:
    """Logical lines: (number of the first physical line, text with continuations joined)."""
    start, parts = 1, ""
    for number, line in enumerate(without_comments(text).split("\n"), start=1):
        if not parts:
            start = number
        if line.endswith("\\"):
            parts += line[:-1] + " "
            continue
        yield start, parts + line
        parts = ""
    if parts:
        yield start, parts


def directives(text: str) -> Iterator[Directive]:
    """Every preprocessor line of ``text``."""
    for number, line in lines(text):
        match = _DIRECTIVE.match(line)
        if match:
            yield Directive(number, match[1], match[2])
