"""Fault files (`faults/*.toml`): what breaks while a case runs, and in how many of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from stillspin import core
from stillspin.campaign.tables import NAME, NUMBER, TEXT, pair, read, rows, table, unique
from stillspin.entry import Entry, Value
from stillspin.errors import InputError
from stillspin.json_schema import DIALECT, Json

_SECTION = "fault"  # of the plant
_AT = "_at"  # how those of its entries end that say when


@dataclass(frozen=True)
class Fault:
    """Something that breaks. entries: of the plant's section `fault`; at: the one that gets the time."""

    name: str
    title: str
    entries: Mapping[str, Value]
    at: str


@dataclass(frozen=True)
class Faults:
    """All faults of a file.

    Attributes:
        share: of the cases have one of them, all alike.
        window: when, as shares of the run.
    """

    name: str = ""
    description: str = ""
    share: float = 0.0
    window: tuple[float, float] = (0.0, 1.0)
    faults: tuple[Fault, ...] = ()

    def drawn(self, has: float, which: float) -> str | None:
        """The name of a fault, or None, by two numbers within 0 … 1."""
        if has >= self.share or not self.faults:
            return None
        return self.faults[min(int(which * len(self.faults)), len(self.faults) - 1)].name

    def at(self, when: float) -> float:
        """The share of the run at which it breaks, by a number within 0 … 1."""
        first, last = self.window
        return first + when * (last - first)

    def named(self, name: str) -> Fault:
        """That of a name."""
        return next(fault for fault in self.faults if fault.name == name)


def load(name_or_path: str, entries: core.Schema) -> Faults:
    """The faults that ship under a name, or those in a file.

    Raises:
        InputError: there are none, or the file is wrong.
    """
    path, data = read("faults", name_or_path, schema(entries))
    first, last = map(float, data.get("window", (0.1, 0.9)))
    if not 0.0 <= first < last <= 1.0:
        raise InputError(f"{path}: window = {data['window']}: must be shares of the run, [from, to], 0 ≤ from < to ≤ 1")
    faults = tuple(
        _fault(row, entries[_SECTION], f"{path}: faults[{number}]") for number, row in enumerate(data["faults"])
    )
    unique([fault.name for fault in faults], f"{path}: faults")
    return Faults(path.stem, data.get("description", "").strip(), float(data["share"]), (first, last), faults)


def _fault(row: Json, entries: Mapping[str, Entry], where: str) -> Fault:
    stated = {key: entries[key].value(value) for key, value in row["set"].items()}
    if row["at"] in stated:
        raise InputError(f"{where}: set.{row['at']}: is drawn, as 'at' says; leave it out")
    return Fault(row["name"], str(row.get("title", row["name"])), stated, row["at"])


def schema(entries: core.Schema) -> Json:
    """Of a fault file; `entries`: of the plant."""
    share = NUMBER | {"minimum": 0, "maximum": 1}
    section = entries[_SECTION]
    times = [key for key in section if key.endswith(_AT)]
    row = {
        "name": NAME,
        "title": TEXT,
        "set": table({key: entry.schema for key, entry in section.items()})
        | {"description": "Entries of the plant's section fault."},
        "at": {"enum": times, "description": "The entry that gets the time."},
    }
    keys = {
        "description": TEXT,
        "share": share | {"description": "Of the cases: how many have one of the faults."},
        "window": pair(share) | {"description": "When, as shares of the run [default: 0.1 to 0.9]."},
        "faults": rows(table(row, "name", "set", "at")),
    }
    return {"$schema": DIALECT, "title": "stillspin faults file", **table(keys, "share", "faults")}
