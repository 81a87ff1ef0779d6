"""Who may include and call whom: an arrow may only point to the same floor's own folder or downward.

The floors are those of docs/architecture.md. A folder that is missing below may be included by nobody outside it.
Inside firmware/ a call counts like an ``#include``: a function that one other folder defines, called, declared or
handed on. What points up there still stands in LEFT, which only shrinks: what nothing needs there is a finding, too.
"""

import posixpath
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import pack_text
import row_lists

from checks import Finding, left
from checks.calls import foreign_calls
from checks.preprocessor import SOURCE_FOLDERS, directives, sources

# The folders of firmware/ from the ground up: each may use those of the lines before its own.
FIRMWARE = (
    ("base",),
    ("text",),
    ("dictionary",),
    ("interfaces",),
    ("mode",),
    ("config",),
    ("api",),
    ("drive",),
    ("start", "sources/observer", "hysteresis", "board", "console", "link", "boot"),
    (
        "commissioning",
        "can",
        "store",
        "scope",
        "hil",
        "console/suggest",
        "start/flying",
        "start/if_start",
        "sources/flux",
        "sources/paper",
    ),
    ("sources/encoder",),
    ("editions",),
)
LEFT = "toolchain/arrows_left.txt"

# What each part may include besides itself: a part or a single file. The longest prefix that fits a path decides which
# part of the house it is in.
_SEAM = ("hal/f2808/registers.h", "hal/f2808/target.h")
_BENCH_HAL = ("hal/hal_replay.h", "hal/hal_board.h", "hal/hal_flash.h", "hal/hal_image.h")
_UNDER_FIRMWARE = ("hal/qmath", "hal", "control", "svpwm", "estimators")
_FOLDERS = tuple(f"firmware/{folder}" for line in FIRMWARE for folder in line)
MAY_INCLUDE: dict[str, tuple[str, ...]] = {
    "hal/qmath": (),
    "control": ("hal/qmath",),
    # Vectors and angles are one vocabulary (frame.h), and so is the machine with its parameters (machine_model.h): both
    # are definitions. Controllers, modulator and estimators do not see each other.
    "svpwm": ("hal/qmath", "control/frame.h"),
    "estimators": ("hal/qmath", "control/frame.h", "control/machine_model.h"),
    "hal": ("hal/qmath",),
    **{
        f"firmware/{folder}": (*_UNDER_FIRMWARE, *(f"firmware/{below}" for under in FIRMWARE[:k] for below in under))
        for k, line in enumerate(FIRMWARE)
        for folder in line
    },
    "firmware/interfaces": _UNDER_FIRMWARE,  # what two floors share is understood without either
    # Programs of their own.
    "firmware/flash_kernel": (
        "hal/qmath",
        "hal",
        "firmware/base",
        "firmware/link/record.h",
        "firmware/link/splitter.h",
    ),
    "firmware/lamp": ("hal/qmath", "hal"),
    "hal/f2808": ("hal/qmath", "hal"),
    # The virtual chip knows the registers and not the firmware; the plant knows neither.
    "sim_host/chip": (*_SEAM, "hal/f2808/flash_library.h"),
    "sim_host/devices": ("sim_host/chip/world.hpp", "sim_host/chip/can_line.hpp"),
    "sim_host/plant": ("sim_host/chip/world.hpp",),
    # The bench joins them. It looks into the firmware to read, so that a test can tell what the drive thought.
    "sim_host/bench": (
        "sim_host/chip",
        "sim_host/devices",
        "sim_host/plant",
        *_FOLDERS,
        "firmware/flash_kernel",
        *_BENCH_HAL,
        *_SEAM,
    ),
}

# C code of the drive has no C library: only headers that a freestanding compiler brings.
_FREESTANDING = {"stdint.h", "stdbool.h", "stddef.h", "limits.h"}

_TARGET = re.compile(r'^([<"])([^>"]+)[>"]')


