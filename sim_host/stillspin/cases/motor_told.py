"""A motor as its file has it, with what the drive is told of it; and what was found in looking at it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from stillspin import core
from stillspin.cases.profile import Profile
from stillspin.entry import Entry

PERIOD = 1e-4  # s, of the control interrupt


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at; `words` are for people."""

    title: str
    works: bool
    words: str


class Described(Protocol):
    """A machine with its board, and what the drive is told of it."""

    def plant(self, section: str, key: str) -> float:
        """What the machine and its board are, in SI units."""
        ...

    def told(self, name: str) -> float:
        """A parameter of the drive, in its own unit."""
        ...


@dataclass(frozen=True)
class Motor:
    """A motor with what the drive is told of it, in SI units where the plant has them."""

    profile: Profile
    schema: core.Schema
    known: Mapping[str, Entry]

    def plant(self, section: str, key: str) -> float:
        """An entry of the plant."""
        return float(self.profile.plant.get(section, {}).get(key, self.schema[section][key].default))

    def told(self, name: str) -> float:
        """A parameter of the drive, in its own unit."""
        return float(self.profile.parameters.get(name, self.known[name].default))
