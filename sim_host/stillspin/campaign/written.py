"""A case as a scenario file, which `stillspin run` takes without the campaign."""

from __future__ import annotations

import json
import shlex
from collections.abc import Mapping
from pathlib import Path

from stillspin import resources
from stillspin.campaign.draw import PLAIN_NOISE, Case, Drawer, Unit


def text(named: Path, unit: Unit, case: Case, drawer: Drawer, why: str) -> str:
    """What the file has.

    Args:
        named: its path, whose stem is the scenario's id.
        unit: the motor.
        case: what departs.
        drawer: what that was drawn from.
        why: what becomes of it.
    """
    scenario = unit.scenario(case, drawer, named.stem)
    run, figure = scenario.runs[0], scenario.figures[0]
    ships = unit.motor in resources.names("motors")
    lines = [
        f"# {run_command(named, unit, case)}",
        "",
        f"id = {_text(scenario.id)}",
        f"title = {_text(scenario.title)}",
        f"motor = {_text(unit.motor if ships else resources.DEFAULT_MOTOR)}",
        f"description = {_text(f'{scenario.description} What becomes of it: {why}.')}",
        "on_demand = true",
        "",
        "[[runs]]",
        f"name = {_text(run.name)}",
        f"duration = {run.duration!r}",
        f"max_start = {run.max_start!r}",
        f"record_every = {run.record_every}",
        f"commands = {_value([list(command) for command in run.commands])}",
        f"load = {_value([list(corner) for corner in run.load])}",
        f"reached = [{', '.join(_inline({'window': list(r.window), 'band': r.band}) for r in run.reached)}]",
        f"plant = {_inline(run.plant)}",
        f"factor = {_inline(run.factors)}",
        f"parameters = {_inline(unit.told)}",
        "",
        "[[figures]]",
        f"name = {_text(figure.name)}",
        f"window = {_value(list(figure.windows[0]))}",
        f"goal = {_value(figure.goal.default)}",
    ]
    return "\n".join(lines) + "\n"


def run_command(named: Path, unit: Unit, case: Case) -> str:
    """What the shell is told to run it."""
    words = ["stillspin", "run", str(named), "--profile", unit.profile]
    if unit.motor not in resources.names("motors"):
        words += ["--motor", unit.motor]
    if case.noise != PLAIN_NOISE:
        words += ["--seed", str(case.noise)]
    for change in unit.settings.changes.words:
        words += ["--set", change]
    return shlex.join(words)


def _text(words: str) -> str:
    """A basic string of TOML, whose escapes are those of JSON."""
    return json.dumps(words, ensure_ascii=False)


def _value(value: object) -> str:
    """As TOML has it; a number with all its digits."""
    if isinstance(value, bool | str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value)


def _inline(table: Mapping[str, object]) -> str:
    """An inline table, with those in it."""
    parts = (
        f"{key} = {_inline(value) if isinstance(value, Mapping) else _value(value)}" for key, value in table.items()
    )
    return f"{{ {', '.join(parts)} }}" if table else "{}"
