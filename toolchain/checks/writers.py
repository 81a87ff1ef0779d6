"""What the steps of the control interrupt have of each other in a period has one writer each; the others read it.

A write is an assignment to the member, by its path in the drive or by a pointer to the group that it lies in, or a
pointer to it through which it may be written.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from checks import Finding
from checks.calls import code

# Type and name of the group in the drive, member ("" for all of them): the files and folders that write it.
WRITERS = {
    ("drive_control_t", "control", "references"): (
        "firmware/start/",  # the state START
        "firmware/commissioning/",  # the state COMMISSION
        "firmware/drive/speed.c",  # RUN, STOP and a spin
        "firmware/mode/mode.c",  # the power stage opens
    ),
    ("drive_control_t", "control", "measured_q20"): (
        "firmware/drive/position.c",
        "firmware/hysteresis/hysteresis.c",  # in the place of windows
    ),
    ("drive_control_t", "control", "command_q16"): ("firmware/drive/current.c",),
    ("drive_position_t", "position", "selected"): ("firmware/drive/position.c",),
    ("drive_samples_t", "samples", ""): (
        "firmware/drive/sampling.c",
        "firmware/hysteresis/hysteresis.c",  # in the place of windows
    ),
    ("schedule_t", "schedule", ""): ("firmware/drive/schedule.c",),
}
_ASSIGNED = r"(?:\s*\[[^\]]*\]|(?:\.|->)\w+)*\s*(?:[-+*/|&^]?=(?!=)|\+\+|--|<<=|>>=)"
_POINTED = r"^\s*(?!.*\bconst\b[\w ]*\*)\w+\s*\*[^=;]*=\s*&"


def _writes(text: str, group_type: str, group: str, member: str) -> Iterator[int]:
    aliases = re.findall(rf"(?<!const )\b{group_type}\s*\*\s*(?:const\s+)?(\w+)", text)
    way = rf"(?:(?:\bd->|\bdrive\.){group}\.|\b(?:{'|'.join(aliases) or '(?!)'})->){member or '(?=[a-z])'}"
    end = r"\b" if member else r"\w+"
    yield from (match.start() for match in re.finditer(rf"{way}{end}{_ASSIGNED}", text))
    if member:
        yield from (match.start() for match in re.finditer(rf"{_POINTED}{way}\b", text, re.MULTILINE))


def check(root: Path) -> list[Finding]:
    """Findings for members of a period that somebody else writes."""
    texts = {p.relative_to(root).as_posix(): code(p) for p in sorted((root / "firmware").rglob("*.c"))}
    return [
        Finding(
            source, text.count("\n", 0, place) + 1, f"writes {group}.{member or '*'}, which is {owners[0]}'s to write"
        )
        for (group_type, group, member), owners in WRITERS.items()
        for source, text in texts.items()
        if not source.startswith(owners)
        for place in _writes(text, group_type, group, member)
    ]
