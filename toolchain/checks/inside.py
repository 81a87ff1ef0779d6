"""Tests of the firmware see the drive by names of the field, and know in one place where each lies in it.

Who moves a member of the drive moves one line of FACE, not what every test says.
"""

import re
from pathlib import Path

from checks import Finding
from checks.calls import code

FACE = "tests/firmware/inside.hpp"
_MEMBER = re.compile(r"(?<![\w.>/])drive\s*\.\s*\w")


def _lines(text: str) -> list[int]:
    return sorted({text.count("\n", 0, match.start()) + 1 for match in _MEMBER.finditer(text)})


def check(root: Path) -> list[Finding]:
    """Findings for every line of a test that reaches into the drive by itself."""
    tests = {p.relative_to(root).as_posix(): p for p in sorted((root / "tests/firmware").glob("*.[ch]pp"))}
    return [
        Finding(source, line, f"a member of the drive: {FACE} has, or gets, a name for it")
        for source, path in tests.items()
        if source != FACE
        for line in _lines(code(path))
    ]
