"""`stillspin console`: the drive's own console with history, and completion from the drive's own table."""

from __future__ import annotations

import queue
import sys
import time
from collections.abc import Iterable
from contextlib import suppress
from typing import Annotated

import typer

from stillspin.commands.connection import DriveOption, opened, say_unsaved
from stillspin.commands.console_session import Session, session
from stillspin.commands.transcript import Transcript, as_sent
from stillspin.drive import Drive
from stillspin.drive.link_counts import ask_counts
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import NoAnswerError

_ECHO = 3.0
_ANSWER = 6.0
"""Seconds until the prompt: the console gives a start five. `watch` never comes to an end."""


def console(
    *,
    where: DriveOption = "",
    command: Annotated[
        list[str] | None, typer.Option("--command", "-c", help="Send this line to the console and exit. Repeatable.")
    ] = None,
    keep_running: Annotated[
        bool,
        typer.Option("--keep-running", help="Leave a motor running that was started here; nobody watches it then."),
    ] = False,
) -> None:
    """Talk to the drive; Tab completes, Ctrl-D leaves and stops a motor that was started here."""
    with opened(where) as drive:
        if not drive.link.transport.has_console:
            raise InputError(f"{drive.link.transport.name}: the console is on the serial port only")
        with session(drive, keep_running=keep_running) as current:
            if command or not sys.stdin.isatty():
                status = _say_all(drive, current, command or sys.stdin)
                say_unsaved(drive)
            else:
                from stillspin.commands import console_prompt  # noqa: PLC0415 - takes long to load, and not all need it

                status = ExitCode.DONE
                console_prompt.talk(drive, current)
        if drive.link.lost:
            raise drive.link.lost
    if status:
        raise typer.Exit(status)


def _say_all(drive: Drive, current: Session, lines: Iterable[str]) -> ExitCode:
    """Send lines, also behind one that is refused: it may be the one that stops the motor."""
    status = ExitCode.DONE
    before = _refusals(drive)
    for line in lines:
        say(drive, current, as_sent(line))
        after = _refusals(drive)
        if after != before:
            print(f"stillspin: not carried out: {line.strip()}", file=sys.stderr)
            status = ExitCode.SHORT
        before = after
    return status


def _refusals(drive: Drive) -> int:
    """How many lines the drive's console has not carried out since power-on."""
    return ask_counts(drive.link).refused


def say(drive: Drive, current: Session, line: str) -> None:
    """Send a line and print what the drive answers."""
    transcript = Transcript()
    heard: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    transcript.expect(line)
    with drive.link.listening(text=heard.put):  # printed here: what goes wrong with it ends the command
        current.send(line)
        end = time.monotonic() + _ANSWER
        if not wait_until(lambda: not heard.empty() or drive.link.lost is not None, _ECHO):
            raise NoAnswerError(f"no answer to '{line}' from the console on {drive.link.transport.name}")
        with suppress(queue.Empty):
            while not transcript.answered:
                for text in transcript.feed(heard.get(timeout=max(0.0, end - time.monotonic()))):
                    print(text, flush=True)
    if drive.link.lost:
        raise drive.link.lost
    if transcript.rest:
        print(transcript.rest)
