"""The motor's nameplate on the page: ten questions, what will work with the answers, the parameters that follow."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from stillspin import core, scales
from stillspin.cases import motor_check, nameplate, profile, questions, similarity
from stillspin.cases.motor_told import Finding, Motor
from stillspin.counted import counted
from stillspin.drive import parameter_file
from stillspin.drive.table import Parameter, Table
from stillspin.entry import Entry
from stillspin.errors import InputError
from stillspin.tune.messages import Message, shown_unit
from stillspin.tune.workbench import Workbench

_NOT_ON_IT = {("machine", "saturation"): 1.0}
"""What the physics asks and no nameplate says; as the plant has it by default."""
_PATIENCE = 120.0


@dataclass(frozen=True)
class _Asked:
    """The motor of the answers at this drive, see motor_told.Described."""

    machine: core.Plant
    parameters: Mapping[str, float]

    def plant(self, section: str, key: str) -> float:
        value = self.machine[section].get(key)
        return _NOT_ON_IT[section, key] if value is None else float(value)

    def told(self, name: str) -> float:
        return self.parameters[name]


def asked(table: Table, values: Mapping[str, float]) -> list[Message]:
    """The questions as this drive's parameters answer them; none for a drive that lacks one of them."""
    needed = {name for question in questions.QUESTIONS for name in question.needs} | {"link_full_scale"}
    if not all(table.has_parameter(name) for name in needed):
        return []
    return [
        {"key": each.key, "text": each.text, "unit": shown_unit(each.unit), "known": _shown(each, values)}
        for each in questions.QUESTIONS
    ]


def _shown(question: questions.Question, values: Mapping[str, float]) -> str:
    return f"{question.known(values):.4g}"


def _answers(typed: Mapping[str, Any], now: Mapping[str, float]) -> dict[str, float]:
    """What is typed as it was shown is what the drive has, to the last digit."""
    kept = {each.key: each.known(now) for each in questions.QUESTIONS if typed.get(each.key) == _shown(each, now)}
    return questions.read({**typed, **kept})


def check(bench: Workbench, typed: Mapping[str, Any]) -> Message:
    """What will work with a motor and what will not, and which parameters follow from it.

    Raises:
        InputError: an answer is no number or out of range.
    """
    now = bench.drive.parameters()
    answers = _answers(typed, now)
    follows = _following(answers, now, bench.drive.table)
    machine = questions.plant(answers, now["link_full_scale"])
    found = [
        _ranges(follows, bench.drive.table.with_scales(now, follows)),
        *motor_check.physics(_Asked(machine, now | follows)),
    ]
    tried, missing = _elsewhere(answers, now | follows) if found[0].works else ([], "")
    rows = parameter_file.differences(now, follows, bench.drive.table.with_scales(now, follows), follows)
    return {
        "findings": [asdict(finding) for finding in (*found, *tried)],
        "missing": missing,
        "changes": [
            {"name": entry.name, "unit": shown_unit(entry.unit), "decimals": entry.decimals, "now": old, "then": new}
            for entry, old, new in rows
        ],
    }


def use(bench: Workbench, typed: Mapping[str, Any]) -> Message:
    """Put what follows from the answers into the drive.

    Raises:
        InputError: an answer is no number or out of range.
    """
    drive = bench.drive
    now = drive.parameters()
    follows = _following(_answers(typed, now), now, drive.table)
    drive.set_scales(follows)
    rows = parameter_file.differences(drive.parameters(), follows, drive.table, follows)
    complaints = parameter_file.put(drive, rows)
    values = drive.parameters()
    bench.streamer.learn(values)
    return {"values": values, "complaints": complaints}


def _following(answers: questions.Answers, now: Mapping[str, float], table: Table) -> dict[str, float]:
    """In steps that the drive knows; the range of the link's divider is the board's."""
    limits = questions.stated(answers)
    plant = questions.plant(answers, now["link_full_scale"])
    follows = nameplate.following(plant, limits) | limits
    moved = table.with_scales(now, follows).parameters
    follows |= similarity.values(plant, follows, {each.name: _entry(each, follows) for each in moved})
    return {name: value for name, value in follows.items() if table.has_parameter(name)}


def _entry(parameter: Parameter, told: Mapping[str, float]) -> Entry:
    """What the drive says of a parameter, at the scales that it is told."""
    exponent = scales.exponent(parameter.unit, scales.of(told))
    bounds = parameter.minimum, parameter.maximum, parameter.initial
    return Entry(parameter.name, parameter.unit, *bounds, parameter.meaning, exponent=exponent)


def _ranges(follows: Mapping[str, float], table: Table) -> Finding:
    complaints = []
    for name, value in follows.items():
        try:
            table.parameter(name).to_raw(value)
        except InputError as error:
            complaints.append(str(error))
    good = f"all {counted(len(follows), 'value')} are within the ranges of the drive's parameters"
    return Finding("range", not complaints, "; ".join(complaints) or good)


def _elsewhere(answers: questions.Answers, parameters: dict[str, float]) -> tuple[list[Finding], str]:
    """In a process of its own: the drive that the page tunes may be a virtual one in this process."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        try:
            return pool.submit(of_the_virtual_drive, answers, parameters).result(_PATIENCE)
        except (BrokenProcessPool, TimeoutError):
            return [], "the virtual drive could not be asked: a start with this motor was not tried"


def of_the_virtual_drive(answers: questions.Answers, parameters: dict[str, float]) -> tuple[list[Finding], str]:
    """Whether the drive takes the parameters together, and a start that is tried; what is missing, in words."""
    try:
        native = core.load()
    except InputError as error:
        return [], f"the drive's rules were not asked and no start was tried: {error}"
    known = core.parameters(native)
    held = motor_check.rules({name: value for name, value in parameters.items() if name in known}, native)
    if not held.works:
        return [held], ""
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "motor.toml"
        path.write_text(questions.file_text("motor", answers), encoding="utf-8")
        schema = core.plant_schema(native)
        chosen = profile.load("bench", schema, known, str(path), checked=False)
    return [held, motor_check.tried(Motor(chosen, schema, core.at_scale(known, chosen.parameters)), native)], ""
