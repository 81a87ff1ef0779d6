"""Which parameters the control and window interrupts read: none, they have the configuration that is exchanged whole.

A parameter that is set acts at once where it is read; the configuration is changed between two control interrupts, when
all of it fits together. What an interrupt runs is found by name, from its two functions on: what they call, hand on or
look up in a table, the features' rows, what toolchain/f2808/indirect_calls.txt says of calls through pointers, and
macros.
"""

import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import compose
from edition_tables import TABLES

from checks import Finding
from checks.calls import DEFINITION, NAME, code
from checks.preprocessor import directives

INTERRUPTS = ("drive_control_interrupt", "drive_window_interrupt")
POINTERS = "toolchain/f2808/indirect_calls.txt"

_TABLE = re.compile(r"^(static\s)?[A-Za-z_][\w \t*]*?[ *](\w+)(?:\[[^\]\n]*\])*\s*=\s*\{", re.MULTILINE)
_FUNCTIONS = re.compile(  # pointers to them, and no name of their type
    r"^(static\s)?[A-Za-z_][\w \t*]*\(\*(?:const\s+)?(\w+)(?:\[[^\]\n]*\])+\)\([^()]*\)\s*=\s*\{", re.MULTILINE
)
_LOCAL_TABLE = re.compile(r"^[ \t]+static\s[\w \t*]*?[ *](\w+)(?:\[[^\]\n]*\])*\s*=\s*\{", re.MULTILINE)
_POINTER = re.compile(
    r"^[ \t]*(static\s)?[A-Za-z_][\w \t*]*?[ *](\w+)\s*=\s*((?:\([^()]*\)\s*)?&[^;{}]*);", re.MULTILINE
)
_MACRO = re.compile(r"(\w+)(?:\([^)]*\))?\s(.*)")
_READ = re.compile(r"(?<![\w.>])parameters\b(?:\s*\.\s*(\w+))?")


def _named(word: str) -> str:
    """The function or table of a word; of a table that is composed all members count."""
    table, _, member = word.removeprefix("@").rpartition(".")
    return table if any(kind.prefix + key == table for key, kind in TABLES.items()) else member


@dataclass(frozen=True)
class Piece:
    """A function, a table or a macro: where it begins, and its text."""

    source: str
    line: int
    text: str


def _block(text: str, start: int) -> str:
    """From the brace at ``start`` to the one that closes it."""
    depth = 0
    for brace in re.finditer(r"[{}]", text[start:]):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return text[start : start + brace.end()]
    return text[start:]


class Program:
    """What firmware/ is made of, by name: what a file has for itself, and what all may name."""

    def __init__(self, root: Path) -> None:
        self._own: dict[tuple[str, str], list[Piece]] = defaultdict(list)
        self._shared: dict[str, list[Piece]] = defaultdict(list)
        self._pointers: dict[str, list[str]] = {}
        for path in sorted((root / "firmware").rglob("*.[ch]")):
            self._take(path.relative_to(root).as_posix(), path)
        for feature in compose.all_features(root):
            for table in feature.rows:
                name = table if TABLES[table].form == "places" else f"edition_{table}"
                rows = " ".join(row for _, row in feature.places(table))
                source = (feature.folder / compose.FEATURE).relative_to(root).as_posix()
                self._shared[name].append(Piece(source, 1, rows))
        if (root / POINTERS).exists():
            self._take_pointers((root / POINTERS).read_text("utf-8"))

    def _take(self, source: str, path: Path) -> None:
        text = code(path)
        for pattern in (DEFINITION, _TABLE, _FUNCTIONS):
            for match in pattern.finditer(text):
                piece = Piece(source, text.count("\n", 0, match.start()) + 1, _block(text, match.end() - 1))
                own = bool(match[1]) and source.endswith(".c")
                (self._own[source, match[2]] if own else self._shared[match[2]]).append(piece)
        for match in _LOCAL_TABLE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            self._own[source, match[1]].append(Piece(source, line, _block(text, match.end() - 1)))
        for match in _POINTER.finditer(text):
            if match[1] or not match[0][0].isspace():  # one that outlives its function
                line = text.count("\n", 0, match.start(3)) + 1
                self._own[source, match[2]].append(Piece(source, line, match[3]))
        for directive in directives(text):
            if directive.name == "define" and (macro := _MACRO.match(directive.rest)):
                piece = Piece(source, directive.line, macro[2])
                (self._own[source, macro[1]] if source.endswith(".c") else self._shared[macro[1]]).append(piece)

    def _take_pointers(self, table: str) -> None:
        mode = ""
        for line in table.splitlines():
            content = line.partition("#")[0].strip()
            if content.startswith("["):
                mode = content
            caller, arrow, called = content.partition("->")
            if arrow and mode in {"", "[drive]"}:
                names = [_named(word) for word in re.sub(r"\d+ x ", "", called).split()]
                self._pointers.setdefault(caller.strip(), []).extend(names)

    def named(self, source: str, name: str) -> list[Piece]:
        """What ``name`` means in the file ``source``."""
        return self._own.get((source, name)) or self._shared.get(name, [])

    def _anywhere(self, name: str) -> list[Piece]:
        own = [piece for (_, own_name), pieces in self._own.items() if own_name == name for piece in pieces]
        return own + self._shared.get(name, [])

    def reached(self, starts: tuple[str, ...]) -> dict[Piece, str]:
        """All that runs when those do, with its names."""
        found: dict[Piece, str] = {}
        ahead = [(name, piece) for name in starts for piece in self._anywhere(name)]
        while ahead:
            name, piece = ahead.pop()
            if piece in found:
                continue
            found[piece] = name
            inner = {match[0] for match in NAME.finditer(piece.text)}
            ahead += [(other, p) for other in inner for p in self.named(piece.source, other)]
            ahead += [(other, p) for other in self._pointers.get(name, []) for p in self._anywhere(other)]
        return found


def reads(root: Path) -> Iterator[tuple[str, int, str, str]]:
    """File, line, parameter and function of all that an interrupt reads."""
    for piece, name in Program(root).reached(INTERRUPTS).items():
        for match in _READ.finditer(piece.text):
            yield piece.source, piece.line + piece.text.count("\n", 0, match.start()), match[1] or "parameters", name


def check(root: Path) -> list[Finding]:
    """Findings for parameters read in an interrupt."""
    return [
        Finding(source, line, f"{name}, which an interrupt runs, reads {what}: it may read the configuration alone")
        for source, line, what, name in sorted(set(reads(root)))
    ]
