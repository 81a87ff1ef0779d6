"""Whether what runs from RAM is what brings most there: cycles of a period for a word, by the measure."""

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from isr.program import Function

Row = Mapping[str, Any]  # of the table of functions (count.py)
EDITION = "drive"  # by the runs of which the list is chosen
MANY = 5  # that are said
SMALL = 20  # words below which a function's place is nobody's business


def rate(row: Row) -> float:
    """Cycles of a mean and of the longest period, for a word."""
    return float(row["mean"] + row["longest"]) / max(row["words"], 1)


def cold(functions: Iterable[Function], ran: Collection[int]) -> list[str]:
    """What is in RAM and ran in no interrupt; `ran`: places in the list of functions."""
    return [
        f"{each.name}, {each.file} is in RAM and cold"
        for place, each in enumerate(functions)
        if each.in_ram and place not in ran and each.size >= 2 * SMALL
    ]


def hotter(rows: Iterable[Row]) -> list[str]:
    """What in flash is hotter than half of what is in RAM."""
    rows = sorted(
        (row for row in rows if row["file"] and row["words"] >= SMALL),
        key=rate,
        reverse=True,
    )
    inside = [row for row in rows if row["in"] == "RAM"]
    if not inside:
        return []
    usual = rate(inside[len(inside) // 2])
    outside = [row for row in rows if row["in"] != "RAM" and rate(row) > usual]
    return [
        f"{row['function']}, {row['file']} is in flash, {rate(row):.1f} cycles a word: half of what is in RAM has less"
        for row in outside[:MANY]
    ]
