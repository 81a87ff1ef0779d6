"""Reads scenario files. What may stand where is in their schema (file_schema.py); here is what relates two places.

Shorthands of the format: `[defaults]` holds what the runs have in common; `reference` in a run draws a moving speed
command (a sine, or straight lines through points) as set points every `interval` seconds, or with `what` another
command such as `set:encoder_trim`. `waveform` in a run asks for what happens inside the periods of a short stretch.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from stillspin import core, json_schema, resources, toml_table
from stillspin.cases import file_schema, vocabulary
from stillspin.cases.scenario import RATIO, Figure, Goal, Plot, Reached, Run, Scenario, Window
from stillspin.core import Command, Look
from stillspin.errors import InputError, did_you_mean
from stillspin.json_schema import Json


class RelationError(InputError):
    """Two places of a file that do not fit together, which a schema cannot say."""


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
    data = toml_table.read(path).items()
    json_schema.check(data, _schema(), str(path))
    if data["id"] != path.stem:
        raise RelationError(f"{path}: id = '{data['id']}': must be the file's name, '{path.stem}'")
    schemes = _schemes(data, path)
    stated = [_with_defaults(run, data.get("defaults", {}), schemes) for run in data["runs"]]
    runs = tuple(_run(run, f"{path}: runs[{number}]") for number, run in enumerate(stated))
    names = _unique([run.name for run in runs], f"{path}: runs")
    figures = tuple(_figure(item, runs, f"{path}: figures[{n}]") for n, item in enumerate(data["figures"]))
    _unique([figure.name for figure in figures], f"{path}: figures")
    _check_ratios(figures, path)
    plots = tuple(_plot(item, names, f"{path}: plots[{n}]") for n, item in enumerate(data.get("plots", [])))
    paper = data.get("paper", {})
    return Scenario(
        id=data["id"],
        title=data["title"],
        motor=data["motor"],
        description=data.get("description", "").strip(),
        paper_figure=paper.get("figure", ""),
        paper_says=paper.get("says", ""),
        runs=runs,
        figures=figures,
        plots=plots or (Plot("", _PANELS, tuple(names), None),),
        on_demand=data.get("on_demand", False),
    )


def _schema() -> Json:
    native = core.load()
    return file_schema.scenario(core.plant_schema(native), core.at_some_scale(core.parameters(native)))


def _schemes(data: Json, path: Path) -> dict[str, Json]:
    """The parameters of each scheme that a run of the scenario names."""
    found: dict[str, Json] = {}
    for name in sorted({part["scheme"] for part in (data.get("defaults", {}), *data["runs"]) if part.get("scheme")}):
        table = toml_table.read(resources.find("schemes", name)).items()
        if table["motor"] != data["motor"]:
            raise RelationError(
                f"{path}: scheme = '{name}': is of motor {table['motor']}, and the scenario of {data['motor']}"
            )
        found[name] = table["parameters"]
    return found


def _with_defaults(run: Json, defaults: Json, schemes: dict[str, Json]) -> Json:
    """The run with what it does not state itself taken from the defaults; parameters and plant are joined by key."""
    joined = {key: {**defaults.get(key, {}), **run.get(key, {})} for key in ("parameters", "plant", "factor")}
    scheme = run.get("scheme", defaults.get("scheme"))
    if scheme:
        joined["parameters"] = {**schemes[scheme], **joined["parameters"]}
    return {**defaults, **run, **joined}


def _unique(names: list[str], where: str) -> list[str]:
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise RelationError(f"{where}: the name '{min(twice)}' is used twice")
    return names


def _window(value: Sequence[float], duration: float, where: str) -> Window:
    first, last = map(float, value)
    if not first < last <= duration:
        raise RelationError(f"{where} = {value!r}: must be [from, to] in s with 0 ≤ from < to ≤ {duration:g}")
    return first, last


def _run(stated: Json, where: str) -> Run:
    duration = float(stated["duration"])
    commands = [(float(at), what, float(value)) for at, what, value in stated.get("commands", [])]
    commands += _reference(stated["reference"]) if "reference" in stated else []
    late = [at for at, _, _ in commands if at > duration]
    if late:
        raise RelationError(f"{where}.commands: the time {late[0]:g} s is not within 0 … {duration:g} s")
    load = stated.get("load", [])
    if any(later[0] <= earlier[0] for earlier, later in pairwise(load)):
        raise RelationError(f"{where}.load = {load!r}: the times must rise")
    return Run(
        name=stated["name"],
        title=stated.get("title", ""),
        duration=duration,
        max_start=float(stated.get("max_start", 3.0)),
        commands=tuple(sorted(commands, key=lambda command: command[0])),
        load=tuple((float(at), float(torque)) for at, torque in load),
        parameters={name: _plain(value) for name, value in stated["parameters"].items()},
        plant=stated["plant"],
        reached=tuple(_reached(item, duration, f"{where}.reached[{n}]") for n, item in enumerate(stated["reached"])),
        record_every=int(stated.get("record_every", 1)),
        waveform=_look(stated["waveform"], duration, f"{where}.waveform") if "waveform" in stated else None,
        may_be_lost=stated.get("may_be_lost", False),
        factors=stated["factor"],
    )


def _plain(value: float | str) -> float | str:
    return value if isinstance(value, str) else float(value)


def _look(stated: Json, duration: float, where: str) -> Look:
    """The stretch that is looked into."""
    first, last = _window(stated["window"], duration, f"{where}.window")
    return first, last, int(stated.get("raster", 100))


def _reached(stated: Json, duration: float, where: str) -> Reached:
    speed = stated.get("speed")
    window = _window(stated["window"], duration, f"{where}.window")
    return Reached(window, float(stated["band"]), None if speed is None else float(speed))


def _reference(drawing: Json) -> list[Command]:
    """Set points of a moving command, the speed where it does not say which."""
    what, interval = drawing.get("what", "speed_ref_rpm"), drawing.get("interval", 0.001)
    if drawing["shape"] == "sine":
        start = drawing["start"]
        time = np.arange(start, drawing["stop"], interval)
        speed = drawing["amplitude"] * np.sin(2.0 * np.pi * drawing["frequency"] * (time - start))
    else:
        at, value = (np.array(column, dtype=float) for column in zip(*drawing["points"], strict=True))
        time = np.arange(at[0], at[-1] + interval / 2.0, interval)
        speed = np.interp(time, at, value)
    return [(float(t), what, float(n)) for t, n in zip(time.round(9), speed.round(9), strict=True)]


def _goal(stated: float | dict[str, float] | None) -> Goal:
    if not isinstance(stated, dict):
        return Goal(None if stated is None else float(stated))
    numbers = {profile: float(number) for profile, number in stated.items()}
    return Goal(numbers.pop("default", None), numbers)


def _figure(stated: Json, runs: tuple[Run, ...], where: str) -> Figure:
    kind = str(stated.get("kind", stated["name"]))
    chosen = _runs(stated, [run.name for run in runs], where)
    paper = stated.get("paper")
    ratio = kind == RATIO
    return Figure(
        name=stated["name"],
        kind=kind,
        unit="" if ratio else vocabulary.KINDS[kind].unit,
        runs=() if ratio else chosen,
        windows=() if ratio else _windows(stated, min(run.duration for run in runs if run.name in chosen), where),
        paper=None if paper is None else float(paper),
        goal=_goal(stated.get("goal")),
        of=tuple(stated["of"]) if ratio else None,
        note=stated.get("note", ""),
    )


def _windows(stated: Json, duration: float, where: str) -> tuple[Window, ...]:
    """One window, or a list of them."""
    value = stated["window"]
    several = value if isinstance(value[0], list) else [value]
    return tuple(_window(item, duration, f"{where}.window") for item in several)


def _listed(value: str | list[str]) -> list[str]:
    return [value] if isinstance(value, str) else value


def _runs(stated: Json, known: list[str], where: str) -> tuple[str, ...]:
    """The runs that a figure or plot is about: all of them when it does not say."""
    chosen = _listed(stated.get("runs", known))
    for name in chosen:
        if name not in known:
            raise RelationError(f"{where}.runs: there is no run '{name}'{did_you_mean(name, known)}")
    return tuple(chosen)


def _check_ratios(figures: tuple[Figure, ...], path: Path) -> None:
    """A ratio is of figures that stand before it, so that they are there when it is taken."""
    earlier: list[str] = []
    for figure in figures:
        for name in figure.of or ():
            if name not in earlier:
                raise RelationError(f"{path}: {figure.name}: no figure '{name}' before it{did_you_mean(name, earlier)}")
        earlier.append(figure.name)


def _plot(stated: Json, runs: list[str], where: str) -> Plot:
    window = stated.get("window")
    return Plot(
        title=stated.get("title", ""),
        panels=tuple(_listed(stated["panels"])),
        runs=_runs(stated, runs, where),
        window=_window(window, float("inf"), f"{where}.window") if window else None,
    )
