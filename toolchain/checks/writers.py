"""What the steps of the control interrupt have of each other has its writer; the others read it.

A write is an assignment to the member, by its path in the drive or by a pointer to the group that it lies in; a pointer
to it through which it may be written; and such a pointer handed to a function. A group whose members have several
writers, and the drive as a whole, are written at once where they are made, and nowhere else.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from checks import Finding
from checks.calls import code

# The type of a group of the drive: who has a pointer of it has the group.
GROUPS = {
    "drive_control_t": "control",
    "drive_position_t": "position",
    "drive_samples_t": "samples",
    "drive_modulation_t": "modulation",
    "schedule_t": "schedule",
    "state_flags_t": "flags",
}
_STATES = ("firmware/start/", "firmware/commissioning/")  # START and COMMISSION
_FRESH = "firmware/drive/reset.c"  # the state after power-on
_SLICED = "firmware/hysteresis/hysteresis.c"  # in the place of windows
# Each member by its path in the drive: the files and folders that write it.
WRITERS: dict[str, tuple[str, ...]] = {
    # Of a period, in the order of the steps.
    "schedule": ("firmware/drive/schedule.c",),
    "samples": ("firmware/drive/sampling.", _SLICED),
    "control.measured_q20": ("firmware/drive/position.c", _SLICED),
    "position.selected": ("firmware/drive/position.c",),
    "position.seen": ("firmware/drive/position.h",),
    "position.seen_q20": ("firmware/drive/position.c",),
    "position.frames": ("firmware/drive/position.c",),
    "position.torque_accel_q8": ("firmware/drive/position.c",),
    "state": ("firmware/mode/mode.c",),
    "flags": (*_STATES, "firmware/mode/mode.c"),
    "control.references": (
        *_STATES,
        "firmware/drive/speed.c",  # RUN, STOP and a spin
        "firmware/mode/mode.c",  # the power stage opens
    ),
    "control.command_rpm_q16": ("firmware/drive/sequence.c", "firmware/mode/mode.c"),
    "control.target_bpp": ("firmware/drive/sequence.c", "firmware/mode/mode.c", "firmware/commissioning/spin.c"),
    "control.weakening_q20": ("firmware/drive/speed.c",),
    "control.headroom_q20": ("firmware/drive/speed.c",),
    "control.braking_headroom_q20": ("firmware/drive/speed.c",),
    "control.per_torque_constant": ("firmware/drive/speed.c", _FRESH),
    "control.command_q16": ("firmware/drive/current.c",),
    "modulation": ("firmware/drive/modulation.c", "firmware/start/start.c", _FRESH),
    # Of more than one: who learns or carries something on.
    "model": (
        "firmware/drive/position.c",  # to the operating point
        "firmware/sources/observer/learning.c",
        "firmware/drive/inertia.c",
        *_STATES,  # begin with the nameplate, and measure
        "firmware/drive/reload.c",
        _FRESH,
    ),
    "trim": (
        "firmware/drive/sequence.c",  # the calibration
        "firmware/sources/observer/learning.c",
        "firmware/start/start.c",
        _FRESH,
    ),
    "position.low": ("firmware/sources/", "firmware/drive/position.c"),
    "position.high": ("firmware/sources/", "firmware/drive/position.c"),
    "position.blend": ("firmware/sources/", "firmware/drive/position.c"),
    "position.is_near": ("firmware/sources/",),
    "position.avv": ("firmware/sources/", "firmware/drive/position.c", "firmware/commissioning/hold.c"),
    "position.observer": (
        "firmware/sources/",
        "firmware/drive/position.c",
        "firmware/drive/brake_release_hold.c",  # a shaft that stands
        "firmware/drive/inertia.c",
        "firmware/drive/protection.c",  # takes the residual
        "firmware/drive/speed.c",  # learns cogging in a period that has room for it
    ),
    # By the background level, between two control interrupts.
    "config": ("firmware/drive/reload.c", "firmware/commissioning/sequence.c", _FRESH),
}
ALL = ("control", "svpwm", "estimators", "firmware")
_ANY = r"[a-z]\w*"
_CHAIN = r"(?:\s*\[[^\]]*\]|(?:\.|->)\w+)*"
_ASSIGNED = rf"{_CHAIN}\s*(?:[-+*/|&^]?=(?!=)|\+\+|--|<<=|>>=)"
_POINTED = re.compile(r"\s*(?!.*\bconst\b[\w ]*\*)\w+\s*\*[^=;]*=\s*&?", re.DOTALL)  # up to the member
_PROTOTYPE = re.compile(
    r"^(static\s)?[A-Za-z_][\w \t*]*?[ *](\w+)\(((?:[^;{}()]|\([^()]*\))*)\)\s*([;{])", re.MULTILINE
)
_POINTER = re.compile(r"\(\*(\w+)\)\(([^;()]*)\);")  # a member that is a function


@dataclass(frozen=True)
class _Function:
    parameters: list[str]
    defined: str  # in this file, or "" where it is only declared


def _functions(root: Path) -> dict[str, _Function]:
    found: dict[str, _Function] = {}
    for folder in ALL:
        for path in sorted((root / folder).rglob("*.[ch]"), key=lambda path: (path.suffix == ".c", path)):
            text, source = code(path), path.relative_to(root).as_posix()
            for static, name, parameters, end in _PROTOTYPE.findall(text):
                key = f"{source} {name}" if static and path.suffix == ".c" else name
                found[key] = _Function(parameters.split(","), source if end == "{" else "")
            for name, parameters in _POINTER.findall(text):
                found[f"->{name}"] = _Function(parameters.split(","), "")
    return found


def _place_in_call(text: str, at: int) -> tuple[str, int]:
    """The function in whose call this stands as an argument, and which one it is."""
    depth, argument = 0, 0
    for k in range(at - 1, -1, -1):
        sign = text[k]
        if sign in ")]":
            depth += 1
        elif sign in "([" and depth > 0:
            depth -= 1
        elif sign in "([":
            name = re.search(r"((?:->)?\w+)\s*$", text[:k])
            return (name[1] if name else "", argument)
        elif sign == "," and depth == 0:
            argument += 1
        elif sign in ";{}":
            break
    return "", 0


class Writes:
    """Of a tree."""

    def __init__(self, root: Path) -> None:
        self.texts = {p.relative_to(root).as_posix(): code(p) for p in sorted((root / "firmware").rglob("*.[ch]"))}
        self._functions = _functions(root)

    def _called(self, source: str, start: int) -> tuple[str, _Function | None, str]:
        """The name of the function in whose call this is an argument, what is known of it, and as what it takes it."""
        name, argument = _place_in_call(self.texts[source], start)
        known = self._functions.get(f"{source} {name}") or self._functions.get(name)
        return name, known, known.parameters[argument] if known and argument < len(known.parameters) else ""

    def _handed_to(self, source: str, start: int) -> str | None:
        """Where the function is defined that may write what it is handed here; None where none may."""
        name, known, taken = self._called(source, start)
        if known is None or not taken:
            return None if name in {"", "sizeof", "if", "while"} or self.texts[source][start] != "&" else name
        written = ("*" in taken or "[" in taken) and "const" not in taken.partition("*")[0]
        return (known.defined or name) if written else None

    def whole(self, source: str, group: str) -> Iterator[int]:
        """Where a file writes a whole group at once; of no name, the drive."""
        text = self.texts[source]
        kinds = [name for name, of in GROUPS.items() if of == group] if group else ["drive_t"]
        way = rf"(?:\bd->|\bdrive\.){group}" if group else r"(?:\bdrive|(?<![\w)\]] )\*\s*d)"
        aliases = re.findall(rf"(?<!const )\b(?:{'|'.join(kinds)})\s*\*\s*(?:const\s+)?(\w+)", text) if kinds else []
        if aliases:
            way = rf"(?:{way}|(?:^|[;{{}}])\s*\*\s*(?:{'|'.join(aliases)}))"
        yield from (match.end() - 1 for match in re.finditer(rf"{way}\s*=(?!=)", text, re.MULTILINE))
        handed = rf"&(?:\bd->|\bdrive\.){group}" if group else r"(?:&drive|\bd)"
        for match in re.finditer(rf"(?<=[(,\s]){handed}\s*(?=[,)])", text):
            if re.match(r"\s*void\s*\*", self._called(source, match.start())[2]):
                yield match.start()

    def of(self, source: str, path: str) -> Iterator[tuple[int, str]]:
        """Where a file writes a member, and the file of the function that does it for it, if one does."""
        text = self.texts[source]
        group, _, member = path.partition(".")
        types = [name for name, of in GROUPS.items() if of == group]
        aliases = re.findall(rf"(?<!const )\b(?:{'|'.join(types) or '(?!)'})\s*\*\s*(?:const\s+)?(\w+)", text)
        way = rf"(?:\bd->|\bdrive\.){group}\b" + (rf"\.{member}\b" if member else "")
        if aliases:
            way = rf"(?:{way}|\b(?:{'|'.join(aliases)})->{member or _ANY}\b)"
        yield from ((match.start(), "") for match in re.finditer(rf"{way}{_ASSIGNED}", text))
        for match in re.finditer(way, text):
            begin = max(text.rfind(sign, 0, match.start()) for sign in ";{}") + 1
            if _POINTED.fullmatch(text, begin, match.start()):
                yield match.start(), ""
        for match in re.finditer(rf"(?<=[(,\s])&?{way}{_CHAIN}\s*(?=[,)])", text):
            if (writer := self._handed_to(source, match.start())) is not None:
                yield match.start(), writer


def check(root: Path) -> list[Finding]:
    """Findings for members of the drive that somebody else writes."""
    writes = Writes(root)
    groups = sorted({path.partition(".")[0] for path in WRITERS if "." in path})
    at_once = [
        Finding(source, text.count("\n", 0, place) + 1, f"writes {group or 'the drive'} as a whole; only {_FRESH} does")
        for group in (*groups, "")
        for source, text in writes.texts.items()
        if source != _FRESH
        for place in writes.whole(source, group)
    ]
    return at_once + [
        Finding(source, text.count("\n", 0, place) + 1, f"writes {path}, which is {owners[0]}'s to write")
        for path, owners in WRITERS.items()
        for source, text in writes.texts.items()
        if not source.startswith(owners)
        for place, writer in writes.of(source, path)
        if not writer.startswith(owners)
    ]
