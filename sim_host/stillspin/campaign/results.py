"""Cases and their verdicts as a file that grows by a line each, so that a campaign goes on where it was broken off."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from stillspin import whole_file
from stillspin.campaign.draw import Case
from stillspin.campaign.judge import End, Verdict
from stillspin.errors import InputError

Key = tuple[str, int]
"""Motor and number."""


@dataclass(frozen=True)
class Row:
    """A case on a motor, and what became of it."""

    motor: str
    case: Case
    verdict: Verdict

    @property
    def key(self) -> Key:
        """Which one it is."""
        return self.motor, self.case.number

    def line(self) -> str:
        """As the file has it."""
        case = self.case
        drawn = {"noise": case.noise, "fault": case.fault, "at": case.at, "drawn": dict(case.drawn)}
        return json.dumps({"motor": self.motor, "number": case.number, **asdict(self.verdict), **drawn})


def _read(stored: dict[str, Any]) -> Row:
    case = Case(stored["number"], stored["drawn"], stored["noise"], stored["fault"], stored["at"])
    verdict = Verdict(End(stored["end"]), stored["words"], stored["wrong"], stored["off"], stored["error"])
    return Row(stored["motor"], case, verdict)


class Results:
    """The file of a campaign: a line that says what campaign it is, then one for every case as it ended.

    Lines come as cases are done, so that nothing is lost; when all are, they are put in order.
    """

    def __init__(self, file: Path | None, about: Mapping[str, object], resume: bool) -> None:
        """Begin the file, or go on with it.

        Args:
            file: None for none.
            about: what makes it this campaign; cases of another one are not taken.
            resume: whether the file is there and goes on.

        Raises:
            InputError: it is there and was not to be, is of another campaign, is none, or cannot be written.
        """
        self.rows: dict[Key, Row] = {}
        self._file = file
        if resume and not file:
            raise InputError("--resume: goes on with the file of --json; name it")
        if not file:
            return
        there = file.exists() and file.stat().st_size > 0
        if there and not resume:
            raise InputError(f"--json {file}: is there already; go on with it by --resume, or name another file")
        text = _text(file) if there else ""
        whole = text[: text.rfind("\n") + 1]  # what was cut off in the middle of a line is run again
        if whole:
            self._take(whole, about)
        try:
            file.write_text(whole or json.dumps({"campaign": about}) + "\n", encoding="utf-8")
        except OSError as error:
            raise _not_written(file, error) from error

    def add(self, row: Row) -> None:
        """Take a case that is done, and write its line.

        Raises:
            InputError: the file cannot be written.
        """
        self.rows[row.key] = row
        if not self._file:
            return
        try:
            with self._file.open("a", encoding="utf-8") as file:
                file.write(row.line() + "\n")
        except OSError as error:
            raise _not_written(self._file, error) from error

    def put_in_order(self) -> None:
        """The lines by motor and number, so that the file is the same whoever of the workers was done first.

        Raises:
            InputError: the file cannot be written.
        """
        if not self._file or self._file.is_symlink() or not self._file.is_file():  # a pipe, or an output of the shell
            return
        text = _text(self._file)
        head = text[: text.find("\n") + 1]
        ordered = head + "".join(self.rows[key].line() + "\n" for key in sorted(self.rows))
        if ordered != text:
            whole_file.write(self._file, ordered, "--json")

    def _take(self, text: str, about: Mapping[str, object]) -> None:
        try:
            head, *rows = map(json.loads, text.splitlines())
            before = dict(head["campaign"])
            found = [_read(stored) for stored in rows]
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(f"--json {self._file}: holds no cases of stillspin campaign; name another file") from error
        for key, value in about.items():
            if before.get(key) != value:
                raise InputError(
                    f"--resume: {self._file} is of another campaign: {key} was {before.get(key)}, now {value};"
                    " name another file"
                )
        self.rows |= {row.key: row for row in found}


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"--json {file}: cannot be read ({error})") from error


def _not_written(file: Path, error: OSError) -> InputError:
    return InputError(f"--json {file}: cannot be written ({error.strerror})")
