"""Pieces of pages that are templates, and the figures that they name.

A template reaches the figures of a record (book/records.py) as `data.NAME`, whether the drive fits its chip as `fit`,
the files of motors and profiles as `motors` and `profiles`, the motors of others as `catalogue`; `value(…)` and the
others below write a value as the book does. A figure that misses its goal is bold.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError, TemplateNotFound

from book import chip, records
from stillspin import catalogue

TEMPLATES = "toolchain/book/pieces"


def number(value: float | None, digits: int = 2) -> str:
    """A number with so many significant digits, and never more than the whole number needs; a dash for none."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    text = f"{value:.{decimals}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", "−")


def fixed(value: float | None, decimals: int = 1) -> str:
    """A number with so many decimals; a dash for none."""
    return "–" if value is None else f"{value:.{decimals}f}".replace("-", "−")


def _figure(scenarios: Mapping[str, Any], path: str) -> Mapping[str, Any]:
    scenario, _, name = path.partition(".")
    try:
        return scenarios[scenario][name]  # type: ignore[no-any-return]
    except KeyError:
        known = ", ".join(scenarios.get(scenario, {})) or "nothing"
        raise LookupError(f"no figure {path}; of {scenario} there is {known}") from None


def value(scenarios: Mapping[str, Any], path: str, unit: str = "", digits: int = 2) -> str:
    """A figure such as `A10.speed_ripple`, its unit right behind it, bold where it misses its goal."""
    figure = _figure(scenarios, path)
    number_of = figure["value"]
    text = "lost" if number_of is None else number(number_of, digits) + unit
    return f"**{text}**" if figure.get("met") is False else text


def shown(scenarios: Mapping[str, Any], path: str, unit: str = "") -> str:
    """A figure with its unit, without verdict; `lost` where the run did not come to it."""
    number_of = _figure(scenarios, path)["value"]
    return "lost" if number_of is None else number(number_of) + unit


def tally(scenarios: Mapping[str, Any], family: str = "A") -> str:
    """`29 of 30`: goals of the scenarios of a family that are met."""
    own = [figures for name, figures in scenarios.items() if name.startswith(family)]
    met = [figure["met"] for figures in own for figure in figures.values() if figure["goal"] is not None]
    return f"{sum(map(bool, met))} of {len(met)}"


def plain(scenarios: Mapping[str, Any], path: str, decimals: int = 1) -> str:
    """A figure with so many decimals, without unit and verdict."""
    return fixed(_figure(scenarios, path)["value"], decimals)


def within(scenarios: Mapping[str, Any], path: str, goal: float) -> str:
    """A figure, bold where it is beyond a goal."""
    number_of = _figure(scenarios, path)["value"]
    text = "lost" if number_of is None else number(number_of)
    return text if number_of is not None and abs(number_of) <= goal else f"**{text}**"


def share(found: float, true: float) -> str:
    """`+1.4 %`: how far a value is from the true one."""
    return f"{100 * (found / true - 1):+.1f} %".replace("-", "−")


def printed(scenarios: Mapping[str, Any], path: str) -> str:
    """A line of what `stillspin reproduce` prints."""
    figure = _figure(scenarios, path)
    scenario, _, name = path.partition(".")
    unit = {"deg el": "° el"}.get(figure["unit"], figure["unit"])
    paper, goal = (number(figure[key], 3) for key in ("paper", "goal"))
    verdict = {True: "met", False: "missed", None: ""}[figure["met"]]
    value_of = number(figure["value"], 3)
    return f"{scenario:9} {name:32} {value_of:>5}  {unit:5} {paper:>5} {goal:>5}  {verdict}".rstrip()


def held(holds: Sequence[Sequence[float | None]], speed: float) -> str:
    """The peak of the position error at the first stretch at a speed (rpm); a dash where the shaft was lost."""
    return fixed(next((peak for held_at, peak in holds if held_at is not None and abs(held_at - speed) < 1.0), None))


def over_speed(runs: Mapping[str, Sequence[Sequence[float | None]]], loads: Mapping[str, str]) -> str:
    """A table of every estimator beside the others, a row for each speed that is held on the way down."""
    ways = {"observer": "observer", "paper": "ZVV, AVV", "active": "active", "conv": "CONV"}
    ways |= {"pp01": "PP-01", "pp02": "PP-02"}
    out = ["| load | rpm | " + " | ".join(ways.values()) + " |", "| --- | --- |" + " --- |" * len(ways)]
    for load, words in loads.items():
        for k, (speed, _) in enumerate(runs[f"observer_{load}"]):
            cells = [held(runs.get(f"{way}_{load}", []), speed) if speed is not None else "" for way in ways]
            out.append(f"| {'' if k else words} | {fixed(speed, 0)} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def counted(found: Mapping[str, Any] | None) -> str:
    """Two cells: instructions in the mean and at most."""
    return f"{fixed(found['mean'], 0)} | {found['worst']}" if found else " | "


def run_by_run(cost: Mapping[str, Any], sources: Sequence[str]) -> str:
    """A table of the control interrupt's instructions, a row for each run, by its speed."""
    head = " | ".join(f"{source}: mean | worst" for source in sources)
    out = [f"| at rpm | {head} |", "| --- |" + " --- | --- |" * len(sources)]
    names = {name for source in sources for name in cost[source]["runs"]}
    for name in sorted(names, key=lambda name: (int(name.partition(",")[0]), name)):
        cells = (counted(cost[source]["runs"].get(name)) for source in sources)
        out += [f"| {name} | {' | '.join(cells)} |"]
    return "\n".join(out)


def thousands(whole: int) -> str:
    """1 234 567."""
    return f"{whole:,}".replace(",", " ")


def identical(rows: Sequence[Mapping[str, Any]]) -> str:
    """`180 of 180`: runs in which board and virtual drive agreed to the end."""
    same = sum(bool(row["board"]) and row["board"] == row["native"] and not row["lost"] for row in rows)
    return f"{same} of {len(rows)}"


USED = (
    *(value, shown, number, fixed, tally, plain, within, share, printed, held, over_speed, counted, run_by_run),
    *(thousands, identical, chip.hundreds, chip.chance),
)


def _files(folder: Path) -> dict[str, Any]:
    return {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.toml"))}


def environment(root: Path) -> Environment:
    """What templates may use."""
    made = Environment(
        loader=FileSystemLoader(root / TEMPLATES),
        autoescape=False,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    data = {name: record["figures"] for name, record in records.load(root).items()}
    made.globals.update(data=data, **{each.__name__: each for each in USED})
    made.globals.update(motors=_files(root / "sim_host/motors"), profiles=_files(root / "sim_host/profiles"))
    made.globals["catalogue"] = catalogue.entries(root / "sim_host/motors/catalogue")
    if {"image", "isr-cost"} <= data.keys():
        made.globals["fit"] = chip.fit(root, data["image"], data["isr-cost"])
    return made


def drawn_from(root: Path, name: str) -> set[str]:
    """The records that a piece's template names; none where it has no template."""
    path = root / TEMPLATES / f"{name}.md.j2"
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    named = {known for known in records.load(root) if re.search(rf'\bdata\.{known}\b|"{known}"', text)}
    return named | ({"image", "isr-cost"} if re.search(r"\bfit\.|_chip", text) else set())


def piece(root: Path, name: str) -> str:
    """A piece by its template.

    Raises:
        LookupError: there is no such template, or no such figure.
    """
    try:
        return environment(root).get_template(f"{name}.md.j2").render()
    except TemplateNotFound:
        raise LookupError(f"nothing makes the piece {name}: there is no {TEMPLATES}/{name}.md.j2") from None
    except (TemplateError, TypeError) as error:
        raise LookupError(f"{TEMPLATES}/{name}.md.j2: {error}") from None
