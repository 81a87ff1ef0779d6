"""What a type test found of a motor: the values of its commissioning against the true machine, and its duties."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from stillspin import core
from stillspin.campaign.draw import Unit
from stillspin.campaign.judge import End
from stillspin.cases.scenario import Run, Scenario
from stillspin.counted import counted
from stillspin.runs import execute
from stillspin.runs.commission import Result
from stillspin.type_test.carry_out import Row
from stillspin.type_test.duties import DUTIES

_TRUE = (
    ("inductance_d", "inductance_d", 1e3),
    ("inductance_q", "inductance_q", 1e3),
    ("magnet_flux", "magnet_flux", 1.0),
    ("inertia", "inertia", 1.0),
)
"""The drive's parameter, what it is of the true machine, and so many of its units to one of that."""


@dataclass(frozen=True)
class Kind:
    """Duties of one kind by how they ended.

    Attributes:
        load: the least share of the rated torque that came, None for none.
        error: degrees electrical, the largest between the true angle and the one in use, of those that ended well.
        first: of the first that did not, which it was and why.
    """

    of: str
    runs: int
    good: int
    refused: int
    failed: int
    load: float | None
    error: float | None
    first: str

    def words(self) -> str:
        """In short: the largest error where all is well."""
        under = f" under {self.load:.0%}" if self.load is not None and self.load < 1.0 else ""
        if self.failed:
            return f"{self.failed} of {self.runs} failed{under}"
        if self.refused:
            return f"{self.refused} of {self.runs} refused{under}"
        return "" if self.error is None else f"{self.error:.2g}°{under}"


@dataclass(frozen=True)
class Finding:
    """What was found of a motor.

    Attributes:
        values: how many values the commissioning found, and how many of them the drive believes; None for none.
        errors: of a value against the true machine, as a share, by the drive's parameter.
        seconds: that the commissioning took.
        refusal: why none of its duties was run; empty where they were.
    """

    motor: str
    values: tuple[int, int] | None
    errors: dict[str, float]
    seconds: float | None
    refusal: str
    kinds: tuple[Kind, ...]

    @property
    def failed(self) -> int:
        """Duties in which the shaft went wrong and the drive had not refused before."""
        return sum(kind.failed for kind in self.kinds)

    def rows(self) -> Iterator[tuple[str, ...]]:
        """For a table: what the commissioning found, then a row for each kind of duty."""
        if self.values:
            errors = ", ".join(f"{name} {share:+.1%}" for name, share in self.errors.items())
            found, believed = self.values
            yield self.motor, "commissioning", *[""] * 5, f"{counted(believed, 'value', found)}: {errors}"
        for kind in self.kinds:
            error = "" if kind.error is None else f"{kind.error:.2g}°"
            load = "" if kind.load is None else f"{kind.load:.0%}"
            yield self.motor, kind.of, str(kind.runs), str(kind.failed), str(kind.refused), load, error, kind.first

    def published(self) -> dict[str, Any]:
        """As the file of the results has it."""
        return {
            "values": self.values[0] if self.values else None,
            "believed": self.values[1] if self.values else None,
            "errors": self.errors,
            "seconds": self.seconds,
            "refusal": self.refusal,
            "duties": {
                kind.of: {
                    "runs": kind.runs,
                    "good": kind.good,
                    "refused": kind.refused,
                    "failed": kind.failed,
                    "load": kind.load,
                    "angle_error_deg": kind.error,
                    "first": kind.first,
                    "words": kind.words(),
                }
                for kind in self.kinds
            },
        }


def of(unit: Unit, result: Result | None, rows: Sequence[Row]) -> Finding:
    """What was found of a motor. rows: its own."""
    named: dict[str, list[Row]] = {}
    for row in sorted(rows, key=lambda row: DUTIES.index(row.duty.kind)):
        named.setdefault(_column(row), []).append(row)
    return Finding(
        unit.motor,
        (len(result.values), len(result.told)) if result else None,
        _errors(unit, result) if result else {},
        result.duration if result else None,
        unit.refusal,
        tuple(kind_of(name, group) for name, group in named.items()),
    )


def _column(row: Row) -> str:
    """Loads and slow speeds by themselves; all starts together, and all that turn before."""
    return f"{row.duty.kind} {row.duty.of}" if row.duty.kind in ("slow", "load") else row.duty.kind


def kind_of(name: str, rows: Sequence[Row]) -> Kind:
    """What became of duties of one kind."""
    ends = [row.verdict.end for row in rows]
    bad = [row for row in rows if row.verdict.end is not End.GOOD]
    bad.sort(key=lambda row: row.verdict.end is not End.FAILED)
    errors = [row.verdict.error for row in rows if row.verdict.end is End.GOOD and row.verdict.error is not None]
    return Kind(
        name,
        len(rows),
        ends.count(End.GOOD),
        ends.count(End.REFUSED),
        ends.count(End.FAILED),
        min((row.duty.load for row in rows if row.duty.load is not None), default=None),
        max(errors, default=None),
        _first(name, bad[0]) if bad else "",
    )


def _first(name: str, row: Row) -> str:
    """Which it was, where the name does not say it, and why."""
    return row.verdict.words if name.endswith(row.duty.of) else f"{row.duty.of}: {row.verdict.words}"


def _errors(unit: Unit, result: Result) -> dict[str, float]:
    scenario = Scenario("type-test", "", unit.settings.profile.motor, "", "", "", (_NOTHING,), (), ())
    (job,) = execute.prepare(scenario, unit.settings, core.load())
    machine = job.about["machine"]
    winding = float(job.plant["machine"]["resistance"])  # without the devices', which the drive has by themselves
    true = {
        "stator_resistance": winding * (1.0 + float(job.plant.get("parameter_error", {}).get("resistance", 0.0))),
        **{name: machine[key] * factor for name, key, factor in _TRUE},
    }
    told = result.told
    return {name: round(told[name] / value - 1.0, 5) for name, value in true.items() if name in told and value}


_NOTHING = Run("values", "", 0.0, 0.0, (), (), {}, {}, ())
