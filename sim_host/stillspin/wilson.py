"""How sure a share is that was counted."""

from __future__ import annotations

import math

DEVIATIONS = 1.96
"""Standard deviations to either side that hold 95 % of a normal distribution."""


def interval(count: int, of: int) -> tuple[float, float]:
    """The share, in percent, that lies behind `count` of `of`: from and to at 95 %, by Wilson.

    It holds for none and for all of them, too; of nothing everything is possible.
    """
    if not of:
        return 0.0, 100.0
    share, z2 = count / of, DEVIATIONS**2
    middle = share + z2 / 2 / of
    half = DEVIATIONS * math.sqrt(share * (1 - share) / of + z2 / 4 / of / of)
    low, high = (100 * (middle + side) / (1 + z2 / of) for side in (-half, half))
    return max(low, 0.0), min(high, 100.0)


def words(count: int, of: int) -> str:
    """The same for people, such as "0.0 to 0.4 % at 95 %"."""
    low, high = interval(count, of)
    return f"{low:.1f} to {high:.1f} % at 95 %" if high >= 1.0 else f"{low:.2g} to {high:.2g} % at 95 %"
