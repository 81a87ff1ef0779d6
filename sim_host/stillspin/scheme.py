"""Other people's ways to find the position, run beside the drive's own on the same scenarios (`schemes/*.toml`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from stillspin import resources, toml_table
from stillspin.assess import ScenarioResult
from stillspin.scenario import Plot, Scenario

_MARK = "-paper"


@dataclass(frozen=True)
class Scheme:
    """Firmware parameters that make the drive work in another way.

    Attributes:
        title: in a word or two; description: what differs and what does not.
        motor: for which it is meant.
        parameters: numbers or names of choices.
    """

    title: str
    description: str
    motor: str
    parameters: dict[str, float | str]

    def applies(self, scenario: Scenario) -> bool:
        """Whether the scenario is about the position error and leaves the position source open."""
        judged = any(figure.kind.startswith("position_error") for figure in scenario.figures)
        own = any("position_source" in run.parameters for run in scenario.runs)
        return judged and not own and scenario.motor == self.motor

    def variant(self, scenario: Scenario) -> Scenario:
        """The scenario with this scheme, under an id of its own."""
        runs = tuple(replace(run, parameters={**run.parameters, **self.parameters}) for run in scenario.runs)
        # The scenario's own plots say which runs go together.
        views = dict.fromkeys((plot.runs, plot.window) for plot in scenario.plots)
        title = f"The same with the {self.title}"
        plots = tuple(Plot(title, ("speed", "position_error"), names, window) for names, window in views)
        return replace(scenario, id=scenario.id + _MARK, runs=runs, plots=plots)


def paper() -> Scheme:
    """The scheme of the paper."""
    table = toml_table.read(resources.directory("schemes") / "paper.toml")
    values = table.table("parameters").items()
    scheme = Scheme(table.text("title"), table.text("description").strip(), table.text("motor"), values)
    table.finish()
    return scheme


def separate(results: Sequence[ScenarioResult]) -> tuple[list[ScenarioResult], dict[str, ScenarioResult]]:
    """The drive's own results, and those of the variants by the id of the scenario that they vary."""
    own = [result for result in results if not result.scenario.id.endswith(_MARK)]
    other = {result.scenario.id.removesuffix(_MARK): result for result in results if result.scenario.id.endswith(_MARK)}
    return own, other
