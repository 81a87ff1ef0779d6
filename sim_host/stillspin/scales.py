"""What an ampere and a volt of the drive's formats are: powers of two, two parameters (firmware/dictionary/units.h)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

CURRENT, VOLTAGE = SCALES = ("current_scale", "voltage_scale")
"""The two parameters."""
POWERS = {
    **dict.fromkeys(("A", "mA", "A/s"), (1, 0)),
    **dict.fromkeys(("V", "Vs", "mVs"), (0, 1)),
    **dict.fromkeys(("ohm", "mH"), (-1, 1)),
    **dict.fromkeys(("Nm", "Nms", "kgm2"), (1, 1)),
    "A2s2": (2, 0),
    "%/A": (-1, 0),
    "A/V": (1, -1),
}
"""By unit: how often it has that of a current and that of a voltage in it; as firmware/dictionary/unit_list.h."""
DECIMALS_MOST = 9
"""UNIT_DECIMALS_MAX of units.h."""

Pair = tuple[int, int]


def of(told: Mapping[str, Any]) -> Pair:
    """Both among the values that a drive is told; 0 where it is not told."""
    return round(float(told.get(CURRENT, 0.0))), round(float(told.get(VOLTAGE, 0.0)))


def exponent(unit: str, scales: Pair) -> int:
    """A value in this unit is one of the formats times two to this."""
    powers = POWERS.get(unit, (0, 0))
    return powers[0] * scales[0] + powers[1] * scales[1]


def decimals(nominal: int, moved: int) -> int:
    """As many as show, times two to `moved`, what `nominal` of them show; as unit_decimals of units.h."""
    return min(nominal + (3 * max(0, -moved) + 9) // 10, DECIMALS_MOST)
