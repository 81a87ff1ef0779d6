"""Results for people (`report.html`, one file with everything in it) and for programs (`metrics.json`)."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stillspin import extras
from stillspin.cases.profile import Profile
from stillspin.counted import counted
from stillspin.measure.figures import Result
from stillspin.report.output import MARK, RUNS
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.execute import Settings
from stillspin.runs.variant import Beside

PAGE = "report.html"


@dataclass(frozen=True)
class Tally:
    """How many goals there are, how many are met, and how many runs broke off."""

    goals: int
    met: int
    broken: int

    @property
    def verdict(self) -> str:
        """`broken off`, `missed`, `met`, or `stated` where there is no goal."""
        if self.broken:
            return "broken off"
        if self.met < self.goals:
            return "missed"
        return "met" if self.goals else "stated"


def tally(results: Sequence[ScenarioResult]) -> Tally:
    """Count over scenarios."""
    figures = [figure for result in results for figure in result.figures if figure.goal is not None]
    return Tally(
        len(figures), sum(bool(figure.met) for figure in figures), sum(len(result.broken) for result in results)
    )


def verdict(figure: Result) -> str:
    """`met`, `missed`, `no value`, or nothing when there is no goal."""
    if figure.goal is None:
        return ""
    if figure.value is None:
        return "no value"
    return "met" if figure.met else "missed"


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
        "firmware": settings.firmware,
        "scenarios": {identifier: _figures(result) for identifier, result in results.items()},
    }


def _lost(results: Mapping[str, ScenarioResult]) -> dict[str, dict[str, str | None]]:
    """Runs that were lost, and why."""
    return {
        identifier: {outcome.run: outcome.broken for outcome in result.lost}
        for identifier, result in results.items()
        if result.lost
    }


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    path.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def _figures(result: ScenarioResult) -> dict[str, object]:
    return {figure.name: figure.as_json() for figure in result.figures}


def write(
    directory: Path, results: Sequence[ScenarioResult], settings: Sequence[Settings], beside: Sequence[Beside]
) -> None:
    """Write `metrics.json`, `report.html` and a file like `metrics.json` for each variant into a directory.

    Args:
        directory: existing.
        results: of the drive.
        settings: what all runs of a motor had in common, for each motor.
        beside: what the variants reach.
    """
    for item in beside:
        content = {**metrics(item.results, item.variant.settings(settings[0])), "lost": _lost(item.results)}
        _write_json(directory / f"{item.variant.mark}.json", content)
    _write_json(directory / MARK, metrics({result.scenario.id: result for result in results}, settings[0]))
    (directory / PAGE).write_text(html(results, settings, beside), encoding="utf-8")


def html(results: Sequence[ScenarioResult], settings: Sequence[Settings], beside: Sequence[Beside]) -> str:
    """The page."""
    jinja = extras.need("jinja2")
    environment = jinja.Environment(
        loader=jinja.PackageLoader("stillspin.report", "templates"),
        autoescape=True,
        undefined=jinja.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        number=number, counted=counted, unit=unit_text, verdict=verdict, image=_image, slug=_slug
    )
    page: str = environment.get_template("report.html.j2").render(
        results=results,
        beside=[_Column(item) for item in beside],
        tallies={result.scenario.id: tally([result]) for result in results},
        total=tally(results),
        settings=settings[0],
        plants=[(each.profile.motor, _plant_rows(each.profile)) for each in settings],
        runs_directory=RUNS,
    )
    return page


class _Column:
    """A variant as the page shows it."""

    def __init__(self, item: Beside) -> None:
        self.variant = item.variant
        self.results = item.results
        self.total = tally(list(item.results.values()))
        self.lost = sum(len(result.lost) for result in item.results.values())

    def value(self, identifier: str, figure: Result) -> float | None:
        """What the variant reaches; None where it was lost."""
        return next(other.value for other in self.results[identifier].figures if other.name == figure.name)


def _plant_rows(profile: Profile) -> list[tuple[str, str]]:
    rows = [(f"{section}.{key}", value) for section, keys in profile.plant.items() for key, value in keys.items()]
    rows += [(f"parameter {name}", value) for name, value in profile.parameters.items()]
    return [(name, str(value).lower() if isinstance(value, bool) else f"{value}") for name, value in rows]


def _image(svg: str) -> str:
    """A drawing as the source of an <img>: its ids and styles stay its own."""
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode("ascii")


def _slug(text: str) -> str:
    return text.replace(" ", "-")
