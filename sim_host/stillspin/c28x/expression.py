"""Values of expressions: numbers, names and parentheses with the operators of C that assemblers have, and C's order."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping

NAME = r"[A-Z_$][\w$]*"
_TOKEN = re.compile(
    r"0X(?P<hex>[0-9A-F]+)|(?P<end>[0-9][0-9A-F]*)H\b|(?P<number>\d+)|"
    rf"(?P<name>{NAME})|(?P<sign><<|>>|<=|>=|==|!=|[-+*/&|^()<>])"
)
_Way = Callable[[int, int], int]
_LEVELS: tuple[dict[str, _Way], ...] = (
    {"|": operator.or_},
    {"^": operator.xor},
    {"&": operator.and_},
    {"==": operator.eq, "!=": operator.ne},
    {"<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge},
    {"<<": operator.lshift, ">>": operator.rshift},
    {"+": operator.add, "-": operator.sub},
    {"*": operator.mul, "/": operator.floordiv},
)
"""From the loosest to the tightest."""
_FARTHEST_SHIFT = 64


def evaluated(text: str, symbols: Mapping[str, int] | None = None) -> int:
    """The value of an expression in capitals, without blanks.

    Raises:
        ValueError: it is none, or a name has no value.
    """
    reader = _Reader(text, symbols or {})
    value = reader.level(0)
    if reader.at < len(reader.tokens):
        raise ValueError(f"'{text}' is no value")
    return value


class _Reader:
    def __init__(self, text: str, symbols: Mapping[str, int]) -> None:
        self.text, self.symbols, self.at = text, symbols, 0
        self.tokens: list[re.Match[str]] = []
        place = 0
        while place < len(text):
            match = _TOKEN.match(text, place)
            if match is None:
                raise ValueError(f"'{text}' is no value")
            self.tokens.append(match)
            place = match.end()

    def _next(self) -> str:
        return self.tokens[self.at][0] if self.at < len(self.tokens) else ""

    def level(self, number: int) -> int:
        if number == len(_LEVELS):
            return self._term()
        value = self.level(number + 1)
        while self._next() in _LEVELS[number]:
            way = self._next()
            self.at += 1
            value = self._combined(way, _LEVELS[number][way], value, self.level(number + 1))
        return value

    def _combined(self, way: str, combine: _Way, left: int, right: int) -> int:
        wrong_shift = way in {"<<", ">>"} and not 0 <= right <= _FARTHEST_SHIFT
        if wrong_shift or (way == "/" and right == 0):
            raise ValueError(f"'{self.text}' has no value: {way} {right}")
        return int(combine(left, right))

    def _term(self) -> int:
        if self.at == len(self.tokens):
            raise ValueError(f"'{self.text}' is no value")
        match = self.tokens[self.at]
        self.at += 1
        if match["name"]:
            if match["name"] not in self.symbols:
                raise ValueError(f"'{match['name']}' has no value")
            return self.symbols[match["name"]]
        if match["number"]:
            return int(match["number"])
        if match["hex"] or match["end"]:
            return int(match["hex"] or match["end"], 16)
        if match[0] in {"-", "+"}:
            value = self._term()
            return -value if match[0] == "-" else value
        if match[0] != "(":
            raise ValueError(f"'{self.text}' is no value")
        value = self.level(0)
        if self._next() != ")":
            raise ValueError(f"'{self.text}' lacks a parenthesis")
        self.at += 1
        return value
