"""What came of `stillspin explain`: numbers by figure and effect, the dominating one, a picture with bars."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stillspin.cases.effects import ALONE, WITHOUT, Effect
from stillspin.cases.scenario import Scenario
from stillspin.extras import need
from stillspin.measure.figures import Result
from stillspin.report import output
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.execute import Settings

PICTURE = "explain.svg"

NOTICEABLE = 0.1
"""Share of a figure that must go with an effect before it is said to dominate: runs differ by the noise's course."""


@dataclass(frozen=True)
class Explanation:
    """All values.

    Attributes:
        scenario: what was run; effects: that the profile has.
        results: by the mark of the case; alone: whether each was run alone on `ideal`.
    """

    scenario: Scenario
    effects: Sequence[Effect]
    results: Mapping[str, ScenarioResult]
    alone: bool

    @property
    def figures(self) -> list[Result]:
        """The figures with everything in place."""
        return self.results[f"{WITHOUT}-nothing"].figures

    def value(self, kind: str, effect: Effect | None, name: str) -> float | None:
        """A figure of a case; None where there is none, or the case was not run."""
        result = self.results.get(f"{kind}-{effect.mark if effect else 'nothing'}")
        figures = result.figures if result else []
        return next((figure.value for figure in figures if figure.name == name), None)

    def dominating(self, figure: Result) -> Effect | None:
        """The effect without which the figure is smallest, if it is noticeably smaller; none of a figure that is 0."""
        if not figure.value:
            return None
        left = {effect.mark: self.value(WITHOUT, effect, figure.name) for effect in self.effects}
        known = [effect for effect in self.effects if left[effect.mark] is not None]
        best = min(known, key=lambda effect: abs(left[effect.mark] or 0.0), default=None)
        if best is None or abs(left[best.mark] or 0.0) > (1.0 - NOTICEABLE) * abs(figure.value):
            return None
        return best

    @property
    def broken(self) -> dict[str, str]:
        """Runs that broke off: case and run, and why."""
        return {
            f"{mark}, {outcome.run}": outcome.broken or ""
            for mark, result in self.results.items()
            for outcome in result.broken
        }


def content(found: Explanation, settings: Settings) -> dict[str, Any]:
    """The content of `metrics.json`."""
    return {
        "profile": settings.profile.name,
        "seed": settings.seed,
        "revision": settings.revision,
        "firmware": settings.firmware,
        "scenario": found.scenario.id,
        "effects": {effect.mark: effect.title for effect in found.effects},
        "figures": {figure.name: _figure(found, figure) for figure in found.figures},
        "broken": found.broken,
    }


def _figure(found: Explanation, figure: Result) -> dict[str, object]:
    best = found.dominating(figure)
    row: dict[str, object] = {
        **figure.as_json(),
        "dominating": best.mark if best else None,
        "without": {effect.mark: found.value(WITHOUT, effect, figure.name) for effect in found.effects},
    }
    if found.alone:
        row["ideal"] = found.value(ALONE, None, figure.name)
        row["alone"] = {
            effect.mark: found.value(ALONE, effect, figure.name) for effect in found.effects if not effect.exact
        }
    return row


def write(directory: Path, found: Explanation, settings: Settings) -> None:
    """Write `metrics.json` and the picture into an existing directory."""
    text = json.dumps(content(found, settings), indent=2, ensure_ascii=False, allow_nan=False)
    (directory / output.MARK).write_text(text + "\n", encoding="utf-8")
    (directory / PICTURE).write_text(_drawn(found), encoding="utf-8")


def _drawn(found: Explanation) -> str:
    need("matplotlib")
    from stillspin.report import explain_plot  # noqa: PLC0415 - matplotlib takes a second to load, and not all need it

    return explain_plot.draw(found)
