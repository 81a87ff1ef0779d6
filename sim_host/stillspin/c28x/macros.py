"""What an assembler does before it assembles: macros with parameters, and lines under conditions.

    TWICE   .macro value        from here to .endm; written as an instruction, with values for the parameters
            .if COUNT > 4       .elseif, .else, .endif; names are those given and those of .set above

A condition is looked at once, so that a name which comes later has no value in it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Generic, NamedTuple, TypeVar

from stillspin.c28x.expression import NAME, evaluated
from stillspin.counted import counted

_DEEPEST = 32
"""Macros in macros."""
Where = TypeVar("Where")


class ExpansionError(Exception):
    """What is wrong with a line, and where that stands; None for the end of the program."""

    def __init__(self, text: str, where: object) -> None:
        """Both."""
        super().__init__(text)
        self.where = where


class _Macro(NamedTuple, Generic[Where]):
    parameters: list[str]
    body: list[tuple[Where, str]]


def _bare(text: str) -> str:
    return text.partition(";")[0].strip()


def _directive(text: str) -> tuple[str, str]:
    """The first word in capitals, and the rest without blanks."""
    first, *rest = _bare(text).split(None, 1) or [""]
    return first.upper(), re.sub(r"\s", "", "".join(rest))


class Expansion(Generic[Where]):
    """Goes through the lines of a program once."""

    def __init__(self, symbols: Mapping[str, int]) -> None:
        """With the names that are given from outside, in capitals."""
        self._symbols = dict(symbols)
        self._macros: dict[str, _Macro[Where]] = {}
        self._conditions: list[tuple[bool, bool]] = []
        """Of each `.if` around: whether its lines count now, and whether some of it has counted."""

    def lines(self, given: Iterable[tuple[Where, str]], depth: int = 0) -> Iterator[tuple[Where, str]]:
        """The lines that are to be assembled; each says where it stands in the source.

        Raises:
            ExpansionError: a macro that does not end or goes on for ever, a condition that has no value.
        """
        source = iter(given)
        for where, text in source:
            try:
                yield from self._line(where, text, source, depth)
            except ValueError as error:
                raise ExpansionError(str(error), where) from error

    def end(self) -> None:
        """After the last line. ExpansionError: an `.if` is open."""
        if self._conditions:
            raise ExpansionError("an .if has no .endif", None)

    def _line(
        self, where: Where, text: str, source: Iterator[tuple[Where, str]], depth: int
    ) -> Iterator[tuple[Where, str]]:
        first, rest = _directive(text)
        if self._condition(first, rest) or not all(counts for counts, _ in self._conditions):
            return
        if match := re.fullmatch(rf"({NAME})\s+\.MACRO(\s+(.*))?", _bare(text).upper()):
            names = [name.strip() for name in (match[3] or "").split(",") if name.strip()]
            self._macros[match[1]] = _Macro(names, self._body(source, match[1]))
            return
        if first in self._macros:
            if depth == _DEEPEST:
                raise ValueError(f"macro {first} is within itself")
            yield from self.lines(self._filled(first, rest), depth + 1)
            return
        if match := re.fullmatch(rf"({NAME})\s+\.SET\s+(.+)", _bare(text).upper()):
            self._note(match[1], re.sub(r"\s", "", match[2]))
        yield where, text

    def _note(self, name: str, value: str) -> None:
        try:
            self._symbols[name] = evaluated(value, self._symbols)
        except ValueError:
            self._symbols.pop(name, None)  # of a label below: the assembler will know

    def _condition(self, first: str, rest: str) -> bool:
        """Whether the line is one of a condition."""
        around = all(counts for counts, _ in self._conditions[:-1])
        if first == ".IF":
            counts = all(now for now, _ in self._conditions) and bool(evaluated(rest.upper(), self._symbols))
            self._conditions.append((counts, counts))
            return True
        if first not in {".ELSE", ".ELSEIF", ".ENDIF"}:
            return False
        if not self._conditions:
            raise ValueError(f"{first.lower()} without .if")
        _, was = self._conditions.pop()
        if first != ".ENDIF":
            holds = around and not was and (first == ".ELSE" or bool(evaluated(rest.upper(), self._symbols)))
            self._conditions.append((holds, was or holds))
        return True

    def _body(self, source: Iterator[tuple[Where, str]], name: str) -> list[tuple[Where, str]]:
        body: list[tuple[Where, str]] = []
        for where, text in source:
            if _directive(text)[0] == ".ENDM":
                return body
            body.append((where, text))
        raise ValueError(f"macro {name} has no .endm")

    def _filled(self, name: str, rest: str) -> Iterator[tuple[Where, str]]:
        macro = self._macros[name]
        values = rest.split(",") if rest else []
        if len(values) != len(macro.parameters):
            raise ValueError(f"macro {name} has {counted(len(macro.parameters), 'parameter')}, here are {len(values)}")
        by_name = dict(zip(macro.parameters, values, strict=True))
        for where, text in macro.body:
            yield where, re.sub(r"[A-Za-z_$][\w$]*", lambda word: by_name.get(word[0].upper(), word[0]), text)
