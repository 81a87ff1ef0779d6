"""Results of a board in the loop as a file: renewed behind every run, nothing is lost when one breaks off."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from stillspin import whole_file
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.hil.loop import LoopResult
from stillspin.hil.runs import LoopRun

Key = tuple[str, str, str, bool, str]


@dataclass(frozen=True)
class Row:
    """One run over one way to the board.

    Attributes:
        profile: of the plant.
        whole: to its end; only its start otherwise.
        link: the way: serial or can.
        firmware: the board's version, board file, build and table.
        board, native: hashes over everything that the two said.
        seconds: how long `steps` took.
        step, words: the first period that differed, where one did.
        ended: why the run broke off, empty when it did not.
        lost: why the loop broke off, empty when it did not; lost_code: the exit status of that.
    """

    scenario: str
    run: str
    profile: str
    whole: bool
    link: str
    revision: str
    board: str = ""
    native: str = ""
    steps: int = 0
    seconds: float = 0.0
    step: int | None = None
    words: str = ""
    ended: str = ""
    lost: str = ""
    lost_code: int = ExitCode.DONE
    firmware: str = ""

    @property
    def exit_code(self) -> int:
        """What a command ends with whose result this is."""
        if self.lost:
            return self.lost_code
        return ExitCode.DONE if self.identical else ExitCode.DIFFERS

    @property
    def identical(self) -> bool:
        """Whether board and virtual drive agreed to the end."""
        return bool(self.board) and self.board == self.native and not self.lost

    @property
    def rate(self) -> float:
        """Steps per second."""
        return self.steps / self.seconds if self.seconds > 0.0 else 0.0

    @property
    def key(self) -> Key:
        """Which run over which way."""
        return self.scenario, self.run, self.profile, self.whole, self.link


def begun(run: LoopRun, link: str, revision: str) -> Row:
    """A run of which nothing is known yet."""
    return Row(run.scenario, run.name, run.profile, run.whole, link, revision)


def ended(row: Row, result: LoopResult) -> Row:
    """The row of a run that came to its end, or to its first difference."""
    found = result.difference
    return replace(
        row,
        board=result.board,
        native=result.native,
        steps=result.steps,
        seconds=round(result.seconds, 3),
        step=found.step if found else None,
        words=found.words if found else "",
        ended=result.reason,
    )


class Results:
    """Rows, and the file that has them; a row replaces an earlier one of the same run over the same way."""

    def __init__(self, file: Path | None) -> None:
        """What the file has already, if there is one.

        Raises:
            InputError: it holds something else, or cannot be read.
        """
        self._file = file
        self.rows: dict[Key, Row] = {}
        if file and file.exists():
            self._read(file)

    def add(self, new: Row) -> None:
        """Take a row and renew the file.

        Raises:
            InputError: it cannot be written.
        """
        self.rows[new.key] = new
        if not self._file:
            return
        text = json.dumps({"runs": [asdict(item) for item in self.rows.values()]}, indent=1) + "\n"
        whole_file.write(self._file, text, "--json")

    def _read(self, file: Path) -> None:
        try:
            stored: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
            for fields in stored["runs"]:
                item = Row(**fields)
                self.rows[item.key] = item
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(f"--json {file}: holds no results of stillspin hil; name another file") from error
