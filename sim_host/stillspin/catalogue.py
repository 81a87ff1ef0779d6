"""The catalogue: other people's motors by public data, what each of them is, and what the drive of today says of it.

A file of it says in its `description` what no key of a motor's file has: what the motor is for and its nameplate's
power and speed, where its data are from, and which of them are assumed.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stillspin import core, resources
from stillspin.cases import motor_check, profile
from stillspin.cases.motor_told import Motor
from stillspin.errors import InputError

_WORDS = re.compile(
    r"(?P<kind>[^\n]+): (?P<kilowatts>[\d.]+) kW at (?P<speed>\d+) rpm\.\n"
    r"Source: (?P<source>[^\n]+)\.\n"
    r"Assumed: (?P<assumed>[\w, ]+)\.\n?"
)
_NOTHING = "nothing"
_REFUSALS = {"range", "drive's rules"}
"""Findings after which the drive does not take the parameters at all; with the others it does, to no avail."""


@dataclass(frozen=True)
class Entry:
    """A motor of the catalogue by its file, in units of a nameplate.

    Attributes:
        kind: what it is for, and its rotor.
        source: of its data. assumed: keys of the file whose values are not from there.
        volts: of the DC link. amperes: rated, peak.
        saliency: Lq / Ld without current.
    """

    name: str
    kind: str
    volts: float
    amperes: float
    kilowatts: float
    speed: int
    pole_pairs: int
    saliency: float
    source: str
    assumed: tuple[str, ...]


@dataclass(frozen=True)
class Verdict:
    """What `stillspin motor check` says of a motor with its own profile.

    Attributes:
        word: "works", "refused" where the drive does not take its values, else "will not work".
        reason: the first finding that is wrong, with its numbers; empty where none is.
    """

    word: str
    reason: str


def read(path: Path) -> Entry:
    """What a file of the catalogue says.

    Raises:
        InputError: its description does not say what the motor is, where its data are from, and what is assumed.
    """
    data: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    words = _WORDS.fullmatch(data.get("description", ""))
    if not words:
        raise InputError(
            f"{path}: description: must be the lines 'KIND: N kW at N rpm.', 'Source: WHERE.' and 'Assumed: KEYS.', "
            f"the last one with '{_NOTHING}' where every key is from there"
        )
    machine = data["machine"]
    return Entry(
        path.stem,
        words["kind"],
        data["link"]["source_voltage"],
        machine["rated_peak_current"],
        float(words["kilowatts"]),
        int(words["speed"]),
        machine["pole_pairs"],
        machine["inductance_q"] / machine["inductance_d"],
        words["source"],
        () if words["assumed"] == _NOTHING else tuple(words["assumed"].split(", ")),
    )


def entries(folder: Path | None = None) -> list[Entry]:
    """All motors of the catalogue, or of another folder, from the lowest link's voltage to the highest."""
    found = map(read, (folder or resources.directory(resources.CATALOGUE)).glob("*.toml"))
    return sorted(found, key=lambda entry: (entry.volts, entry.name))


def verdict(name: str, native: core.NativeCore) -> Verdict:
    """What `motor check` says of a motor of the catalogue, by a start of the virtual drive where it comes to that."""
    schema, known = core.plant_schema(native), core.parameters(native)
    try:
        chosen = profile.load(name, schema, known, name, checked=False)
    except InputError as error:
        return Verdict("refused", str(error).removeprefix(f"{resources.find('motors', name)}: "))
    motor = Motor(chosen, schema, core.at_scale(known, chosen.parameters))
    wrong = [finding for finding in motor_check.findings(motor, native) if not finding.works]
    if not wrong:
        return Verdict("works", "")
    return Verdict("refused" if wrong[0].title in _REFUSALS else "will not work", f"{wrong[0].title}: {wrong[0].words}")
