"""The look of the drawings: sizes, colours, fonts."""

from __future__ import annotations

from typing import Any

WIDTH = 9.2
PANEL_HEIGHT = 1.85
COLUMNS = 1100
"""Slices a line is thinned to; each keeps its smallest and its largest value."""

# Distinguishable with the common colour blindnesses (after Okabe and Ito).
COLOURS = {
    "true": "#0b5fa5",
    "estimate": "#e07b00",
    "reference": "#3a3a3a",
    "setpoint": "#9aa3ad",
    "error": "#b3243b",
    "q": "#0b5fa5",
    "d": "#1b8a5a",
    "a": "#0b5fa5",
    "b": "#e07b00",
    "c": "#1b8a5a",
}
RUN_COLOURS = ["#0b5fa5", "#e07b00", "#1b8a5a", "#b3243b", "#7a4fb0", "#8a6d1b", "#1aa3b8", "#5c5c5c"]

# An estimate lies as a pale band under the true line, so that both are seen where they agree.
ROLES: dict[str, Any] = {
    "true": {"zorder": 3},
    "reference": {"zorder": 4, "linestyle": (0, (4, 2)), "linewidth": 1.0},
    "setpoint": {"zorder": 1.5, "linewidth": 2.2},
    "estimate": {"zorder": 2, "linewidth": 2.6, "alpha": 0.6},
}

STYLE: Any = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same drawing on every machine
    "font.size": 10.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#888888",
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "axes.labelcolor": "#333333",
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "lines.linewidth": 1.1,
    "svg.fonttype": "path",
    "svg.hashsalt": "stillspin",  # the same run gives the same bytes
    "path.simplify": True,
    "path.simplify_threshold": 0.3,
}
