"""What code costs on the chip (toolchain/f2808/measured_costs.toml), and how sure that is."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from statistics import NormalDist
from typing import Any

FILE = "toolchain/f2808/measured_costs.toml"
EIGHTY, NINETY = (NormalDist().inv_cdf(share) for share in (0.9, 0.95))  # ends of the intervals, standard deviations


def costs(root: Path) -> Mapping[str, Any]:
    """The tables `words` and `cycles`."""
    return tomllib.loads((root / FILE).read_text(encoding="utf-8"))


def chance_of_words(words: Mapping[str, Any], ratio: float) -> float:
    """That a half word of Thumb-2 takes no more words than that, %."""
    deviation = (words["high"] - words["low"]) / (2 * EIGHTY)
    return 100 * NormalDist(words["expected"], deviation).cdf(ratio)


def chance_of_cycles(cycles: Mapping[str, Any], ratio: float) -> float:
    """That all takes no more than so many times what is expected, %: logarithms are spread as errors are."""
    return 100 * NormalDist(0, math.log(cycles["factor"]) / NINETY).cdf(math.log(ratio))
