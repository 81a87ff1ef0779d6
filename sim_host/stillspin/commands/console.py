"""`stillspin console`: the drive's own console with history, and completion from the drive's own table."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer
from prompt_toolkit import PromptSession
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.patch_stdout import patch_stdout

from stillspin.commands.completion import Words
from stillspin.commands.connection import DriveOption, opened, say_unsaved
from stillspin.commands.console_session import Session, session
from stillspin.commands.transcript import Transcript
from stillspin.drive import Drive
from stillspin.drive.link_counts import ask_counts
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import DriveError, NoAnswerError

_ECHO = 3.0
_ANSWER = 6.0
"""Seconds until the prompt: the console gives a start five. `watch` never comes to an end."""
_REFRESH = 0.5
_GUIDE = "which parameter to change for what you see: docs/tuning.md; 'stillspin tune' shows it, too"
_LEAVE = {"exit", "quit"}
_TWICE = 2.0
"""Seconds within which a second Ctrl-C asks whether to leave."""


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
                status = ExitCode.DONE
                _talk(drive, current)
        if drive.link.lost:
            raise drive.link.lost
    if status:
        raise typer.Exit(status)


def _say_all(drive: Drive, current: Session, lines: Iterable[str]) -> ExitCode:
    """Send lines, also behind one that is refused: it may be the one that stops the motor."""
    status = ExitCode.DONE
    before = _refusals(drive)
    for line in lines:
        say(drive, current, line.rstrip("\n"))
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
    heard = threading.Event()

    def take(octets: bytes) -> None:
        for text in transcript.feed(octets):
            print(text, flush=True)
        heard.set()

    transcript.expect(line)
    with drive.link.listening(text=take):
        current.send(line)
        end = time.monotonic() + _ANSWER
        if not wait_until(lambda: heard.is_set() or drive.link.lost is not None, _ECHO):
            raise NoAnswerError(f"no answer to '{line}' from the console on {drive.link.transport.name}")
        while not transcript.answered and heard.wait(max(0.0, end - time.monotonic())):
            heard.clear()
    if drive.link.lost:
        raise drive.link.lost
    if transcript.rest:
        print(transcript.rest)


def _talk(drive: Drive, current: Session) -> None:
    transcript = Transcript()
    stop = threading.Event()
    terminal: PromptSession[str] = PromptSession(
        "stillspin> ",
        history=_history(),
        auto_suggest=AutoSuggestFromHistory(),
        completer=Words(drive.table),
        complete_while_typing=False,
    )
    bar = _Bar(drive, terminal, stop)

    def show(octets: bytes) -> None:
        for text in transcript.feed(octets):
            print(text)

    thread = threading.Thread(target=bar.run, daemon=True)
    thread.start()
    print(f"{drive.version} on {drive.link.transport.name}; help lists what it understands, Ctrl-D leaves")
    print(_GUIDE)
    interrupted = -_TWICE
    with patch_stdout(), drive.link.listening(text=show):
        try:
            while not drive.link.lost:
                try:
                    line = terminal.prompt(bottom_toolbar=bar.text).strip()
                    if line in _LEAVE:
                        break
                    transcript.expect(line)
                    current.send(line)
                except KeyboardInterrupt:
                    current.interrupt()
                    before, interrupted = interrupted, time.monotonic()
                    if interrupted - before < _TWICE and _wants_to_leave(current):
                        break
        except EOFError:
            pass
        finally:
            stop.set()
    if not drive.link.lost:
        status = drive.status()
        if status.energised and not current.holds_motor():
            print("the motor runs on: it was started free, or by somebody else; 'stop' on the console ends it")
        if status.unsaved_text:
            print(status.unsaved_text)


def _wants_to_leave(current: Session) -> bool:
    """Asks; one who does not answer leaves."""
    runs = current.holds_motor()
    question = "leave and stop the motor? [y]es, [k]eep it running, [n]o: " if runs else "leave? [y]es, [n]o: "
    try:
        answer = PromptSession[str](question).prompt().strip().lower()
    except (EOFError, KeyboardInterrupt):
        return True
    current.keep_running = current.keep_running or (runs and answer.startswith("k"))
    return answer.startswith(("y", "k"))


class _Bar:
    """The line at the bottom: what the drive does, asked for in records while the text goes on."""

    def __init__(self, drive: Drive, session: PromptSession[str], stop: threading.Event) -> None:
        self._drive, self._session, self._stop = drive, session, stop
        self._text = ""

    def text(self) -> str:
        return self._text

    def _leave(self) -> None:
        """Nobody has to press a key to be told that the port is gone."""
        app = self._session.app

        def leave() -> None:
            if app.is_running and not app.is_done:
                app.exit(exception=EOFError)

        if app.loop:
            app.loop.call_soon_threadsafe(leave)

    def run(self) -> None:
        while not self._stop.wait(_REFRESH):
            try:
                status = self._drive.status()
            except DriveError as error:
                self._text = f" {error}"
                if self._drive.link.lost and self._session.app.is_running:
                    self._leave()
            else:
                what = f"{status.state}: {status.fault}" if status.fault else status.state
                self._text = f" {what} | {status.speed_text}, reference {status.reference:.1f} rpm"
            self._session.app.invalidate()


def _history() -> History:
    base = os.environ.get("XDG_STATE_HOME") or str(Path.home() / ".local" / "state")
    path = Path(base) / "stillspin" / "console-history"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError:
        return InMemoryHistory()
    return FileHistory(path)
