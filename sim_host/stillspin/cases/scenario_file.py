"""Reads and checks scenario files. Every complaint names the file, the place, the value and what is allowed.

Shorthands of the format: `[defaults]` holds what the runs have in common; `reference` in a run draws a moving speed
command (a sine, or straight lines through points) as set points every `interval` seconds, or with `what` another
command such as `set:encoder_trim`. `waveform` in a run asks for what happens inside the periods of a short stretch.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from stillspin import resources, toml_table
from stillspin.cases.scenario import Figure, Goal, Plot, Reached, Run, Scenario, Window
from stillspin.core import Command, Look, Plant
from stillspin.errors import InputError, did_you_mean
from stillspin.measure import metrics
from stillspin.report import panels
from stillspin.toml_table import Table

_NAME = re.compile(r"[a-z0-9_]+")
_PANELS = ("speed", "position_error", "torque", "currents")
"""Drawn of a scenario that does not say what to draw."""


def ids() -> list[str]:
    """Ids of all scenarios that ship with the package."""
    return resources.names("scenarios")


def campaign_ids(motors: Collection[str]) -> list[str]:
    """Ids of the scenarios that run where none is named: those for one of these motors."""
    return [scenario.id for scenario in map(load, ids()) if scenario.motor in motors and not scenario.on_demand]


def find(identifier: str) -> Path:
    """The file of a scenario; upper and lower case are the same.

    Raises:
        InputError: there is no such scenario.
    """
    known = {name.lower(): name for name in ids()}
    if identifier.lower() not in known:
        raise InputError(f"there is no scenario '{identifier}'{did_you_mean(identifier, known.values())}")
    return resources.directory("scenarios") / f"{known[identifier.lower()]}.toml"


def load(identifier: str) -> Scenario:
    """The scenario with this id.

    Raises:
        InputError: there is none, or its file is wrong.
    """
    return read(find(identifier))


def read(path: Path) -> Scenario:
    """The scenario in a file.

    Raises:
        InputError: the file is wrong.
    """
    table = toml_table.read(path)
    identifier = table.text("id")
    if identifier != path.stem:
        raise table.fail("id", f"must be the file's name, '{path.stem}'")
    motor = table.text("motor")
    motors = resources.names("motors")
    if motor not in motors:
        raise table.fail("motor", f"must be one of {', '.join(motors)}")
    paper = table.table("paper")
    defaults = table.table("defaults").items()
    runs = tuple(_run(_with_defaults(run, defaults)) for run in table.tables("runs"))
    names = _unique(table, "runs", [run.name for run in runs])
    figures = tuple(_figure(figure, runs) for figure in table.tables("figures"))
    _unique(table, "figures", [figure.name for figure in figures])
    _check_ratios(table, figures)
    scenario = Scenario(
        id=identifier,
        title=table.text("title"),
        motor=motor,
        description=table.text("description", "").strip(),
        paper_figure=paper.text("figure", ""),
        paper_says=paper.text("says", ""),
        runs=runs,
        figures=figures,
        plots=tuple(_plot(plot, names) for plot in table.tables("plots")) or (Plot("", _PANELS, tuple(names), None),),
        on_demand=table.switch("on_demand"),
    )
    paper.finish()
    table.finish()
    return scenario


def _with_defaults(run: Table, defaults: dict[str, Any]) -> Table:
    """The run with what it does not state itself taken from the defaults; tables are joined key by key."""
    joined = dict(defaults)
    for key, value in run.items().items():
        if isinstance(value, dict) and isinstance(defaults.get(key), dict):
            joined[key] = {**defaults[key], **value}
        else:
            joined[key] = value
    return Table(joined, run.where)


def _unique(table: Table, key: str, names: list[str]) -> list[str]:
    if not names:
        raise InputError(f"{table.where}: there must be at least one of [[{key}]]")
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise InputError(f"{table.where}: {key}: the name '{min(twice)}' is used twice")
    return names


def _name(table: Table) -> str:
    name = table.text("name")
    if not _NAME.fullmatch(name):
        raise table.fail("name", "must be lower case letters, digits and '_'")
    return name


def _window(table: Table, key: str, value: Any, duration: float) -> Window:
    problem = table.fail(key, f"must be [from, to] in s with 0 ≤ from < to ≤ {duration:g}")
    if not isinstance(value, list) or len(value) != 2:
        raise problem
    first, last = (toml_table.as_number(item) for item in value)
    if first is None or last is None or not 0.0 <= first < last <= duration:
        raise problem
    return first, last


def _run(table: Table) -> Run:
    duration = table.number("duration", minimum=0.001)
    commands: list[Command] = [*table.rows("commands", float, str, float), *_reference(table)]
    late = [at for at, _, _ in commands if not 0.0 <= at <= duration]
    if late:
        raise table.fail("commands", f"the time {late[0]:g} s is not within 0 … {duration:g} s")
    load = table.rows("load", float, float)
    if any(later[0] <= earlier[0] for earlier, later in pairwise(load)):
        raise table.fail("load", "the times must rise")
    run = Run(
        name=_name(table),
        title=table.text("title", ""),
        duration=duration,
        max_start=table.number("max_start", 3.0, minimum=0.0),
        commands=tuple(sorted(commands, key=lambda command: command[0])),
        load=tuple((at, torque) for at, torque in load),
        parameters=_parameters(table.table("parameters")),
        plant=_plant(table.table("plant")),
        reached=tuple(_reached(reached, duration) for reached in table.tables("reached")),
        record_every=table.whole("record_every", 1, minimum=1),
        waveform=_look(table, duration),
        may_be_lost=table.switch("may_be_lost"),
    )
    if not run.reached:
        raise InputError(f"{table.where}: 'reached' is missing: a run counts only if the shaft did what was commanded")
    table.finish()
    return run


def _look(table: Table, duration: float) -> Look | None:
    """The stretch that is looked into."""
    if not table.has("waveform"):
        return None
    look = table.table("waveform")
    first, last = _window(look, "window", look.raw("window"), duration)
    raster = look.whole("raster", 100, minimum=1)
    look.finish()
    return first, last, raster


def _parameters(table: Table) -> dict[str, float | str]:
    values: dict[str, float | str] = {}
    for name, value in table.items().items():
        number = toml_table.as_number(value)
        if number is None and not isinstance(value, str):
            raise table.fail(name, "must be a number or the name of a choice")
        values[name] = value if number is None else number
    return values


def _plant(table: Table) -> Plant:
    plant: Plant = {}
    for section, keys in table.items().items():
        if not isinstance(keys, dict):
            raise table.fail(section, "must be a table of plant entries")
        plant[section] = keys
    return plant


def _reached(table: Table, duration: float) -> Reached:
    reached = Reached(
        window=_window(table, "window", table.raw("window"), duration),
        band=table.number("band", minimum=0.0),
        speed=table.optional_number("speed"),
    )
    table.finish()
    return reached


def _reference(table: Table) -> list[Command]:
    """Set points of a moving command, the speed where it does not say which."""
    if not table.has("reference"):
        return []
    drawing = table.table("reference")
    shape = drawing.text("shape")
    what = drawing.text("what", "speed_ref_rpm")
    interval = drawing.number("interval", 0.001, minimum=1e-4)
    if shape == "sine":
        start, stop = drawing.number("start", minimum=0.0), drawing.number("stop", minimum=0.0)
        time = np.arange(start, stop, interval)
        speed = drawing.number("amplitude") * np.sin(2.0 * np.pi * drawing.number("frequency") * (time - start))
    elif shape == "points":
        points = drawing.rows("points", float, float)
        if len(points) < 2:
            raise drawing.fail("points", "must have at least two points [s, rpm]")
        at, value = (np.array(column) for column in zip(*points, strict=True))
        time = np.arange(at[0], at[-1] + interval / 2.0, interval)
        speed = np.interp(time, at, value)
    else:
        raise drawing.fail("shape", "must be 'sine' or 'points'")
    drawing.finish()
    return [(float(t), what, float(n)) for t, n in zip(time.round(9), speed.round(9), strict=True)]


def _goal(table: Table) -> Goal:
    value = table.raw("goal")
    if not isinstance(value, dict):
        return Goal(table.optional_number("goal"))
    goals = {profile: toml_table.as_number(number) for profile, number in value.items()}
    numbers = {profile: number for profile, number in goals.items() if number is not None}
    if len(numbers) != len(goals):
        raise table.fail("goal", "must be a number, or a table of numbers by profile ('default' for all others)")
    return Goal(numbers.pop("default", None), numbers)


def _figure(table: Table, runs: tuple[Run, ...]) -> Figure:
    name = _name(table)
    kind = table.text("kind", name)
    of = _ratio_of(table) if kind == "ratio" else None
    if of is None and kind not in metrics.KINDS:
        raise InputError(
            f"{table.where}: '{kind}' is not a kind of figure{did_you_mean(kind, [*metrics.KINDS, 'ratio'])}"
        )
    chosen = _runs(table, [run.name for run in runs])
    figure = Figure(
        name=name,
        kind=kind,
        unit="" if of else metrics.KINDS[kind].unit,
        runs=() if of else chosen,
        windows=() if of else _windows(table, min(run.duration for run in runs if run.name in chosen)),
        paper=table.optional_number("paper"),
        goal=_goal(table),
        of=of,
        note=table.text("note", ""),
    )
    table.finish()
    return figure


def _ratio_of(table: Table) -> tuple[str, str]:
    names = table.texts("of")
    if len(names) != 2:
        raise table.fail("of", "must name the two figures whose ratio is taken")
    return names[0], names[1]


def _windows(table: Table, duration: float) -> tuple[Window, ...]:
    """One window, or a list of them."""
    value = table.raw("window")
    several = isinstance(value, list) and bool(value) and all(isinstance(item, list) for item in value)
    return tuple(_window(table, "window", item, duration) for item in (value if several else [value]))


def _runs(table: Table, known: list[str]) -> tuple[str, ...]:
    """The runs that a figure or plot is about: all of them when it does not say."""
    chosen = table.texts("runs") or known
    for name in chosen:
        if name not in known:
            raise InputError(f"{table.where}: there is no run '{name}'{did_you_mean(name, known)}")
    return tuple(chosen)


def _check_ratios(table: Table, figures: tuple[Figure, ...]) -> None:
    """A ratio is of figures that stand before it, so that they are there when it is taken."""
    earlier: list[str] = []
    for figure in figures:
        for name in figure.of or ():
            if name not in earlier:
                raise InputError(
                    f"{table.where}: {figure.name}: no figure '{name}' before it{did_you_mean(name, earlier)}"
                )
        earlier.append(figure.name)


def _plot(table: Table, runs: list[str]) -> Plot:
    chosen = table.texts("panels")
    for name in chosen:
        if name not in panels.PANELS:
            raise InputError(f"{table.where}: '{name}' is not a panel{did_you_mean(name, panels.PANELS)}")
    if not chosen:
        raise InputError(f"{table.where}: 'panels' is missing{did_you_mean('', panels.PANELS)}")
    plot = Plot(
        title=table.text("title", ""),
        panels=tuple(chosen),
        runs=_runs(table, runs),
        window=_window(table, "window", table.raw("window"), float("inf")) if table.has("window") else None,
    )
    table.finish()
    return plot
