"""Whether the drive fits its chip, by what image and interrupt are expected to take of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from costs import chance_of_cycles, chance_of_words, costs

EDITIONS = ("drive", "lab")
"""Which of them the book speaks of: the first that is built and counted."""
SOURCE = "observer"


@dataclass(frozen=True)
class Fit:
    """What the book says of it.

    Attributes:
        edition: the one that this is about.
        words, words_p90, room: of flash, expected, at 90 %, and there; flash_chance: that it fits, %.
        worst, worst_p90, mean: cycles of a period, windows included; period: that there are; time_chance: that it fits.
    """

    edition: str
    words: int
    words_p90: int
    room: int
    flash_chance: float
    worst: int
    worst_p90: int
    mean: int
    period: int
    time_chance: float

    @property
    def fits(self) -> bool:
        """By what is expected."""
        return self.words <= self.room and self.worst <= self.period

    @property
    def is_open(self) -> bool:
        """Whether it is expected to fit, and yet may not: with a probability of less than 90 %."""
        return self.fits and (self.words_p90 > self.room or self.worst_p90 > self.period)

    def of_flash(self, words: float) -> float:
        """Of the flash, %."""
        return 100 * words / self.room

    def of_period(self, cycles: float) -> float:
        """Of the period, %."""
        return 100 * cycles / self.period


def fit(root: Path, image: Mapping[str, Any], cost: Mapping[str, Any]) -> Fit:
    """By the figures of `make image-check` and of `make isr-cost`.

    Raises:
        LookupError: no edition has been both built and counted.
    """
    known = costs(root)
    both = [name for name in EDITIONS if name in image["editions"] and name in cost["editions"]]
    if not both:
        raise LookupError("no edition has been both built and counted: make image-check isr-cost")
    edition = both[0]
    flash, time = image["editions"][edition], cost["editions"][edition]["by_source"][SOURCE]
    words, room = flash["flash_words_expected"], flash["flash_words_available"]
    code = image["details"][edition]["thumb"]["words"]
    ratio = known["words"]["expected"] + (room - words) / code
    worst, period = time["worst_cycles_expected"], cost["period_cycles"]
    return Fit(
        edition,
        words,
        flash["flash_words_p90"],
        room,
        chance_of_words(known["words"], ratio),
        worst,
        time["worst_cycles_p90"],
        time["mean_cycles_expected"],
        period,
        chance_of_cycles(known["cycles"], period / worst),
    )


def chance(percent: float) -> str:
    """`0.9 %`; what is next to nothing is said to be that."""
    return "below 0.1 %" if percent < 0.1 else f"{percent:.1f} %" if percent < 10 else f"{percent:.0f} %"


def hundreds(value: float) -> str:
    """`78 200`: to the hundred."""
    return f"{100 * math.floor(value / 100 + 0.5):,}".replace(",", " ")
