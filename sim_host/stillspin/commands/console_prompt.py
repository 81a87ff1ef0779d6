"""What a person at a terminal has of `stillspin console`: a prompt with completion and history, a line of status."""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path

from prompt_toolkit import PromptSession
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.patch_stdout import patch_stdout

from stillspin import resources
from stillspin.commands.completion import ConsoleWords, commands_of
from stillspin.commands.console_session import Session
from stillspin.commands.transcript import Transcript, as_sent
from stillspin.drive import Drive
from stillspin.drive.state import Status
from stillspin.link.errors import DriveError

_REFRESH = 0.5
_LEAVE = {"exit", "quit"}
_TWICE = 2.0
"""Seconds within which a second Ctrl-C asks whether to leave."""


def talk(drive: Drive, current: Session) -> None:
    """Take lines until the person leaves, or the port is gone."""
    transcript = Transcript()
    stop = threading.Event()
    terminal: PromptSession[str] = PromptSession(
        "stillspin> ",
        history=_history(),
        auto_suggest=AutoSuggestFromHistory(),
        completer=ConsoleWords(drive.table, commands_of(drive)),
        complete_while_typing=False,
    )
    bar = _Bar(drive, terminal, stop)

    def show(octets: bytes) -> None:
        for text in transcript.feed(octets):
            print(text)

    thread = threading.Thread(target=bar.run, daemon=True)
    thread.start()
    print(f"{drive.version} on {drive.link.transport.name}; help lists what it understands, Ctrl-D leaves")
    print(f"which parameter to change for what you see: {resources.page('tuning')}; 'stillspin tune' shows it, too")
    interrupted = -_TWICE
    with patch_stdout(), drive.link.listening(text=show):
        try:
            while not drive.link.lost:
                try:
                    line = as_sent(terminal.prompt(bottom_toolbar=bar.text))
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


def _said(status: Status) -> str:
    what = f"{status.state}: {status.fault}" if status.fault else status.state
    return f"{what} | {status.speed_text}, reference {status.reference_text}"


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
                self._text = f" {_said(status)}"
            self._session.app.invalidate()


def _history() -> History:
    base = os.environ.get("XDG_STATE_HOME") or str(Path.home() / ".local" / "state")
    path = Path(base) / "stillspin" / "console-history"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError:
        return InMemoryHistory()
    return FileHistory(path)
