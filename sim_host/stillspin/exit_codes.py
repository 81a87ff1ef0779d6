"""The exit status of every command; docs/command-line.md has the same table (toolchain/render.py)."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """What a command ends with; `title` and `meaning` are for people."""

    title: str
    meaning: str

    def __new__(cls, number: int, title: str, meaning: str) -> ExitCode:
        """A member whose words stand beside its number."""
        member = int.__new__(cls, number)
        member._value_ = number
        member.title = title
        member.meaning = meaning
        return member

    DONE = 0, "done", "what was asked for is done, and every goal is met"
    SHORT = 1, "refused or missed", "the drive refused, a goal is missed, or a run, a start or a commissioning failed"
    BAD_INPUT = 2, "bad input", "an option, a name, a value or a file is wrong; nothing was done"
    NO_CONNECTION = 3, "no connection", "a port that does not open, nobody who answers, or a connection that was lost"
    DIFFERS = 4, "the board differs", "its image, its parameters, its build or what it computes is not what was given"
    INTERRUPTED = 130, "interrupted", "Ctrl-C or SIGTERM before it was done"
    CLOSED_PIPE = 141, "closed pipe", "the program that read the output has ended, such as `head`"


def table() -> str:
    """All of them as a table in Markdown."""
    rows = [f"| {code:d} | {code.title} | {code.meaning} |" for code in ExitCode]
    return "\n".join(["| status | in short | when |", "| --- | --- | --- |", *rows]) + "\n"
