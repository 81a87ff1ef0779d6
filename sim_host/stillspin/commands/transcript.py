"""Lines out of a console's text: without the echo of what was typed, the prompt and the escape sequences."""

from __future__ import annotations

import re

PROMPT = "> "
LINE = 80
"""Characters of a line that the console takes; it shows none of the others, and carries out no such line."""
_ESCAPE = re.compile(r"\x1b(?:\[[0-9;?]*[A-Za-z]|[^\[])")


class Transcript:
    """Keeps the line that is not complete."""

    def __init__(self) -> None:
        self.rest = ""
        """What has been said of the next line, without prompt."""
        self.answered = False
        """Whether the drive has shown its prompt since `expect`."""
        self._expected: str | None = None

    def expect(self, line: str) -> None:
        """The drive will echo this, as far as it takes a line."""
        self._expected = line[:LINE].rstrip()
        self.answered = False

    def feed(self, octets: bytes) -> list[str]:
        """The lines that are complete with these octets."""
        text = self.rest + octets.decode("ascii", "replace")
        *lines, rest = text.split("\n")
        shown = [line for line in map(self._clean, lines) if line is not None]
        self.rest = rest
        if self._expected is None and is_prompt(rest):
            self.rest, self.answered = "", True
        return shown

    def _clean(self, line: str) -> str | None:
        words = _plain(line)
        if self._expected is not None and words.removeprefix(PROMPT.strip()).strip() == self._expected:
            self._expected = None
            return None
        return None if words in {"", PROMPT.strip()} else words


def as_sent(line: str) -> str:
    """A line as the console echoes it: one space between words, none around them, no end of another system's lines."""
    return " ".join(line.split()).encode("ascii", "replace").decode("ascii")


def is_prompt(line: str) -> bool:
    """Whether the console waits behind this, with nothing typed."""
    return _plain(line) == PROMPT.strip()


def _plain(line: str) -> str:
    """As it stands on a screen: after carriage returns and backspaces."""
    text = _ESCAPE.sub("", line)
    screen = ""
    for part in text.replace("\a", "").split("\r"):
        screen = part + screen[len(part) :]
    while "\b" in screen:
        at = screen.index("\b")
        screen = screen[: max(0, at - 1)] + screen[at + 1 :]
    return screen.rstrip()
