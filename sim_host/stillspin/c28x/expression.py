"""Values of expressions: numbers and names with +, -, << and >>, from left to right."""

from __future__ import annotations

import re
from collections.abc import Mapping

NAME = r"[A-Z_$][\w$]*"
_TOKEN = re.compile(
    rf"(?P<way>[+-]|<<|>>)?(?:0X(?P<hex>[0-9A-F]+)|(?P<end>[0-9][0-9A-F]*)H|(?P<number>\d+)|(?P<name>{NAME}))"
)
_WAYS = {
    "+": lambda left, right: left + right,
    "-": lambda left, right: left - right,
    "<<": lambda left, right: left << right,
    ">>": lambda left, right: left >> right,
}


def evaluated(text: str, symbols: Mapping[str, int] | None = None) -> int:
    """The value of an expression in capitals, without blanks.

    Raises:
        ValueError: it is none, or a name has no value.
    """
    value, at = 0, 0
    while at < len(text) or at == 0:
        match = _TOKEN.match(text, at)
        if match is None or (at > 0 and not match["way"]):
            raise ValueError(f"'{text}' is no value")
        at = match.end()
        value = _WAYS[match["way"] or "+"](value, _term(match, symbols or {}))
    return value


def _term(match: re.Match[str], symbols: Mapping[str, int]) -> int:
    if match["name"]:
        if match["name"] not in symbols:
            raise ValueError(f"'{match['name']}' has no value")
        return symbols[match["name"]]
    if match["number"]:
        return int(match["number"])
    return int(match["hex"] or match["end"], 16)
