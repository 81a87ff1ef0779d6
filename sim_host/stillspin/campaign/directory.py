"""What a campaign leaves behind: numbers, every case as a row of a table, and what its failures were shrunk to."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from stillspin import csv_table
from stillspin.campaign import tally, written
from stillspin.campaign.carry_out import Small
from stillspin.campaign.draw import Drawer, Unit
from stillspin.campaign.results import Row
from stillspin.report import output
from stillspin.runs.commission import Result
from stillspin.studies.reproduction import write_found

CASES = "cases.csv"
_VERDICT = ("end", "words", "wrong_s", "off_s", "angle_error_deg")
_DRAWN = ("fault", "fault_at", "noise_seed")
_HEAD = ("firmware", "revision", "spread", "faults", "seed")
"""What the head of the table says of the campaign; all of it is in the numbers."""


@dataclass(frozen=True)
class Outcome:
    """Of a campaign.

    Attributes:
        about: which it is; rows: its cases, in order; small: its failures that were shrunk.
        units: its motors by name; found: what their commissioning found; drawer: what was drawn from.
    """

    about: Mapping[str, object]
    rows: Sequence[Row]
    small: Sequence[Small]
    units: Mapping[str, Unit]
    found: Mapping[str, Result]
    drawer: Drawer


def write(directory: Path, final: Path, outcome: Outcome) -> list[str]:
    """Write everything into an existing directory, to be called `final`; what comes back is for the terminal."""
    files = [_file(directory, final, each, outcome) for each in outcome.small]
    for motor, result in outcome.found.items():
        settings = outcome.units[motor].settings
        write_found(directory / f"params-{settings.profile.motor}.toml", result, settings)
    names = [row.name for row in outcome.drawer.spread.departures]
    _table(directory / CASES, outcome, names)
    found = {
        **outcome.about,
        "motors": tally.published(outcome.rows, list(outcome.units)),
        "refusals": dict(tally.reasons(outcome.rows).most_common()),
        "shrunk": files,
    }
    (directory / output.MARK).write_text(json.dumps(found, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    return [f"{each['motor']}, case {each['number']}, needs: {each['needs']}; {each['command']}" for each in files]


def _file(directory: Path, final: Path, small: Small, outcome: Outcome) -> dict[str, object]:
    """The scenario file of a failure, and what is said of it."""
    row, case = small.row, small.shrunk.case
    unit = outcome.units[row.motor]
    named = final / f"{unit.plate.motor}-case-{row.case.number}.toml"
    content = written.text(named, unit, case, outcome.drawer, small.again.words)
    (directory / named.name).write_text(content, encoding="utf-8")
    return {
        "motor": row.motor,
        "number": row.case.number,
        "needs": outcome.drawer.words(case),
        "then": small.again.words,
        "runs": small.shrunk.runs,
        "command": written.run_command(named, unit, case),
    }


def _table(path: Path, outcome: Outcome, names: Sequence[str]) -> None:
    about = {key: outcome.about[key] for key in _HEAD}
    rows = (_cells(row, names) for row in outcome.rows)
    csv_table.write(path, about, ("motor", "number", *_VERDICT, *_DRAWN, *names), rows)


def _cells(row: Row, names: Sequence[str]) -> tuple[object, ...]:
    verdict, case = row.verdict, row.case
    judged = (verdict.end, verdict.words, verdict.wrong, verdict.off, verdict.error)
    drawn = (case.fault or "", case.at if case.fault else "", case.noise)
    return (row.motor, case.number, *judged, *drawn, *(case.drawn.get(name, 0.0) for name in names))
