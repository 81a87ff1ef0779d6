"""Empty drawings. They are made without pyplot, which keeps every figure until it is closed and takes long to load."""

from __future__ import annotations

from typing import Any, Literal

from matplotlib.figure import Figure


def subplots(
    rows: int = 1,
    columns: int = 1,
    *,
    figsize: tuple[float, float],
    layout: Literal["constrained"] | None = "constrained",
    **options: Any,
) -> tuple[Figure, Any]:
    """A figure and its axes, as `matplotlib.pyplot.subplots` returns them.

    Args:
        rows: of axes.
        columns: of axes.
        figsize: width and height, in.
        layout: how room is found for labels; None leaves it to the caller.
        options: of `Figure.subplots`.
    """
    figure = Figure(figsize=figsize, layout=layout)
    return figure, figure.subplots(rows, columns, **options)
