"""Whether the drive fits its chip: the counts of image and interrupt by the costs of real C28x code."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import Any

COSTS = "toolchain/f2808/measured_costs.toml"
EIGHTY_PERCENT = 2 * NormalDist().inv_cdf(0.9)  # width of that interval in standard deviations


@dataclass(frozen=True)
class Fit:
    """What the book says of it.

    Attributes:
        words, room: of flash, expected and there; chance: that it fits, %; full: words for a half word at which the
            flash is full.
        from_flash, from_ram: cycles of the longest control interrupt with its windows; period: cycles that there are.
        start: how much longer the longest period of a start is, %.
    """

    words: float
    room: int
    chance: float
    full: float
    from_flash: float
    from_ram: float
    period: int
    start: float

    @property
    def flash_share(self) -> float:
        """Of the flash, %."""
        return 100 * self.words / self.room

    @property
    def fits(self) -> bool:
        """By what is expected."""
        return self.words <= self.room and self.from_flash <= self.period

    def share(self, cycles: float) -> float:
        """Of the period, %."""
        return 100 * cycles / self.period


def fit(root: Path, image: Mapping[str, Any], cost: Mapping[str, Any]) -> Fit:
    """By the figures of `make image-check` and of `make isr-cost`."""
    costs = tomllib.loads((root / COSTS).read_text(encoding="utf-8"))
    words, cycles = costs["words"], costs["cycles"]
    code = image["code"]["words"] + image["ram_code"]["words"]
    room, data = image["flash"]["goal"], image["flash"]["words"] - code
    full = (room - data) / code
    spread = (words["high"] - words["low"]) / EIGHTY_PERCENT
    steps = cost["observer"]["steps"]
    worst, window = (steps[f"turning {name}"]["worst"] for name in ("all", "window"))
    executed = cycles["as_the_image"] * (worst + cycles["windows"] * window)
    entries = (1 + cycles["windows"]) * cycles["interrupt_entry"]
    return Fit(
        words=data + words["expected"] * code,
        room=room,
        chance=100 * NormalDist(words["expected"], spread).cdf(full),
        full=full,
        from_flash=executed * cycles["flash"] + entries,
        from_ram=executed * cycles["ram"] + entries,
        period=cycles["period"],
        start=100 * (steps["starting all"]["worst"] / worst - 1),
    )


def hundreds(value: float) -> str:
    """`78 200`: to the hundred."""
    return f"{100 * math.floor(value / 100 + 0.5):,}".replace(",", " ")
