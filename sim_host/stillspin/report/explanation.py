"""What `stillspin explain` has found: figures by case, and which effect makes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from stillspin.cases.scenario import Scenario
from stillspin.measure.figures import Result
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.effects import WITHOUT, Effect

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
