"""Completion of the console's commands, from the drive's own table: what its edition has not is not offered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document

from stillspin.drive import Drive
from stillspin.drive.protocol import Words
from stillspin.drive.table import Table

COMMANDS = {
    "help": "the commands, or more of one",
    "list": "parameters whose name or meaning contains a word",
    "get": "a parameter or a signal",
    "set": "change a parameter",
    "start": "energise the motor, watched by this console",
    "stop": "speed to zero, then power stage off",
    "coast": "power stage off at once",
    "ref": "speed reference",
    "status": "state of the drive",
    "look": "whether and how the shaft turns, by two short pulses",
    "watch": "a line twice a second until a key is pressed",
    "signals": "signals and their values",
    "faults": "the last faults",
    "reset": "clear a latched fault",
    "save": "save the parameters for the next power-on",
    "load": "go back to the saved parameters",
    "defaults": "set every parameter to its default",
    "scope": "capture signals",
    "can": "the CAN node: rate, state, errors",
    "commission": "measure machine and inverter",
    "version": "version of the firmware",
}
_PART_OF = {
    "look": Words.LOOK,
    "save": Words.STORE,
    "load": Words.STORE,
    "defaults": Words.STORE,
    "scope": Words.SCOPE,
    "can": Words.CAN,
    "commission": Words.COMMISSIONING,
}
"""Commands of a part that an edition may leave out, and words that only a drive with that part says."""
_OF_PARAMETERS = {"get", "set", "list"}
_OF_SIGNALS = {"scope", "signals", "watch"}


def commands_of(drive: Drive) -> dict[str, str]:
    """The commands that the drive's console has, each with what it does."""
    parts = {part: drive.has_words(part) for part in set(_PART_OF.values())}
    return {name: meaning for name, meaning in COMMANDS.items() if name not in _PART_OF or parts[_PART_OF[name]]}


class ConsoleWords(Completer):
    """The first word is a command, the next ones are parameters or signals."""

    def __init__(self, table: Table, commands: Mapping[str, str]) -> None:
        """Take what there is to offer.

        Args:
            table: of the drive.
            commands: of its console, with their meanings.
        """
        self._table, self._commands = table, commands

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        """See prompt_toolkit."""
        words = document.text_before_cursor.split(" ")
        for name, meta in self._candidates(words):
            if name.startswith(words[-1]):
                yield Completion(name, -len(words[-1]), display_meta=meta)

    def _candidates(self, words: list[str]) -> Iterable[tuple[str, str]]:
        command, position = words[0], len(words)
        if position == 1:
            yield from self._commands.items()
        elif command not in self._commands:
            return
        elif command in _OF_PARAMETERS and position == 2:
            for parameter in self._table.parameters:
                yield parameter.name, f"{parameter.range_text}; {parameter.meaning}"
        elif command in _OF_SIGNALS:
            for signal in self._table.signals:
                yield signal.name, f"{signal.unit + '; ' if signal.unit else ''}{signal.meaning}"
        elif command == "set" and position == 3 and self._table.has_parameter(words[1]):
            parameter = self._table.parameter(words[1])
            yield parameter.text(parameter.initial_raw), f"default; {parameter.range_text}"
