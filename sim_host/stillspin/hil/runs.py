"""What a board can be stepped through: the runs of scenarios, and the commissioning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from stillspin import resources
from stillspin.cases import scenario_file
from stillspin.core import NativeCore, Progress
from stillspin.core_loop import NativeStepLoop
from stillspin.hil.loop import Play
from stillspin.runs import commission, execute
from stillspin.runs.execute import Job, Settings

ALL = "all"
COMMISSION = "commission"
CHECK = 0.2
"""Seconds of a run behind its start procedure that are enough for a look."""
_CHECK_COMMISSION = 0.4  # s from power-on


@dataclass(frozen=True)
class LoopRun:
    """One run of a scenario, or the commissioning, whose `scenario` is called so.

    Attributes:
        profile: of the plant.
        whole: to its end, not its start alone.
        length: s of the drive's time, some of it.
    """

    scenario: str
    name: str
    play: Play
    profile: str
    whole: bool
    length: float


SettingsOf = Callable[[str], Settings]
"""What all runs with one motor have in common."""


def ids(wanted: Sequence[str]) -> list[str]:
    """What is meant, by its names.

    Args:
        wanted: scenarios; `commission`; `all` is the commissioning and every scenario, also those on demand.

    Raises:
        InputError: there is no such scenario.
    """
    names = [COMMISSION, *scenario_file.ids()] if ALL in wanted else list(wanted)
    for name in names:
        if name != COMMISSION:
            scenario_file.find(name)
    return names


def named(wanted: Sequence[str], settings: SettingsOf, native: NativeCore, *, check: bool) -> list[LoopRun]:
    """The runs that are meant.

    Args:
        wanted: see `ids`.
        settings: of a motor.
        native: the native module.
        check: only the beginning of each.

    Raises:
        InputError: there is no such scenario, or it asks for what does not exist.
    """
    return [run for name in ids(wanted) for run in _runs(name, settings, native, check=check)]


def broad(chosen: Sequence[LoopRun]) -> list[int]:
    """Numbers of the runs in another order: of every scenario the shortest, then of every one the next; short first.

    A defect shows early, and what has been compared when it is broken off is something of everything.
    """
    by_length: dict[str, list[int]] = {}
    for number, run in sorted(enumerate(chosen), key=lambda item: item[1].length):
        by_length.setdefault(run.scenario, []).append(number)
    rank = {number: place for numbers in by_length.values() for place, number in enumerate(numbers)}
    return sorted(rank, key=lambda number: (rank[number], chosen[number].length))


def _runs(name: str, settings: SettingsOf, native: NativeCore, *, check: bool) -> list[LoopRun]:
    if name == COMMISSION:
        chosen = settings(resources.DEFAULT_MOTOR)
        play = _CommissioningPlay(chosen, check)
        length = _CHECK_COMMISSION if check else commission.LIMIT
        return [LoopRun(COMMISSION, "motor", play, chosen.profile.name, not check, length)]
    scenario = scenario_file.load(name)
    chosen = settings(scenario.motor)
    jobs = execute.prepare(scenario, chosen, native)
    profile = chosen.profile.name
    taken = [_shortened(job) if check else job for job in jobs]
    return [LoopRun(job.scenario, job.run.name, _JobPlay(job), profile, not check, job.run.duration) for job in taken]


def _shortened(job: Job) -> Job:
    return replace(job, run=replace(job.run, duration=min(job.run.duration, CHECK), waveform=None))


@dataclass(frozen=True)
class _JobPlay:
    """A run of a scenario; it can be sent to another process."""

    job: Job

    def __call__(self, native: NativeCore, progress: Progress, loop: NativeStepLoop) -> str:
        return execute.play(native, self.job, progress, loop).reason


@dataclass(frozen=True)
class _CommissioningPlay:
    """The commissioning; it can be sent to another process."""

    settings: Settings
    check: bool

    def __call__(self, native: NativeCore, progress: Progress, loop: NativeStepLoop) -> str:
        result = commission.play(
            native,
            self.settings.profile,
            self.settings.changes,
            self.settings.seed,
            lambda share, _phase: progress(share),
            recording=loop,
            limit=_CHECK_COMMISSION if self.check else commission.LIMIT,
        )
        return "" if self.check else result.reason
