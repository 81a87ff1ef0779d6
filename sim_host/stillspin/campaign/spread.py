"""Spread files (`spreads/*.toml`): by how much units and their surroundings depart from what motor and profile say.

A departure is one number, drawn for each case, whose nominal value is 0. What it moves it moves together: a warm
winding has more resistance and its magnet less flux.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from stillspin import core
from stillspin.campaign.tables import NAME, NUMBER, TEXT, pair, read, rows, table, unique
from stillspin.entry import Entry
from stillspin.errors import InputError
from stillspin.json_schema import DIALECT, Json

Pulls = Mapping[str, Mapping[str, float]]
"""By section and entry of the plant: how much of it goes with one unit of a departure."""

_MOVES = ("factor", "add", "add_of_range", "load")
_DIGITS = 6  # of a drawn number


@dataclass(frozen=True)
class Departure:
    """Something that differs from unit to unit.

    Attributes:
        name: unique in its file; title: in words; unit: of the number that is drawn.
        deviation: standard deviation of a normal distribution, cut off at low and high; None for a uniform one.
        factor: an entry is multiplied by 1 + so much times the number; add: it gets so much times the number more.
        add_of_range: the same as add, in shares of what the current sensors measure at most.
        load: so much of the rated torque more.
    """

    name: str
    title: str
    unit: str
    low: float
    high: float
    deviation: float | None = None
    factor: Pulls = field(default_factory=dict)
    add: Pulls = field(default_factory=dict)
    add_of_range: Pulls = field(default_factory=dict)
    load: float = 0.0

    def draw(self, seed: int, number: int) -> float:
        """The number in case `number`; it depends on nothing else of the file than this departure."""
        source = np.random.default_rng([seed, number, zlib.crc32(self.name.encode())])
        while True:
            drawn = (
                source.uniform(self.low, self.high) if self.deviation is None else source.normal(0.0, self.deviation)
            )
            if self.low <= drawn <= self.high:
                return float(f"{drawn:.{_DIGITS}g}")

    @property
    def moves(self) -> str:
        """What goes with it, in the words of `--set`."""
        entries = [
            f"{section}.{key}"
            for pulls in (self.factor, self.add, self.add_of_range)
            for section, keys in pulls.items()
            for key in keys
        ]
        return ", ".join([*entries, *(["the load"] if self.load else [])])

    def words(self, number: float) -> str:
        """For people, such as "resistance +4.2 %"."""
        return f"{self.name} {number:+.4g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Spread:
    """All departures of a file."""

    name: str
    description: str
    departures: tuple[Departure, ...]


def load(name_or_path: str, entries: core.Schema) -> Spread:
    """The spread that ships under a name, or the one in a file.

    Raises:
        InputError: there is none, or its file is wrong.
    """
    path, data = read("spreads", name_or_path, schema(entries))
    found = [_departure(row, f"{path}: departures[{n}]") for n, row in enumerate(data["departures"])]
    unique([row.name for row in found], f"{path}: departures")
    return Spread(path.stem, data.get("description", "").strip(), tuple(found))


def _departure(row: Json, where: str) -> Departure:
    deviation, low, high = _law(row, f"{where} ({row['name']})")
    if not any(row.get(key) for key in _MOVES):
        raise InputError(f"{where} ({row['name']}): moves nothing; give one of {', '.join(_MOVES)}")
    for section, keys in row.get("factor", {}).items():
        for key, per in keys.items():
            least = min(1.0 + per * low, 1.0 + per * high)
            if least <= 0.0:
                words = f"at an end of the draw the entry is {least:g} times what it is nominally; must stay above 0"
                raise InputError(f"{where}: factor.{section}.{key} = {per:g}: {words}")
    return Departure(
        name=row["name"],
        title=str(row.get("title", row["name"])),
        unit=row.get("unit", ""),
        low=low,
        high=high,
        deviation=deviation,
        factor=row.get("factor", {}),
        add=row.get("add", {}),
        add_of_range=row.get("add_of_range", {}),
        load=float(row.get("load", 0.0)),
    )


def _law(row: Json, where: str) -> tuple[float | None, float, float]:
    """Standard deviation, None for a uniform distribution, and both ends."""
    if ("normal" in row) == ("uniform" in row):
        raise InputError(f"{where}: give one of 'normal', with 'limit', and 'uniform'")
    if "uniform" in row:
        low, high = map(float, row["uniform"])
        if "limit" in row:
            raise InputError(f"{where}: limit = {row['limit']:g}: goes with 'normal'; 'uniform' has ends of its own")
        if not low <= 0.0 <= high or low == high:
            raise InputError(f"{where}: uniform = {row['uniform']}: must be [from, to], from ≤ 0 ≤ to; 0 is nominal")
        return None, low, high
    deviation, limit = float(row["normal"]), float(row.get("limit", 3.0 * row["normal"]))
    if not 0.0 < deviation <= limit:
        raise InputError(f"{where}: normal = {deviation:g}: must be above 0 and at most limit, which is {limit:g}")
    return deviation, -limit, limit


def schema(entries: core.Schema) -> Json:
    """Of a spread file; `entries`: of the plant. Two places that have to fit together are the loader's to check."""
    pulls = table({name: table(dict.fromkeys(_numbers(keys), NUMBER)) for name, keys in entries.items()})
    departure = {
        "name": NAME,
        "title": TEXT,
        "unit": TEXT | {"description": "Of the number that is drawn."},
        "normal": NUMBER | {"description": "Standard deviation of a normal distribution about 0."},
        "limit": NUMBER | {"description": "Where it is cut off [default: three standard deviations]."},
        "uniform": pair(NUMBER) | {"description": "Ends of a uniform distribution; 0, nominal, is between them."},
        "factor": pulls | {"description": "Multiply by 1 + this times the number."},
        "add": pulls | {"description": "Add this times the number."},
        "add_of_range": pulls | {"description": "Add this times the number, as a share of adc.current_range."},
        "load": NUMBER | {"description": "Add this times the number, a share of the rated torque, to the load."},
    }
    keys = {"description": TEXT, "departures": rows(table(departure, "name"))}
    return {"$schema": DIALECT, "title": "stillspin spread file", **table(keys, "departures")}


def _numbers(keys: Mapping[str, Entry]) -> list[str]:
    """Entries that take any number: no switches, words or counts."""
    return [key for key, entry in keys.items() if isinstance(entry.default, float)]