@dataclass(frozen=True)
class Arrow:
    """One that points where it may not: from a file and line to a file or a function, and what is wrong with it."""

    source: str
    line: int
    target: str
    message: str


def part_of(path: str) -> str | None:
    """The part of the house that ``path`` (relative, with /) is in, or None."""
    fitting = (part for part in MAY_INCLUDE if path.startswith(part + "/"))
    return max(fitting, key=len, default=None)


def _resolve(root: Path, source: str, name: str) -> str | None:
    """The file of the tree that ``name``, included by ``source``, means: beside it or from the root."""
    if name in {pack_text.NUMBERS, *(of.header for of in row_lists.JOINED.values())}:
        return name  # the build makes it
    for base in (posixpath.dirname(source), ""):
        candidate = posixpath.normpath(posixpath.join(base, name))
        if (root / candidate).is_file():
            return candidate
    return None


def _is_allowed(source_part: str, target: str) -> bool:
    target_part = part_of(target)
    if target_part == source_part:
        return True
    allowed = MAY_INCLUDE[source_part]
    return target in allowed or target_part in allowed


def _rule_of(part: str) -> str:
    return f"{part} may include {', '.join(MAY_INCLUDE[part]) or 'nothing else'}"


def _judge_outside(source: str, bracket: str, name: str) -> str | None:
    """The same for a header that is not in the tree."""
    if PurePosixPath(name).parts[0] in SOURCE_FOLDERS:
        return f"#include of {name}, which does not exist"
    if source.startswith("sim_host/") or (bracket == "<" and name in _FREESTANDING):
        return None
    return f"#include of {name}: the drive's C has no C library, only {', '.join(sorted(_FREESTANDING))}"


def _judge(root: Path, source: str, rest: str) -> tuple[str, str] | None:
    """What ``#include rest`` in ``source`` aims at and what is wrong with it; None when nothing is."""
    match = _TARGET.match(rest)
    if not match:
        return rest, f"#include {rest}: the name must be written out, this check cannot follow a macro"
    bracket, name = match.groups()
    target = _resolve(root, source, name)
    if target is None:
        outside = _judge_outside(source, bracket, name)
        return (name, outside) if outside else None
    source_part = part_of(source)
    if source_part is None:
        return target, f"this file is in no part of the house: add its folder to {__name__}"
    if _is_allowed(source_part, target):
        return None
    return target, f"#include of {target}: {_rule_of(source_part)}"


def _includes(root: Path) -> Iterator[Arrow]:
    for path in sources(root):
        source = path.relative_to(root).as_posix()
        for directive in directives(path.read_text(encoding="utf-8")):
            judged = _judge(root, source, directive.rest) if directive.name == "include" else None
            if judged:
                yield Arrow(source, directive.line, *judged)


def _calls(root: Path) -> Iterator[Arrow]:
    for call in foreign_calls(root, "firmware"):
        part = part_of(call.source)
        if part and not _is_allowed(part, str(PurePosixPath(call.defined).with_suffix(".h"))):
            message = f"{call.name}() of {call.defined}: {_rule_of(part)}"
            yield Arrow(call.source, call.line, f"{call.name}()", message)


def arrows_up(root: Path) -> list[Arrow]:
    """All that points up a floor, sideways, or nowhere."""
    return sorted({*_includes(root), *_calls(root)}, key=lambda arrow: (arrow.source, arrow.line, arrow.target))


def check(root: Path) -> list[Finding]:
    """Findings for every arrow that points up a floor, sideways, or nowhere, and for exceptions that nothing needs."""
    found, borne = arrows_up(root), left(root / LEFT)
    needed = {(arrow.source, arrow.target) for arrow in found}
    findings = [Finding(a.source, a.line, a.message) for a in found if (a.source, a.target) not in borne]
    for (source, target), line in borne.items():
        if (source, target) not in needed:
            findings.append(Finding(LEFT, line, f"{source} no longer needs {target}: take it out"))
    return findings
