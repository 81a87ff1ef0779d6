"""What became of a case, by the true shaft: neither angle nor speed that the drive believes are asked."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from stillspin.campaign.draw import LOST
from stillspin.cases.scenario import Run
from stillspin.core import NativeResult, Signals
from stillspin.measure.metrics import position_error
from stillspin.measure.pieces import as_floats

CAUGHT = 0.020
"""Seconds within which the drive has to be off after the shaft went wrong."""
_START = 3  # signal `state` (firmware/interfaces/state.h)
_IN_WORDS = ("fault during the start: ", "the drive refused ")
"""How reasons begin that are the drive's own, before it ran."""


class End(StrEnum):
    """How a case ended; what each means stands in the book, docs/campaign.md."""

    GOOD = "good"
    REFUSED = "refused"
    FAILED = "failed"


@dataclass(frozen=True)
class Verdict:
    """What became of a case.

    Attributes:
        end: how it ended; words: why, in those of the drive where it has said something.
        wrong: s from the end of the start procedure until the true shaft went wrong, None where it did not.
        off: s from there until the drive was off, None where it was not, or nothing went wrong.
        error: largest difference (degrees electrical) of true angle and angle in use, None where it never ran.
    """

    end: End
    words: str = ""
    wrong: float | None = None
    off: float | None = None
    error: float | None = None

    @property
    def failed(self) -> bool:
        """The shaft went wrong, and the drive had not refused before."""
        return self.end is End.FAILED

    @property
    def caught(self) -> bool:
        """It failed, but the drive was off soon, and said why."""
        return self.failed and self.off is not None and self.off <= CAUGHT


def judged(result: NativeResult, run: Run, mean: float = 0.0) -> Verdict:
    """What became of a run; the drive's fault ends it, so what the shaft did afterwards is not judged.

    Args:
        result: of the run.
        run: what was asked for.
        mean: s that the true speed is averaged over; 0 for not.
    """
    fault = result.faults[0] if result.faults else None
    if result.reason.startswith(_IN_WORDS):
        return Verdict(End.REFUSED, result.reason.removeprefix(_IN_WORDS[0]))
    signals = dict(result.signals)
    if not np.asarray(signals["time"]).size:
        return Verdict(End.FAILED, result.reason or "nothing was recorded")
    signals = _whole(signals, fault[0] if fault else np.inf)
    error = _error(signals)
    wrong = _first_wrong(_averaged(signals, mean), run)
    if wrong:
        off = round(fault[0] - wrong[0], 4) if fault else None
        return Verdict(End.FAILED, f"{wrong[1]}; {fault[1] if fault else 'the drive ran on'}", wrong[0], off, error)
    if fault:
        return Verdict(End.REFUSED, fault[1], error=error)
    if not result.completed:
        return Verdict(End.FAILED, result.reason or "broken off without a reason", error=error)
    return Verdict(End.GOOD, error=error)


def _averaged(signals: Signals, seconds: float) -> Signals:
    """With the mean of the true speed over so long, up to each instant; less long at the beginning."""
    time, speed = as_floats(signals["time"]), as_floats(signals["true_speed"])
    if seconds <= 0.0 or time.size < 2:
        return signals
    sums = np.concatenate(([0.0], np.cumsum(speed)))
    first = np.searchsorted(time, time - seconds + 0.5 * (time[1] - time[0]))
    count = np.arange(1, time.size + 1) - first
    return {**signals, "true_speed": (sums[1:] - sums[first]) / count}


def _whole(signals: Signals, end: float) -> Signals:
    """Records before `end`, without a last one that the drive had no time to finish: it has no angle in use."""
    time, used = as_floats(signals["time"]), as_floats(signals["est_angle"])
    keep = time < end
    kept = np.flatnonzero(keep)
    if kept.size and np.isnan(used[kept[-1]]):
        keep[kept[-1]] = False
    return {name: np.asarray(data)[keep] for name, data in signals.items()}


def _error(signals: Signals) -> float | None:
    off = np.abs(position_error(signals))
    known = off[np.isfinite(off)]
    return round(float(np.max(known)), 3) if known.size else None


def _first_wrong(signals: Signals, run: Run) -> tuple[float, str] | None:
    """When the true shaft first was where it must not be, and how."""
    found = [at for at in (_lost(signals), *(_out_of_band(signals, run, k) for k in range(len(run.reached)))) if at]
    return min(found, default=None)


def _lost(signals: Signals) -> tuple[float, str] | None:
    off = np.abs(position_error(signals))
    # A drive that says that a vector turns the rotor says that it knows no angle.
    turned = np.isnan(off) & (as_floats(signals["state"]) == _START)
    # Written so that an angle that is not a number counts as lost.
    first = _first(~((off <= LOST) | turned))
    if first is None:
        return None
    if not np.isfinite(off[first]):
        return _at(signals, first), "the drive had no angle"
    return _at(signals, first), f"the rotor was {off[first]:.0f}° el. from where the drive took it to be"


def _out_of_band(signals: Signals, run: Run, number: int) -> tuple[float, str] | None:
    check = run.reached[number]
    time, speed = (as_floats(signals[name]) for name in ("time", "true_speed"))
    wanted = run.speed_command(time) if check.speed is None else np.full(time.shape, check.speed)
    inside = (time >= check.window[0]) & (time <= check.window[1])
    first = _first(inside & ~(np.abs(speed - wanted) <= check.band))
    if first is None:
        return None
    return _at(signals, first), f"the shaft turned at {speed[first]:.0f} rpm instead of {wanted[first]:.0f}"


def _first(where: npt.NDArray[np.bool_]) -> int | None:
    return int(np.argmax(where)) if bool(np.any(where)) else None


def _at(signals: Signals, record: int) -> float:
    return round(float(signals["time"][record]), 4)
