"""What the steps of the control interrupt have of each other has its writer; the others read it.

A write is an assignment to the member, by its path in the drive or by a pointer to the group that it lies in; a pointer
to it through which it may be written; and such a pointer handed to a function. A group whose members have several
writers, and the drive as a whole, are written at once where they are made, and nowhere else but for AT_ONCE. A member
that has no row is a finding as well: each one has its writer.
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
    "drive_estimate_t": "estimate",
    "drive_samples_t": "samples",
    "drive_modulation_t": "modulation",
    "schedule_t": "schedule",
    "state_flags_t": "flags",
    "drive_supervision_t": "supervision",
    "drive_request_t": "request",
}
DRIVE = "firmware/mode/mode.h"  # says what the drive has
_STATES = ("firmware/start/", "firmware/commissioning/")  # START and COMMISSION
_FRESH = "firmware/drive/reset.c"  # the state after power-on, and the machine of new parameters
_SLICED = "firmware/hysteresis/hysteresis.c"  # in the place of windows
_SLICES = "->samples"  # its hook (interfaces/phase_control.h)
# Each member by its path in the drive: the files and folders that write it.
WRITERS: dict[str, tuple[str, ...]] = {
    # Of a period, in the order of the steps.
    "schedule": ("firmware/drive/schedule.c",),
    "samples": ("firmware/drive/sampling.", _SLICED, _SLICES),
    "estimate.measured_q20": ("firmware/drive/position.", _SLICES),
    "estimate.selected": ("firmware/drive/position.",),
    "estimate.seen": ("firmware/drive/position.h",),
    "estimate.seen_q20": ("firmware/drive/position.c",),
    "estimate.frames": ("firmware/drive/position.c",),
    "estimate.torque_accel_q8": ("firmware/drive/position.c",),
    "supervision.missing": ("firmware/drive/sampling.c", _SLICES),
    "supervision.diverged_periods": ("firmware/drive/protection.c",),
    "supervision.judged_at": ("firmware/drive/protection.c",),
    "supervision.judged_bam": ("firmware/drive/protection.c",),
    "supervision.synchronism": ("firmware/drive/protection.c",),
    "supervision.stopping_periods": ("firmware/drive/sequence.c",),
    "modulation.overrun": ("firmware/drive/modulation.c", "firmware/start/start.c"),
    "state": ("firmware/mode/mode.c",),
    "fault": ("firmware/mode/mode.c", "firmware/drive/sequence.c"),  # raised; acknowledged
    "periods": ("firmware/drive/sequence.c", "firmware/mode/mode.c"),
    "heartbeat": ("firmware/drive/sequence.c",),
    "settled_at": ("firmware/drive/sequence.c", "firmware/mode/mode.c"),
    "zero_current_a_q8": ("firmware/drive/sequence.c", _FRESH),
    "zero_current_b_q8": ("firmware/drive/sequence.c", _FRESH),
    "offset_residual_q8": ("firmware/drive/sequence.c",),
    "flags": (*_STATES, "firmware/mode/mode.c"),
    "flags.behind": (*_STATES,),
    "flags.invalid": ("firmware/start/",),
    "flags.gates_off": ("firmware/start/",),
    "flags.shorted": ("firmware/start/",),
    "flags.wants_exclusive": ("firmware/start/",),
    "flags.caught": ("firmware/start/",),
    "flags.open_loop": ("firmware/start/",),
    "flags.unseen": ("firmware/start/", "firmware/commissioning/"),
    "flags.spins": (*_STATES, "firmware/mode/mode.c"),
    "flags.frozen": ("firmware/commissioning/",),
    "flags.over": ("firmware/commissioning/",),
    "control.references": (
        *_STATES,
        "firmware/drive/speed.c",  # RUN, STOP and a spin
        "firmware/mode/mode.c",  # the power stage opens
    ),
    "control.references.current_q20": (*_STATES, "firmware/drive/speed.c"),
    "control.references.feed_forward_q16": ("firmware/commissioning/",),
    "control.references.closed": (*_STATES, "firmware/mode/mode.c"),
    "control.command_rpm_q16": ("firmware/drive/sequence.c", "firmware/mode/mode.c"),
    "control.target_bpp": ("firmware/drive/sequence.c", "firmware/mode/mode.c", "firmware/commissioning/spin.c"),
    "control.references.spin_d_q20": ("firmware/commissioning/spin.c",),
    "control.headroom_q20": ("firmware/drive/speed.c",),
    "control.braking_headroom_q20": ("firmware/drive/speed.c",),
    "control.per_torque_constant": ("firmware/drive/speed.c", _FRESH),
    "time_ms": ("firmware/drive/sequence.c",),
    "control.limits": ("firmware/drive/speed.c",),
    "control.command_q16": ("firmware/drive/current.c",),
    "modulation.state": ("firmware/drive/modulation.c", "firmware/start/start.c"),
    "modulation.limits": ("firmware/drive/modulation.c",),
    "modulation.patterns": ("firmware/drive/modulation.c",),
    "modulation.sampled": ("firmware/drive/modulation.c",),
    "modulation.running": ("firmware/drive/modulation.c",),
    "modulation.command_q16": ("firmware/drive/modulation.c",),
    "modulation.sliced": (_SLICED,),
    # Controllers: their step, and who lets them begin.
    "control.speed": (
        "firmware/drive/speed.c",
        "firmware/drive/inertia.c",
        "firmware/drive/bumpless_transfer.c",
        "firmware/start/",
        _FRESH,
    ),
    "control.weakening": ("firmware/drive/speed.c", "firmware/start/"),
    "control.ramp": ("firmware/drive/speed.c", "firmware/drive/bumpless_transfer.c", "firmware/start/"),
    "control.position_hold": ("firmware/drive/speed.c", "firmware/start/start.c"),
    "control.current": (
        "firmware/drive/current.c",
        "firmware/drive/modulation.c",  # what the voltage limit has cut off
        "firmware/start/if_start/",
    ),
    # Of more than one: who learns or carries something on.
    "estimate.model": (
        "firmware/drive/position.c",  # to the operating point
        "firmware/sources/observer/learning.c",
        "firmware/drive/inertia.c",
        *_STATES,  # begin with the nameplate, and measure
        _FRESH,
    ),
    "estimate.trim": (
        "firmware/drive/sequence.c",  # the calibration
        "firmware/sources/observer/learning.c",
        "firmware/start/start.c",
        _FRESH,
    ),
    "estimate.low": ("firmware/sources/", "firmware/drive/position.c"),
    "estimate.high": ("firmware/sources/", "firmware/drive/position.c"),
    "estimate.blend": ("firmware/sources/", "firmware/drive/position.c"),
    "estimate.avv": ("firmware/sources/", "firmware/drive/position.c", "firmware/commissioning/hold.c"),
    "estimate.observer": (
        "firmware/sources/",
        "firmware/drive/position.c",
        "firmware/drive/brake_release_hold.c",  # a shaft that stands
        "firmware/drive/inertia.c",
        "firmware/drive/protection.c",  # takes the residual
        "firmware/drive/speed.c",  # learns cogging in a period that has room for it
    ),
    # By the background level, between two control interrupts.
    "config": ("firmware/drive/reload.c", _FRESH),
    "config_valid": ("firmware/drive/reload.c", "firmware/boot/main.c", _FRESH),
    "conflict": ("firmware/drive/reload.c",),
    "conflict_known": ("firmware/drive/reload.c",),
    "source": (
        "firmware/drive/reload.c",
        "firmware/commissioning/spin.c",  # a rotor that only a current vector turns
        _FRESH,
    ),
    "control.speed_ready": (_FRESH,),
    "control.current_limit_q20": ("firmware/drive/reload.c", "firmware/board/functions.c", _FRESH),
    # Asked for at background level, taken in the period.
    "request.stop": ("firmware/mode/commands.c", "firmware/drive/sequence.c"),
    "request.coast": ("firmware/mode/commands.c", "firmware/drive/sequence.c"),
    "request.reset": ("firmware/mode/commands.c", "firmware/drive/sequence.c"),
    "request.begin": (
        "firmware/mode/commands.c",
        "firmware/start/flying/look.c",
        "firmware/commissioning/sequence.c",
        "firmware/drive/sequence.c",
    ),
    "request.speed": ("firmware/mode/commands.c", "firmware/drive/sequence.c", "firmware/mode/mode.c"),
    "request.speed_rpm_q16": ("firmware/mode/commands.c",),
    "request.reload": ("firmware/mode/commands.c", "firmware/drive/reload.c"),
}
# Groups that begin anew as a whole, beside _FRESH.
AT_ONCE: dict[str, tuple[str, ...]] = {
    "flags": ("firmware/mode/mode.c",),  # with each state
    "supervision": ("firmware/start/start.c",),  # with each start
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
        if (member or group).rpartition(".")[2] not in text:  # the types of GROUPS have their group's name
            return
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


_STRUCT = re.compile(r"\btypedef struct(?: \w+)? \{([^{}]*)\} (\w+);")
_MEMBER = re.compile(r"(\w+)(?:\s*\[[^\]]*\])*\s*[,;]")


def members(root: Path) -> dict[str, tuple[str, int]]:
    """Each member of the drive, and of each of its groups in firmware/, by its path: where it is declared."""
    found: dict[str, tuple[str, int]] = {}
    for path in sorted((root / "firmware").rglob("*.h")):
        text, source = code(path), path.relative_to(root).as_posix()
        for struct in _STRUCT.finditer(text):
            if struct[2] not in GROUPS and (struct[2] != "drive_t" or source != DRIVE):
                continue
            group = GROUPS.get(struct[2], "")
            for member in _MEMBER.finditer(struct[1]):
                line = text.count("\n", 0, struct.start(1) + member.start()) + 1
                found[f"{group}.{member[1]}" if group else member[1]] = (source, line)
    return found


def _without_writer(root: Path) -> list[Finding]:
    declared = members(root)
    groups = {name.partition(".")[0] for name in declared if "." in name}
    by_member = {path.partition(".")[0] for path in WRITERS if "." in path}
    return [
        Finding(source, line, f"nobody is named as the writer of {name}: it gets a row in toolchain/checks/writers.py")
        for name, (source, line) in declared.items()
        if name not in WRITERS and name not in groups
        if (group := name.partition(".")[0]) == name or group in by_member or group not in WRITERS
    ]


def check(root: Path) -> list[Finding]:
    """Findings for members of the drive that somebody else writes, one a line, or that nobody is named for."""
    writes = Writes(root)
    said: dict[tuple[str, int], str] = {}
    for path, owners in WRITERS.items():
        for source, text in writes.texts.items():
            if source.startswith(owners):
                continue
            for place, writer in writes.of(source, path):
                if not writer.startswith(owners):
                    line = text.count("\n", 0, place) + 1
                    said[source, line] = f"writes {path}, which is {owners[0]}'s to write"
    for group in ("", *sorted({path.partition(".")[0] for path in WRITERS if "." in path})):
        owners = (_FRESH, *AT_ONCE.get(group, ()))
        for source in writes.texts.keys() - set(owners):
            for place in writes.whole(source, group):
                line = writes.texts[source].count("\n", 0, place) + 1
                said[source, line] = f"writes {group or 'the drive'} as a whole; only {' and '.join(owners)} may"
    return [Finding(*place, message) for place, message in sorted(said.items())] + _without_writer(root)
