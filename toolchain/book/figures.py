"""Pieces of pages that are templates, and the figures that they name.

docs/figures/NAME.json is what one command gave (`make figures`, toolchain/figures.py): `command`, `sources` (a sum over
what decides the figures), `figures`. A template reaches it as `data.NAME`; `peak(…)` and the others below write a value
as the book does. A figure that misses its goal is bold.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateNotFound

FOLDER = "docs/figures"
TEMPLATES = "toolchain/book/pieces"


def load(root: Path) -> dict[str, Any]:
    """What all commands gave, by the name of the file."""
    files = sorted((root / FOLDER).glob("*.json"))
    return {path.stem: json.loads(path.read_text(encoding="utf-8"))["figures"] for path in files}


def number(value: float | None, digits: int = 2) -> str:
    """A number with so many significant digits, and never more than the whole number needs; a dash for none."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{float(text):f}".rstrip("0").rstrip(".") if abs(value) < 1 else f"{float(text):.0f}"
    elif abs(value) >= 10**digits:
        text = f"{value:.0f}"
    elif abs(value) < 10 ** (digits - 1) and "." in text and abs(value) >= 1:
        text = f"{value:.{digits - 1}f}"
    return text.replace("-", "−")


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


def tally(scenarios: Mapping[str, Any]) -> str:
    """`29 of 30`: goals that are met."""
    met = [figure["met"] for figures in scenarios.values() for figure in figures.values() if figure["goal"] is not None]
    return f"{sum(map(bool, met))} of {len(met)}"


def environment(root: Path) -> Environment:
    """What templates may use."""
    made = Environment(
        loader=FileSystemLoader(root / TEMPLATES),
        autoescape=False,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals.update(data=load(root), value=value, number=number, fixed=fixed, tally=tally)
    return made


def piece(root: Path, name: str) -> str:
    """A piece by its template.

    Raises:
        LookupError: there is no such template, or no such figure.
    """
    try:
        return environment(root).get_template(f"{name}.md.j2").render()
    except TemplateNotFound:
        raise LookupError(f"nothing makes the piece {name}: there is no {TEMPLATES}/{name}.md.j2") from None
