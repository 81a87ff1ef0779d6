"""From the records of a scenario's runs to its figures of merit and drawings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from stillspin.cases.scenario import Plot, Scenario
from stillspin.core import Signals
from stillspin.measure import figures, pieces
from stillspin.runs import records
from stillspin.runs.execute import Outcome

Draw = Callable[[Plot, Scenario, Mapping[str, Signals], Mapping[str, pieces.Extras]], str]
"""Draws a plot of a scenario from its runs' signals, and what else is known of them, as SVG text."""


@dataclass(frozen=True)
class Drawing:
    """A plot of a scenario as SVG text."""

    title: str
    svg: str


@dataclass(frozen=True)
class ScenarioResult:
    """A scenario with how its runs ended, its figures of merit and its drawings."""

    scenario: Scenario
    outcomes: list[Outcome]
    figures: list[figures.Result]
    drawings: list[Drawing]

    @property
    def lost(self) -> list[Outcome]:
        """The runs that do not count."""
        return [outcome for outcome in self.outcomes if outcome.broken]

    @property
    def broken(self) -> list[Outcome]:
        """The same, but for those that the scenario allows to be lost."""
        return [outcome for outcome in self.lost if not self.scenario.run(outcome.run).may_be_lost]


def assess(
    scenario: Scenario, outcomes: Sequence[Outcome], directory: Path, profile: str, draw: Draw | None
) -> ScenarioResult:
    """Figures and drawings of a scenario. Runs that broke off are drawn as far as they got, but not measured.

    Args:
        scenario: what to measure.
        outcomes: of its runs, in their order.
        directory: where the records are.
        profile: name, for the goals.
        draw: what draws, None for no drawings.
    """
    read = {outcome.run: records.read(directory / outcome.file) for outcome in outcomes if outcome.file}
    recorded = {name: record.signals for name, record in read.items()}
    looked = {
        outcome.run: records.read_waveform(directory / outcome.waveform) for outcome in outcomes if outcome.waveform
    }
    extras = {
        name: pieces.Extras(looked.get(name, {}), record.about.get("machine", {}), record.about.get("observer", {}))
        for name, record in read.items()
    }
    counting = {outcome.run: recorded[outcome.run] for outcome in outcomes if outcome.file and not outcome.broken}
    lost = {name: signals for name, signals in recorded.items() if name not in counting}
    measured = figures.evaluate(scenario, counting, profile, extras, lost)
    plots = scenario.plots if draw and recorded else ()
    drawings = [Drawing(plot.title, draw(plot, scenario, recorded, extras)) for plot in plots if draw]
    return ScenarioResult(scenario, list(outcomes), measured, drawings)
