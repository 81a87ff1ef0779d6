"""TI's linker command files as far as those here go.

MEMORY with ranges; SECTIONS by `> RANGE` and `>> RANGE | RANGE`, of all input sections of that name or of those that
`{ ARCHIVE<MEMBER, ..>(SECTION, ..) .. }` names, the first that names one gets it. `.text:_NAME` is a function's own.
"""

import re
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

_RANGE = re.compile(r"^\s*(\w+)\s*:\s*origin\s*=\s*(\w+),\s*length\s*=\s*(\w+)", re.MULTILINE)
_SECTION = re.compile(r"^\s*([.\w]+)\s*:\s*(\{[^}]*\}\s*)?((?:>|LOAD|=|\w).*(?:\n {6,}.*)*)", re.MULTILINE)
_INPUT = re.compile(r"([\w.]+)<([^>]*)>\(([^)]*)\)")


@dataclass(frozen=True)
class Range:
    """A piece of memory: first word and number of words."""

    name: str
    origin: int
    length: int

    @property
    def end(self) -> int:
        """The word behind the last one."""
        return self.origin + self.length


@dataclass(frozen=True)
class Placement:
    """Where a section is kept, where it runs when that is another place, and where what does not fit goes."""

    section: str
    load: str
    run: str
    spill: str = ""
    inputs: tuple[tuple[str, str, str], ...] = ()  # archive, member, section; none: all of the section's name

    def takes(self, archive: str, member: str, section: str) -> bool:
        """Whether it names this input section, or the one that it is part of."""
        names = (section, section.partition(":")[0])
        return any(archive == a and fnmatch(member, m) and s in names for a, m, s in self.inputs)

    @property
    def ranges(self) -> tuple[str, ...]:
        """All ranges that it may take words of."""
        return tuple(dict.fromkeys(name for name in (self.load, self.run, self.spill) if name))


@dataclass(frozen=True)
class CommandFile:
    """A linker command file."""

    ranges: dict[str, Range]
    placements: list[Placement]
    stack_words: int
    symbols: set[str]  # that the linker defines
    text: str  # without comments

    def section_of(self, archive: str, member: str, section: str) -> str:
        """The output section of an input section."""
        taker = (p.section for p in self.placements if p.takes(archive, member, section))
        return next(taker, section.partition(":")[0])


def read_command_file(path: Path) -> CommandFile:
    """Parses one file."""
    text = re.sub(r"/\*.*?\*/", " ", path.read_text(encoding="utf-8"), flags=re.DOTALL)
    head, _, sections = text.partition("SECTIONS")
    ranges = {m[1]: Range(m[1], int(m[2], 0), int(m[3], 0)) for m in _RANGE.finditer(head)}
    placements = []
    for match in _SECTION.finditer(sections):
        words = match[3]
        inputs = tuple(
            (archive, member.strip(), section.strip())
            for archive, members, named in _INPUT.findall(match[2] or "")
            for member in members.split(",")
            for section in named.split(",")
        )
        load = re.search(r"(?:^>>?|LOAD\s*=)\s*(\w+)", words)
        spill = re.search(r"^>>\s*\w+\s*\|\s*(\w+)", words)
        run = re.search(r"RUN\s*=\s*(\w+)", words)
        if load:
            spill_to = spill[1] if spill else ""
            placements.append(Placement(match[1], load[1], run[1] if run else load[1], spill_to, inputs))
    stack = re.search(r"--stack_size=(\w+)", text)
    symbols = set(re.findall(r"(?:LOAD_START|RUN_START|SIZE)\(_(\w+)\)", sections))
    return CommandFile(ranges, placements, int(stack[1], 0) if stack else 0, symbols, text)
