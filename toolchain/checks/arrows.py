"""Who may include whom: an ``#include`` may only point to the same floor's own folder or downward.

The floors are those of docs/architecture.md. A folder that is missing below may be included by nobody outside it.
"""

import posixpath
import re
from pathlib import Path, PurePosixPath

from checks import Finding
from checks.preprocessor import SOURCE_FOLDERS, directives, sources

# The longest prefix that fits a path decides which part of the house it is in.
PARTS = (
    "hal/qmath",
    "hal/f2808",
    "hal",
    "control",
    "svpwm",
    "estimators",
    "firmware",
    "sim_host/chip",
    "sim_host/devices",
    "sim_host/plant",
    "sim_host/bench",
)

# What each part may include besides itself: a part, a single file, or a pattern with a trailing /*.
_SEAM = ("hal/f2808/registers.h", "hal/f2808/target.h")
_BENCH_HAL = ("hal/hal_tape.h", "hal/hal_board.h", "hal/hal_flash.h", "hal/hal_image.h")
MAY_INCLUDE: dict[str, tuple[str, ...]] = {
    "hal/qmath": (),
    "control": ("hal/qmath",),
    # Vectors and angles are one vocabulary (frame.h), and so is the machine with its parameters (machine_model.h): both
    # are definitions. Controllers, modulator and estimators do not see each other.
    "svpwm": ("hal/qmath", "control/frame.h"),
    "estimators": ("hal/qmath", "control/frame.h", "control/machine_model.h"),
    "hal": ("hal/qmath",),
    "firmware": ("hal/qmath", "hal", "control", "svpwm", "estimators"),
    "hal/f2808": ("hal/qmath", "hal"),
    # The virtual chip knows the registers and not the firmware; the plant knows neither.
    "sim_host/chip": (*_SEAM, "hal/f2808/flash_library.h"),
    "sim_host/devices": ("sim_host/chip/world.hpp", "sim_host/chip/can_line.hpp"),
    "sim_host/plant": ("sim_host/chip/world.hpp",),
    # The bench joins them. It looks into the firmware to read, so that a test can tell what the drive thought.
    "sim_host/bench": ("sim_host/chip", "sim_host/devices", "sim_host/plant", "firmware", *_BENCH_HAL, *_SEAM),
}

# C code of the drive has no C library: only headers that a freestanding compiler brings.
_FREESTANDING = {"stdint.h", "stdbool.h", "stddef.h", "limits.h"}

_TARGET = re.compile(r'^([<"])([^>"]+)[>"]')


def part_of(path: str) -> str | None:
    """The part of the house that ``path`` (relative, with /) is in, or None."""
    fitting = (part for part in PARTS if path.startswith(part + "/"))
    return max(fitting, key=len, default=None)


def _resolve(root: Path, source: str, name: str) -> str | None:
    """The file of the tree that ``name``, included by ``source``, means: beside it or from the root."""
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


def _judge_outside(source: str, bracket: str, name: str) -> str | None:
    """The same for a header that is not in the tree."""
    if PurePosixPath(name).parts[0] in SOURCE_FOLDERS:
        return f"#include of {name}, which does not exist"
    if source.startswith("sim_host/") or (bracket == "<" and name in _FREESTANDING):
        return None
    return f"#include of {name}: the drive's C has no C library, only {', '.join(sorted(_FREESTANDING))}"


def _judge(root: Path, source: str, rest: str) -> str | None:
    """What is wrong with ``#include rest`` in ``source``; None when nothing is."""
    match = _TARGET.match(rest)
    if not match:
        return f"#include {rest}: the name must be written out, this check cannot follow a macro"
    bracket, name = match.groups()
    target = _resolve(root, source, name)
    if target is None:
        return _judge_outside(source, bracket, name)
    source_part = part_of(source)
    if source_part is None:
        return f"this file is in no part of the house: add its folder to {__name__}"
    if _is_allowed(source_part, target):
        return None
    downward = ", ".join(MAY_INCLUDE[source_part]) or "nothing else"
    return f"#include of {target}: {source_part} may include {downward}"


def check(root: Path) -> list[Finding]:
    """Findings for every include that points up a floor, sideways, or nowhere."""
    findings = []
    for path in sources(root):
        source = path.relative_to(root).as_posix()
        for directive in directives(path.read_text(encoding="utf-8")):
            if directive.name != "include":
                continue
            message = _judge(root, source, directive.rest)
            if message:
                findings.append(Finding(source, directive.line, message))
    return findings
