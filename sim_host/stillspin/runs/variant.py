"""Other ways to run the scenarios, shown beside the drive's own results on the same plant with the same noise.

One is the drive on the parameters of the nameplate, where its own results are on commissioned ones. The others are
other people's ways to find the position (`schemes/*.toml`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from stillspin import core, resources, toml_table
from stillspin.cases.profile import Profile
from stillspin.cases.scenario import Plot, Scenario
from stillspin.entry import Entry
from stillspin.errors import InputError
from stillspin.image.run_record import RASTER
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.execute import Settings


@dataclass(frozen=True)
class Variant(ABC):
    """A way to run scenarios.

    Attributes:
        mark: a word for file names; title: in a word or two; description: what differs and what does not.
    """

    mark: str
    title: str
    description: str

    @abstractmethod
    def applies(self, scenario: Scenario) -> bool:
        """Whether it makes a difference to the scenario that is worth a look."""

    @abstractmethod
    def scenario(self, scenario: Scenario) -> Scenario:
        """The scenario in this way, under an id of its own."""

    def settings(self, settings: Settings) -> Settings:
        """What its runs have in common."""
        return settings


@dataclass(frozen=True)
class Beside:
    """A variant and what came of it, by the id of the scenario that it varies."""

    variant: Variant
    results: dict[str, ScenarioResult]


@dataclass(frozen=True)
class Nameplate(Variant):
    """The drive on the parameters of motor and profile alone: those of the nameplate and the board.

    `profiles`: by motor.
    """

    profiles: Mapping[str, Profile]

    def applies(self, scenario: Scenario) -> bool:
        """Everywhere."""
        return True

    def scenario(self, scenario: Scenario) -> Scenario:
        """The same, not drawn."""
        return replace(scenario, id=f"{scenario.id}-{self.mark}", plots=())

    def settings(self, settings: Settings) -> Settings:
        """The same with the profile's own parameters."""
        own = self.profiles[settings.profile.motor]
        return replace(settings, profile=own, parameters_from="the nameplate")


def nameplate(profiles: Mapping[str, Profile]) -> Nameplate:
    """The drive as it is before commissioning, by motor."""
    words = "The same drive before commissioning, on what the nameplates of machine and inverter say."
    return Nameplate("nameplate", "nameplate", words, profiles)


@dataclass(frozen=True)
class Scheme(Variant):
    """Firmware parameters that make the drive find the position in another way.

    Attributes:
        motor: for which it is meant.
        parameters: numbers or names of choices.
    """

    motor: str
    parameters: dict[str, float | str]

    def applies(self, scenario: Scenario) -> bool:
        """Whether it shows a paper's figure or is about the position error, and leaves source and layout open."""
        judged = any(figure.kind.startswith("position_error") for figure in scenario.figures)
        judged = judged or bool(scenario.paper_figure)
        own = any({"position_source", "excitation"} & run.parameters.keys() for run in scenario.runs)
        return judged and not own and scenario.motor == self.motor

    def scenario(self, scenario: Scenario) -> Scenario:
        """The scenario with this scheme."""
        runs = tuple(replace(run, parameters={**run.parameters, **self.parameters}) for run in scenario.runs)
        # The scenario's own plots say which runs go together.
        views = dict.fromkeys((plot.runs, plot.window) for plot in scenario.plots)
        title = f"The same with the {self.title}"
        plots = tuple(Plot(title, ("speed", "position_error"), names, window) for names, window in views)
        return replace(scenario, id=f"{scenario.id}-{self.mark}", runs=runs, plots=plots)

    def told(self, profile: Profile, known: Mapping[str, Entry]) -> Profile:
        """A profile whose drive has these parameters: the whole run, not a variant beside another.

        Raises:
            InputError: it is of another motor, or has a parameter or value that the drive has not.
        """
        if profile.motor != self.motor:
            raise InputError(f"--scheme {self.mark}: is of motor {self.motor}, and this is motor {profile.motor}")
        return replace(profile, parameters={**profile.parameters, **self.checked(known, profile.parameters)})

    def checked(self, known: Mapping[str, Entry], told: Mapping[str, float] | None = None) -> dict[str, float]:
        """Its parameters as numbers, for a drive that is told others before.

        Raises:
            InputError: the drive has no such parameter or value.
        """
        where = f"scheme {self.mark}"
        known = core.at_scale(known, told or {})
        return {name: core.parameter(known, name, value, f"{where}: {name}") for name, value in self.parameters.items()}


@dataclass(frozen=True)
class Native(Variant):
    """The firmware that is compiled for this computer, beside an image; recorded as rarely as that is."""

    def applies(self, scenario: Scenario) -> bool:
        """Everywhere."""
        return True

    def scenario(self, scenario: Scenario) -> Scenario:
        """The same, not drawn."""
        runs = tuple(replace(run, record_every=RASTER) for run in scenario.runs)
        return replace(scenario, id=f"{scenario.id}-{self.mark}", runs=runs, plots=())

    def settings(self, settings: Settings) -> Settings:
        """Without the image."""
        return replace(settings, image=None)


def native() -> Native:
    """The native run of the same steps."""
    words = (
        "The same C files compiled for this computer, on the same plant with the same noise. Its interrupts take the "
        "time that they say, the image's that of its instructions."
    )
    return Native("native", "native", words)


def scheme(name_or_path: str) -> Scheme:
    """A scheme that ships, or the one in a file.

    Raises:
        InputError: there is none, or its file is wrong.
    """
    path = resources.find("schemes", name_or_path)
    table = toml_table.read(path)
    values = table.table("parameters").items()
    description = table.text("description").strip()
    found = Scheme(path.stem, table.text("title"), description, table.text("motor"), values)
    table.finish()
    return found


def paper() -> Scheme:
    """The scheme of the paper."""
    return scheme("paper")


def separate(
    results: Sequence[ScenarioResult], variants: Sequence[Variant]
) -> tuple[list[ScenarioResult], list[Beside]]:
    """The drive's own results, and those of each variant."""

    def of(variant: Variant) -> dict[str, ScenarioResult]:
        end = f"-{variant.mark}"
        return {r.scenario.id.removesuffix(end): r for r in results if r.scenario.id.endswith(end)}

    beside = [Beside(variant, of(variant)) for variant in variants]
    varied = {result.scenario.id for item in beside for result in item.results.values()}
    return [result for result in results if result.scenario.id not in varied], beside
