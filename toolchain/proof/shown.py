"""What Frama-C says while it still reads: whether every function that has a defect has shown one."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

ALARM = re.compile(r"\[eva:alarm\] (\S+):(\d+): Warning:")
NOT_PROVED = re.compile(r"\[wp\] \[.*\] Goal typed_(\w+) : (?!Valid)")
HEAD = 6  # lines of a function's first one, up to its brace

Place = tuple[str, int, int]  # a function's file, its first line and its last


def places_of(function: str, tree: Path, files: Iterable[str]) -> Iterator[Place]:
    """Where functions of that name are defined, in the house format."""
    begins = re.compile(rf"\w[\w *]*\b{function}\(.*")
    for file in files:
        lines = (tree / file).read_text(encoding="utf-8").splitlines()
        for first, line in enumerate(lines):
            if begins.fullmatch(line) and "{" in " ".join(lines[first : first + HEAD]).partition(";")[0]:
                last = first if line.endswith("}") else lines.index("}", first)
                yield file, first + 1, last + 1


class Shown:
    """Which of some functions have shown an alarm, or a goal that is not proved.

    What a call needs or gives is not looked at: whether that counts is known at the end alone.
    """

    def __init__(self, tree: Path, files: Iterable[str], functions: Iterable[str]) -> None:
        """In files below tree. Without functions there is nothing to be shown, ever."""
        kept = sorted(files)
        self._places = {function: tuple(places_of(function, tree, kept)) for function in functions}
        self._seen: set[str] = set()
        self._alarm = ""

    def is_complete_with(self, line: str) -> bool:
        """After one more line of what Frama-C says."""
        message = self._alarm + line if line.startswith(" ") else self._alarm
        if (alarm := ALARM.match(message)) and "condition" not in message:
            self._seen |= {name for name, places in self._places.items() if _is_in(places, alarm[1], int(alarm[2]))}
        self._alarm = line if ALARM.match(line) else ""
        if goal := NOT_PROVED.match(line):
            self._seen |= {name for name in self._places if goal[1].startswith(f"{name}_")}
        return bool(self._places) and len(self._seen) == len(self._places)


def _is_in(places: Iterable[Place], file: str, line: int) -> bool:
    """Whether a line is in one of them."""
    return any(file == where and first <= line <= last for where, first, last in places)
