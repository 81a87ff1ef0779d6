"""Results for people (`report.html`, one file with everything in it) and for programs (`metrics.json`)."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from stillspin import scheme
from stillspin.assess import ScenarioResult
from stillspin.execute import Settings
from stillspin.figures import Result
from stillspin.output import MARK, RUNS
from stillspin.profile import Profile

PAGE = "report.html"
PAPER = "paper.json"

PARAMETER_NOTE = "nominal parameters (from the nameplate)"
"""On which parameters the firmware ran: there is no commissioning yet that would find better ones."""


@dataclass(frozen=True)
class Tally:
    """How many goals there are, how many are met, and how many runs broke off."""

    goals: int
    met: int
    broken: int

    @property
    def verdict(self) -> str:
        """`broken off`, `short`, `met`, or `stated` where there is no goal."""
        if self.broken:
            return "broken off"
        if self.met < self.goals:
            return "short"
        return "met" if self.goals else "stated"


def tally(results: Sequence[ScenarioResult]) -> Tally:
    """Count over scenarios."""
    figures = [figure for result in results for figure in result.figures if figure.goal is not None]
    return Tally(
        len(figures), sum(bool(figure.met) for figure in figures), sum(len(result.broken) for result in results)
    )


def verdict(figure: Result) -> str:
    """`met`, `short`, `no value`, or nothing when there is no goal."""
    if figure.value is None:
        return "no value"
    return "" if figure.met is None else "met" if figure.met else "short"


def number(value: float | None) -> str:
    """A number as people read it: three significant digits, a dash for none."""
    if value is None:
        return "–"
    if value == 0.0 or 0.01 <= abs(value) < 1e5:
        digits = 0 if abs(value) >= 100 else 1 if abs(value) >= 10 else 2 if abs(value) >= 1 else 3
        text = f"{value:.{digits}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return text.replace("-", "−")
    return f"{value:.2e}".replace("-", "−")


def unit_text(unit: str) -> str:
    """A unit as people write it."""
    return {"deg el": "° el", "N m": "N·m"}.get(unit, unit)


def metrics(results: Mapping[str, ScenarioResult], settings: Settings) -> dict[str, Any]:
    """The content of `metrics.json`, results by scenario. It depends on nothing but the profile, seed and sources."""
    return {
        "profile": settings.profile.name,
        "seed": settings.seed,
        "revision": settings.revision,
        "scenarios": {identifier: _figures(result) for identifier, result in results.items()},
    }


def _lost(paper: Mapping[str, ScenarioResult]) -> dict[str, dict[str, str | None]]:
    """Runs that the paper's scheme lost, and why."""
    return {
        identifier: {outcome.run: outcome.broken for outcome in result.broken}
        for identifier, result in paper.items()
        if result.broken
    }


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def _figures(result: ScenarioResult) -> dict[str, object]:
    return {figure.name: figure.as_json() for figure in result.figures}


def write(
    directory: Path, results: Sequence[ScenarioResult], settings: Settings, paper: Mapping[str, ScenarioResult]
) -> None:
    """Write `metrics.json`, `report.html` and, where there is one, `paper.json` into a directory.

    Args:
        directory: existing.
        results: of the drive.
        settings: what all runs had in common.
        paper: results with the paper's scheme, by scenario; empty where it was not run.
    """
    if paper:
        _write_json(directory / PAPER, {**metrics(paper, settings), "lost": _lost(paper)})
    _write_json(directory / MARK, metrics({result.scenario.id: result for result in results}, settings))
    (directory / PAGE).write_text(html(results, settings, paper), encoding="utf-8")


def html(results: Sequence[ScenarioResult], settings: Settings, paper: Mapping[str, ScenarioResult]) -> str:
    """The page."""
    environment = Environment(
        loader=PackageLoader("stillspin", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(number=number, unit=unit_text, verdict=verdict, image=_image, slug=_slug)
    return environment.get_template("report.html.j2").render(
        results=results,
        paper=paper,
        scheme=scheme.paper(),
        columns=_columns(paper),
        tallies={result.scenario.id: tally([result]) for result in results},
        total=tally(results),
        lost=tally(list(paper.values())).broken,
        profile=settings.profile,
        seed=settings.seed,
        revision=settings.revision,
        changes=settings.changes.words,
        parameter_note=PARAMETER_NOTE,
        plant_rows=_plant_rows(settings.profile),
        runs_directory=RUNS,
    )


def _columns(paper: Mapping[str, ScenarioResult]) -> dict[str, dict[str, Result]]:
    """Scenario -> figure -> what the paper's scheme reaches."""
    return {identifier: {figure.name: figure for figure in result.figures} for identifier, result in paper.items()}


def _plant_rows(profile: Profile) -> list[tuple[str, str]]:
    rows = [(f"{section}.{key}", value) for section, keys in profile.plant.items() for key, value in keys.items()]
    rows += [(f"parameter {name}", value) for name, value in profile.parameters.items()]
    return [(name, str(value).lower() if isinstance(value, bool) else f"{value}") for name, value in rows]


def _image(svg: str) -> str:
    """A drawing as the source of an <img>: its ids and styles stay its own."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode("ascii")


def _slug(text: str) -> str:
    return text.replace(" ", "-")
