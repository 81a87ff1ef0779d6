"""What became of all cases, in numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from stillspin import wilson
from stillspin.campaign.judge import CAUGHT, End
from stillspin.campaign.results import Row
from stillspin.counted import counted


@dataclass(frozen=True)
class Tally:
    """Cases by how they ended. caught: of the failed ones, those that the drive ended soon and in words."""

    good: int = 0
    refused: int = 0
    failed: int = 0
    caught: int = 0

    @property
    def cases(self) -> int:
        """All of them."""
        return self.good + self.refused + self.failed

    @property
    def run(self) -> int:
        """Those for which the drive had said that it would work."""
        return self.good + self.failed

    @property
    def refused_share(self) -> float:
        """In percent of all."""
        return 100.0 * self.refused / self.cases if self.cases else 0.0

    def words(self, refusal: str = "refused") -> str:
        """For people. refusal: what it is called when the drive ends a case in words before anything is wrong."""
        failed = f"{counted(self.failed, 'case', self.run)} failed ({wilson.words(self.failed, self.run)})"
        if not self.run:
            failed = "no case ran"
        if self.failed:
            failed += f", {self.caught} of them off within {1e3 * CAUGHT:.0f} ms and in words"
        return f"{failed}; {self.refused} of {self.cases} {refusal} ({wilson.words(self.refused, self.cases)})"

    def published(self) -> dict[str, Any]:
        """As the file of the results has it; shares are in percent, from and to at 95 %."""
        return {
            "cases": self.cases,
            "good": self.good,
            "failed": self.failed,
            "failed_share": wilson.interval(self.failed, self.run),
            "caught": self.caught,
            "refused": self.refused,
            "refused_share": wilson.interval(self.refused, self.cases),
        }


def tally(rows: Iterable[Row]) -> Tally:
    """How cases ended."""
    verdicts = [row.verdict for row in rows]
    ends = Counter(verdict.end for verdict in verdicts)
    return Tally(ends[End.GOOD], ends[End.REFUSED], ends[End.FAILED], sum(verdict.caught for verdict in verdicts))


def plain(rows: Iterable[Row]) -> list[Row]:
    """Those in which nothing was broken on purpose."""
    return [row for row in rows if not row.case.fault]


def faulted(rows: Iterable[Row]) -> list[Row]:
    """The others."""
    return [row for row in rows if row.case.fault]


def lines(rows: Sequence[Row], motors: Sequence[str]) -> list[str]:
    """The outcome for the terminal: motor by motor, then all of them together."""
    groups = [(motor, [row for row in rows if row.motor == motor]) for motor in motors]
    if len(motors) > 1:
        groups.append(("all of them", list(rows)))
    found = []
    for name, group in groups:
        if plain(group):
            found.append(f"{name}: {tally(plain(group)).words()}")
        if faulted(group):
            found.append(f"{name}, with a fault: {tally(faulted(group)).words('ended by the drive in words first')}")
    return found


def reasons(rows: Iterable[Row]) -> Counter[str]:
    """Why the drive refused, how often, in its own words."""
    return Counter(row.verdict.words for row in rows if row.verdict.end is End.REFUSED)


def published(rows: Sequence[Row], motors: Sequence[str]) -> dict[str, Any]:
    """The same as `lines`, for programs."""
    named = {motor: [row for row in rows if row.motor == motor] for motor in motors}
    return {
        name: {"plain": tally(plain(group)).published(), "with_fault": tally(faulted(group)).published()}
        for name, group in {**named, "all": list(rows)}.items()
    }
