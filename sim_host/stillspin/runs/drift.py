"""What has changed since the drive was commissioned, as variants of a campaign (`schemes/drift.toml`).

Each drift multiplies some of what the plant really is; the drive keeps its parameters. The scenarios are the same, and
their goals as many times as large as the list says.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from stillspin import core, resources, toml_table
from stillspin.cases import factors
from stillspin.cases.profile import merged
from stillspin.cases.scenario import Goal, Scenario
from stillspin.runs.execute import Settings
from stillspin.runs.variant import Variant


@dataclass(frozen=True)
class Drift(Variant):
    """One thing that has changed.

    Attributes:
        factors: of entries of the plant, by section; goals: what the goals are multiplied by.
        schema: of the plant.
    """

    factors: factors.Factors
    goals: float
    schema: core.Schema

    def applies(self, scenario: Scenario) -> bool:
        """Everywhere: the list says which scenarios are run."""
        return True

    def scenario(self, scenario: Scenario) -> Scenario:
        """The same with larger goals, not drawn."""
        figures = tuple(replace(figure, goal=_times(figure.goal, self.goals)) for figure in scenario.figures)
        return replace(scenario, id=f"{scenario.id}-{self.mark}", figures=figures, plots=())

    def settings(self, settings: Settings) -> Settings:
        """The same on the plant that has changed."""
        plant = merged(settings.profile.plant, settings.changes.plant)
        changed = merged(settings.profile.plant, self.plant(plant))
        changes = replace(settings.changes, words=[*settings.changes.words, self.title], plant={})
        return replace(settings, profile=replace(settings.profile, plant=changed), changes=changes)

    def plant(self, plant: core.Plant) -> core.Plant:
        """The plant with what differs."""
        return factors.multiplied(plant, self.factors, self.schema, self.title)


def _times(goal: Goal, factor: float) -> Goal:
    default = None if goal.default is None else goal.default * factor
    return Goal(default, {name: value * factor for name, value in goal.profiles.items()})


def load(schema: core.Schema) -> tuple[list[str], list[Drift]]:
    """The ids of the scenarios to run, and the drifts.

    Raises:
        InputError: the list is wrong.
    """
    table = toml_table.read(resources.directory("schemes") / "drift.toml")
    scenarios = table.texts("scenarios")
    goals = table.number("goal_factor", minimum=1.0)
    drifts = [_drift(row, goals, schema) for row in table.tables("drifts")]
    table.finish()
    return scenarios, drifts


def _drift(table: toml_table.Table, goals: float, schema: core.Schema) -> Drift:
    title, mark = table.text("title"), table.text("mark")
    found = factors.read(table.table("factor").items(), schema, table.where)
    table.finish()
    words = f"The same drive, commissioned before: {title}."
    return Drift(mark, title, words, found, goals, schema)
