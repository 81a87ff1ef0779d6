"""From text to words: a program of instructions, labels and directives.

`;` is before a remark, `label:` before what it names, `||` before the instruction that RPT repeats. The directives are

    .org 0x1000          where what follows is
    .sect "name"         the same by name: whoever assembles says where each section begins
    .set COUNT, 8        a name for a value; also as TI has it, COUNT .set 8
    .word 1, COUNT+1     words as they are; .long the same with 32 bits, the lower half first

`.def`, `.ref` and `.global` are read over: all names are known everywhere, those of elsewhere are given. Upper and
lower case are the same.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from stillspin.c28x.assembler import assemble_line
from stillspin.c28x.expression import NAME, evaluated
from stillspin.c28x.table import WORD
from stillspin.errors import InputError

_READ_OVER = (".DEF", ".REF", ".GLOBAL")


@dataclass
class Program:
    """Words by address, and the values of the names, which are in capitals."""

    words: dict[int, int] = field(default_factory=dict)
    symbols: dict[str, int] = field(default_factory=dict)


class _Pass:
    def __init__(self, symbols: Mapping[str, int], sections: Mapping[str, int], final: bool) -> None:
        self.program = Program(symbols=dict(symbols))
        self.sections = {name.upper(): address for name, address in sections.items()}
        self.section = ""
        self.final = final
        self.at = 0

    def evaluate(self, text: str) -> int:
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
        elif name not in _READ_OVER:
            raise InputError(f"'{name}' is no directive")

    def line(self, text: str) -> None:
        text = text.partition(";")[0].strip().upper()
        if match := re.fullmatch(rf"({NAME})\s+\.SET\s+(.+)", text):
            text = f".SET {match[1]},{match[2]}"
        while match := re.match(rf"({NAME}):\s*", text):
            self.program.symbols[match[1]] = self.at
            text = text[match.end() :]
        text = text.removeprefix("||").strip()
        if text.startswith("."):
            name, *rest = text.split(maxsplit=1)
            self.directive(name, re.sub(r"\s", "", "".join(rest)).split(","))
        elif text:
            self.put(assemble_line(text, self.at, self.evaluate))


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
    known = {name.upper(): value for name, value in (symbols or {}).items()}
    for final in (False, True):
        run = _Pass(known, sections or {}, final)
        for number, line in enumerate(source.splitlines(), start=1):
            try:
                run.line(line)
            except (InputError, ValueError, IndexError) as error:
                raise InputError(f"line {number}: {error}") from error
        known = run.program.symbols
    return run.program
