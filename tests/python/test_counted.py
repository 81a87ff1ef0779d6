"""Numbers of things: one is one, and one function says so everywhere."""

import re
from pathlib import Path

import pytest

from stillspin.counted import counted

PACKAGE = Path(__file__).resolve().parents[2] / "sim_host" / "stillspin"
BY_HAND = re.compile(
    r"\} (run|parameter|sample|fault|record|step|goal|octet|word|value|figure|start|check|change|signal|scenario|motor"
    r"|board|file|frame)s\b(?!/)"
)
FOR_RANGES = re.compile(r"a (stream|scope) of \{|\d … ")
"""Only where the number is out of a range that begins at 1: "a stream of 9 signals"."""


@pytest.mark.parametrize(
    ("said", "words"),
    [
        (counted(0, "run"), "0 runs"),
        (counted(1, "run"), "1 run"),
        (counted(2, "run"), "2 runs"),
        (counted(1, "parameter", 2), "1 of 2 parameters"),
        (counted(0, "parameter", 1), "0 of 1 parameter"),
    ],
)
def test_the_noun_goes_with_the_number(said, words):
    assert said == words


def test_nobody_makes_a_plural_by_hand():
    found = [
        f"{path.relative_to(PACKAGE)}: {line.strip()}"
        for ending in ("py", "js", "j2")
        for path in sorted(PACKAGE.rglob(f"*.{ending}"))
        for line in path.read_text().splitlines()
        if BY_HAND.search(line) and not FOR_RANGES.search(line)
    ]
    assert found == []
