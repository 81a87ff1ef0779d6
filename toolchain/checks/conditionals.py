"""What the tests run is what is flashed: the drive's C has no part that only one of the two builds sees.

Allowed are include guards, ``__cplusplus`` (headers are read by the C++ side too) and ``#if`` around nothing but an
``#error``. hal/f2808/target.h is the one file in which the native and the DSP build differ.
"""

import re
from pathlib import Path

from checks import Finding
from checks.preprocessor import Directive, lines, sources
from checks.preprocessor import directives as directives_of

FOLDERS = ("hal", "control", "svpwm", "estimators", "firmware")
EXEMPT = {"hal/f2808/target.h"}
_OPENING = {"if", "ifdef", "ifndef"}


def _block(directives: list[Directive], start: int) -> list[Directive]:
    """The directives from the opening one at ``start`` to its #endif."""
    depth = 0
    for end in range(start, len(directives)):
        if directives[end].name in _OPENING:
            depth += 1
        elif directives[end].name == "endif":
            depth -= 1
            if depth == 0:
                return directives[start : end + 1]
    return directives[start:]


def _is_guard(block: list[Directive]) -> bool:
    opening, following = block[0], block[1] if len(block) > 1 else None
    return (
        opening.name == "ifndef"
        and following is not None
        and following.name == "define"
        and following.rest == opening.rest
    )


def _only_errors(block: list[Directive], code: dict[int, str]) -> bool:
    """True when the block holds #error and its own structure, and no code."""
    inside = range(block[0].line, block[-1].line + 1)
    has_code = any(code[n].strip() and not code[n].lstrip().startswith("#") for n in inside if n in code)
    return not has_code and all(d.name in {*_OPENING, "elif", "else", "endif", "error"} for d in block)


def check_text(source: str, text: str) -> list[Finding]:
    """Findings for one file."""
    found = list(directives_of(text))
    code = dict(lines(text))
    findings = []
    for index, directive in enumerate(found):
        if directive.name not in _OPENING:
            continue
        block = _block(found, index)
        is_cplusplus = re.fullmatch(r"(defined)?[ (]*__cplusplus[ )]*", directive.rest) is not None
        if _is_guard(block) or is_cplusplus or _only_errors(block, code):
            continue
        message = f"#{directive.name} {directive.rest}: both builds must compile the same lines; move what differs to "
        findings.append(Finding(source, directive.line, message + "hal/f2808/target.h"))
    return findings


def check(root: Path) -> list[Finding]:
    """Findings for every conditional in the drive's C that is none of the allowed ones."""
    findings = []
    for path in sources(root):
        source = path.relative_to(root).as_posix()
        if source.split("/")[0] in FOLDERS and source not in EXEMPT:
            findings += check_text(source, path.read_text(encoding="utf-8"))
    return findings
