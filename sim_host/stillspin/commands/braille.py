"""Line plots in a terminal: every character is a field of 2 by 4 dots (Unicode braille patterns)."""

from __future__ import annotations

import math
from collections.abc import Sequence

_BASE = 0x2800
_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))


def plot(
    series: Sequence[Sequence[float]], low: float, high: float, width: int, height: int
) -> list[list[tuple[str, int]]]:
    """Lines over a common raster; the newest value is at the right.

    Args:
        series: values of each line, oldest first; only the last 2·width are shown. NaN leaves a gap.
        low: value of the lower edge.
        high: value of the upper edge.
        width: characters.
        height: characters.

    Returns:
        Rows from the top; each a list of character and number of the line it belongs to (-1 for none).
    """
    dots = [[0] * width for _ in range(height)]
    owner = [[-1] * width for _ in range(height)]
    columns, rows = 2 * width, 4 * height
    for number, values in enumerate(series):
        shown = values[-columns:]
        before: int | None = None
        for at, value in enumerate(shown, columns - len(shown)):
            if not math.isfinite(value):
                before = None
                continue
            row = _row(value, low, high, rows)
            for step in _between(before, row):
                dots[step // 4][at // 2] |= _DOTS[step % 4][at % 2]
                owner[step // 4][at // 2] = number
            before = row
    return [
        [(chr(_BASE + mask), line) for mask, line in zip(masks, lines, strict=True)]
        for masks, lines in zip(dots, owner, strict=True)
    ]


def _row(value: float, low: float, high: float, rows: int) -> int:
    share = (value - low) / (high - low) if high > low else 0.5
    return min(rows - 1, max(0, round((1 - share) * (rows - 1))))


def _between(before: int | None, row: int) -> range:
    """The dots of a column that join the last value with this one."""
    if before is None or abs(row - before) <= 1:
        return range(row, row + 1)
    return range(before + 1, row + 1) if before < row else range(row, before)


def nice_range(low: float, high: float) -> tuple[float, float]:
    """A range of round numbers around `low` … `high`."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return (-1.0, 1.0)
    span = max(high - low, 1e-6 * max(abs(low), abs(high)), 1e-3)
    step = 10.0 ** math.floor(math.log10(span))
    step = next(step * factor for factor in (0.2, 0.5, 1, 2, 5) if span / (step * factor) <= 5)
    down, up = math.floor(low / step) * step, math.ceil(high / step) * step
    # The products are rounded, so either end may have come to lie inside, or both at the same place.
    return (down - step if down > low else down, up + step if up < high or up <= down else up)
