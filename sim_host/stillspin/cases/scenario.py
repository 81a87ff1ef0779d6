"""Scenarios (`scenarios/*.toml`): what is run, what is measured on it, and what the paper and the project expect.

Times are seconds from the end of the start procedure. The file format is described in docs and by the files themselves;
`scenario_file.py` reads and checks it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from stillspin.core import Command, LoadPoint, Look, Plant

Window = tuple[float, float]

COMMANDS = ("speed_ref_rpm", "start", "stop", "coast", "reset")
"""What a run may command; `set:` before the name of a parameter is another."""
RATIO = "ratio"
"""Kind of a figure that is made of two others."""


@dataclass(frozen=True)
class Reached:
    """The true shaft must be within `band` (rpm) of `speed` (rpm; None: of the command) all through the window (s)."""

    window: Window
    band: float
    speed: float | None = None


@dataclass(frozen=True)
class Run:
    """One run of the virtual drive.

    Attributes:
        duration: s after the start procedure; max_start: longest start procedure (s).
        commands: (s, what, value), sorted; load: corners (s, N m) of the load torque.
        parameters: firmware parameters that this run sets, only what the scenario compares; words are choices.
        plant: entries of the plant that this run needs, such as a locked shaft.
        factors: what entries of the plant are multiplied by, whatever the profile says of them.
        record_every: PWM periods per record.
        waveform: the stretch that is looked into, None for none.
        may_be_lost: what it shows includes that the shaft is lost; that does not count as broken off.
    """

    name: str
    title: str
    duration: float
    max_start: float
    commands: tuple[Command, ...]
    load: tuple[LoadPoint, ...]
    parameters: dict[str, float | str]
    plant: Plant
    reached: tuple[Reached, ...]
    record_every: int = 1
    waveform: Look | None = None
    may_be_lost: bool = False
    factors: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def speed_command(self, time: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """The commanded speed (rpm) at each time (s): the last command given, 0 before the first."""
        given = [(at, value) for at, what, value in self.commands if what == "speed_ref_rpm"]
        at = np.array([-np.inf, *(row[0] for row in given)])
        value = np.array([0.0, *(row[1] for row in given)])
        last: npt.NDArray[np.float64] = value[np.searchsorted(at, time, side="right") - 1]
        return last


@dataclass(frozen=True)
class Goal:
    """The number that |value| must not exceed, per profile; `default` holds where the profile has none of its own."""

    default: float | None = None
    profiles: dict[str, float] = field(default_factory=dict)

    def of(self, profile: str) -> float | None:
        """The goal in a profile, None where there is none."""
        return self.profiles.get(profile, self.default)


@dataclass(frozen=True)
class Figure:
    """A figure of merit: the largest of `kind` over its runs and windows; or the ratio of two other figures."""

    name: str
    kind: str
    unit: str
    runs: tuple[str, ...]
    windows: tuple[Window, ...]
    paper: float | None
    goal: Goal
    of: tuple[str, str] | None = None
    note: str = ""


@dataclass(frozen=True)
class Plot:
    """A drawing: stacked panels over time, one colour per signal, or per run when it shows several runs."""

    title: str
    panels: tuple[str, ...]
    runs: tuple[str, ...]
    window: Window | None


@dataclass(frozen=True)
class Scenario:
    """A figure of the paper as an experiment on the virtual drive, or one of our own.

    `on_demand`: it takes long, and runs only where it is named.
    """

    id: str
    title: str
    motor: str
    description: str
    paper_figure: str
    paper_says: str
    runs: tuple[Run, ...]
    figures: tuple[Figure, ...]
    plots: tuple[Plot, ...]
    on_demand: bool = False

    def run(self, name: str) -> Run:
        """The run of that name."""
        return next(run for run in self.runs if run.name == name)
