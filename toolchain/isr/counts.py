"""Counts of runs: cost by step, by function, of all periods and of the longest one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

PHASES = ("resting", "starting", "turning", "commissioning")
STEPS = ("samples", "estimate", "supervise", "control", "modulate", "hand_over", "link", "windows")
ALL, WINDOW = "all", "window"


@dataclass(frozen=True)
class Cost:
    """Of one step in one phase: periods (of a window's: windows), sums, and the worst of one."""

    count: int = 0
    instructions: int = 0
    worst_instructions: int = 0
    cycles: float = 0.0
    worst_cycles: float = 0.0

    @property
    def mean_cycles(self) -> float:
        """Of a period."""
        return self.cycles / self.count if self.count else 0.0

    def with_(self, other: Cost) -> Cost:
        """Both together: sums, and the worse of both."""
        return Cost(
            self.count + other.count,
            self.instructions + other.instructions,
            max(self.worst_instructions, other.worst_instructions),
            self.cycles + other.cycles,
            max(self.worst_cycles, other.worst_cycles),
        )


@dataclass
class Counts:
    """Of one run or of several.

    Attributes:
        costs: by phase and step.
        ran: by phase, how many instructions of each function (its place in the list of the program) ran in all periods.
        longest: the same of the phase's longest period.
    """

    costs: dict[tuple[str, str], Cost] = field(default_factory=dict)
    ran: dict[str, dict[int, int]] = field(default_factory=dict)
    longest: dict[str, dict[int, int]] = field(default_factory=dict)

    def of(self, step: str, phases: Iterable[str] = PHASES) -> Cost:
        """A step, over phases."""
        total = Cost()
        for phase in phases:
            total = total.with_(self.costs.get((phase, step), Cost()))
        return total

    @property
    def worst(self) -> float:
        """Cycles of the longest period."""
        return self.of(ALL).worst_cycles

    def longest_period(self) -> tuple[str, dict[int, int]]:
        """Phase and functions of the longest period."""
        phase = max(PHASES, key=lambda name: self.of(ALL, (name,)).worst_cycles)
        return phase, self.longest.get(phase, {})


def read(file: Path) -> Counts:
    """What the plugin wrote (tests/m3/count.c)."""
    counts = Counts()
    for line in file.read_text(encoding="utf-8").splitlines():
        kind, phase, *words = line.split()
        if kind == "cost":
            count, instructions, worst = map(int, words[1:4])
            counts.costs[phase, words[0]] = Cost(count, instructions, worst, float(words[4]), float(words[5]))
        else:
            function, instructions, worst = map(int, words)
            counts.ran.setdefault(phase, {})[function] = instructions
            counts.longest.setdefault(phase, {})[function] = worst
    return counts


def joined(runs: Iterable[Counts]) -> Counts:
    """All runs as one: sums over all, and the longest period of all."""
    total = Counts()
    for counts in runs:
        for phase in PHASES:
            if counts.of(ALL, (phase,)).worst_cycles > total.of(ALL, (phase,)).worst_cycles:
                total.longest[phase] = counts.longest[phase]
            for function, instructions in counts.ran.get(phase, {}).items():
                own = total.ran.setdefault(phase, {})
                own[function] = own.get(function, 0) + instructions
        for key, cost in counts.costs.items():
            total.costs[key] = total.costs.get(key, Cost()).with_(cost)
    return total
