"""From text to words: a program of instructions, labels and directives.

`;` is before a remark, `label:` before what it names, `||` before the instruction that RPT repeats, on its line or the
next. The directives are

    .org 0x1000          where what follows is
    .sect "name"         the same by name: whoever assembles says where each section begins
    .set COUNT, 8        a name for a value; also as TI has it, COUNT .set 8
    .word 1, COUNT+1     words as they are; .long the same with 32 bits, the lower half first
    .copy "start.asm"    the lines of another file, beside the one that says so; only of a file, not of a text

`$` is the address of what it stands in. All names are known everywhere, those of elsewhere are given: `.ref` is read
over, and what `.def` or `.global` name a linked file tells others. Upper and lower case are the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from stillspin.c28x.assembler import assemble_line
from stillspin.c28x.expression import NAME, evaluated
from stillspin.c28x.macros import Expansion, ExpansionError
from stillspin.c28x.table import WORD
from stillspin.errors import InputError

_TOLD = (".DEF", ".GLOBAL")
_READ_OVER = ".REF"
_REPEATED = re.compile(r"(RPT\s[^|]+)\|\|(.+)")
_HERE = re.compile(r"(?<![\w$])\$(?![\w$])")


class Line(NamedTuple):
    """A line of a source file, the first is 1. A text without a file has the name ''."""

    file: str
    number: int


@dataclass
class Program:
    """Words by address, the lines of their instructions, and the values of the names, which are in capitals."""

    words: dict[int, int] = field(default_factory=dict)
    symbols: dict[str, int] = field(default_factory=dict)
    labels: dict[str, int] = field(default_factory=dict)
    """Those of the names that are places in code, as they are written."""
    told: set[str] = field(default_factory=set)
    lines: dict[int, Line] = field(default_factory=dict)
    """By the address of each instruction."""


class _Pass:
    def __init__(self, symbols: Mapping[str, int], sections: Mapping[str, int], final: bool) -> None:
        self.program = Program(symbols=dict(symbols))
        self.sections = {name.upper(): address for name, address in sections.items()}
        self.section = ""
        self.final = final
        self.at = 0

    def evaluate(self, text: str) -> int:
        text = _HERE.sub(str(self.at), text)
        try:
            return evaluated(text, self.program.symbols)
        except ValueError:
            if self.final or not re.search(NAME, text):
                raise
            return self.at  # a name that comes later: near enough for the choice of a form

    def put(self, words: list[int]) -> None:
        for word in words:
            if self.final and self.at in self.program.words:
                raise InputError(f"two words are at {self.at:#x}")
            self.program.words[self.at] = word & 0xFFFF
            self.at += 1

    def enter(self, name: str) -> None:
        if name not in self.sections:
            raise InputError(f"nobody says where section {name} is")
        self.sections[self.section] = self.at
        self.section, self.at = name, self.sections[name]

    def directive(self, name: str, arguments: list[str]) -> None:
        if name == ".SET":
            self.program.symbols[arguments[0]] = self.evaluate(arguments[1])
        elif name == ".ORG":
            self.at = self.evaluate(arguments[0])
        elif name == ".SECT":
            self.enter(arguments[0].strip('"'))
        elif name == ".WORD":
            self.put([self.evaluate(text) for text in arguments])
        elif name == ".LONG":
            for text in arguments:
                value = self.evaluate(text)
                self.put([value & 0xFFFF, value >> WORD])
        elif name in _TOLD:
            self.program.told.update(arguments)
        elif name != _READ_OVER:
            raise InputError(f"'{name}' is no directive")

    def line(self, text: str, where: Line) -> None:
        written = text.partition(";")[0].strip()
        text = written.upper()
        if match := re.fullmatch(rf"({NAME})\s+\.SET\s+(.+)", text):
            text = f".SET {match[1]},{match[2]}"
        while match := re.match(rf"({NAME}):\s*", text):
            self.program.symbols[match[1]] = self.at
            text = text[match.end() :]
            label, _, written = written.partition(":")
            self.program.labels[label.strip()] = self.at
        text = text.removeprefix("||").strip()
        if text.startswith("."):
            name, *rest = text.split(maxsplit=1)
            self.directive(name, re.sub(r"\s", "", "".join(rest)).split(","))
            return
        repeated = _REPEATED.fullmatch(text)
        for instruction in filter(None, repeated.groups() if repeated else (text,)):
            self.program.lines[self.at] = where
            self.put(assemble_line(instruction, self.at, self.evaluate))


def _read(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: is no text (UTF-8); give the source of the program") from error


def _lines(source: str, name: str, folder: Path | None) -> Iterator[tuple[Line, str]]:
    """Those of a text, in the place of `.copy` those of the file."""
    for number, text in enumerate(source.splitlines(), start=1):
        match = re.fullmatch(r'\s*\.copy\s+"(.+)"\s*(;.*)?', text, re.IGNORECASE)
        if match is None or folder is None:
            yield Line(name, number), text
            continue
        other = folder / match[1]
        if other.name == name:
            raise InputError(f"{name}, line {number}: the file copies itself")
        yield from _lines(_read(other), other.name, other.parent)


def _expanded(lines: list[tuple[Line, str]], known: Mapping[str, int]) -> list[tuple[Line, str]]:
    """With macros filled in, and without what no condition wants."""
    expansion: Expansion[Line] = Expansion(known)
    try:
        made = list(expansion.lines(lines))
        expansion.end()
    except ExpansionError as error:
        where = error.where if isinstance(error.where, Line) else lines[-1][0]
        raise InputError(f"{_named(where)}: {error}") from error
    return made


def _named(where: Line) -> str:
    return f"{where.file}, line {where.number}" if where.file else f"line {where.number}"


def _assemble(
    lines: list[tuple[Line, str]], sections: Mapping[str, int] | None, symbols: Mapping[str, int] | None
) -> Program:
    known = {name.upper(): value for name, value in (symbols or {}).items()}
    expanded = _expanded(lines, known)
    for final in (False, True):
        run = _Pass(known, sections or {}, final)
        for where, text in expanded:
            try:
                run.line(text, where)
            except (InputError, ValueError, IndexError) as error:
                raise InputError(f"{_named(where)}: {error}") from error
        known = run.program.symbols
    return run.program


def assemble(
    source: str, *, sections: Mapping[str, int] | None = None, symbols: Mapping[str, int] | None = None
) -> Program:
    """A program.

    Args:
        source: its text.
        sections: where those of `.sect` begin.
        symbols: names of elsewhere and their values.

    Raises:
        InputError: a line is wrong; it is named.
    """
    return _assemble(list(_lines(source, "", None)), sections, symbols)


def assemble_files(files: list[Path]) -> Program:
    """A program of several files, one after the other, each with those that it copies.

    Raises:
        InputError: a file cannot be read, or a line is wrong; it is named.
    """
    return _assemble([line for file in files for line in _lines(_read(file), file.name, file.parent)], None, None)
