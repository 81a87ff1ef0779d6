"""The bars of `stillspin explain`: a panel per figure, a pair of bars per effect."""

from __future__ import annotations

import io

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes

from stillspin.measure.figures import Result
from stillspin.report.canvas import subplots
from stillspin.report.explanation import Explanation
from stillspin.report.page import unit_text
from stillspin.report.style import COLOURS, STYLE, WIDTH
from stillspin.runs.effects import ALONE, WITHOUT

_ROW = 0.3  # in of height for an effect


def draw(found: Explanation) -> str:
    """The picture as SVG text."""
    figures = found.figures
    with mpl.rc_context(STYLE):
        height = len(figures) * (1.1 + _ROW * len(found.effects))
        canvas, axes = subplots(len(figures), figsize=(WIDTH, height), squeeze=False)
        for panel, figure in zip(axes[:, 0], figures, strict=True):
            _panel(panel, found, figure)
        file = io.StringIO()
        canvas.savefig(file, format="svg", metadata={"Date": None})
    return file.getvalue()


def _panel(panel: Axes, found: Explanation, figure: Result) -> None:
    place = np.arange(len(found.effects))
    bars = {"without it": (WITHOUT, -0.2, COLOURS["true"])}
    if found.alone:
        bars["alone on ideal"] = (ALONE, 0.2, COLOURS["estimate"])
    for label, (kind, offset, colour) in bars.items():
        values = [abs(found.value(kind, effect, figure.name) or 0.0) for effect in found.effects]
        panel.barh(place + offset, values, 0.36, color=colour, label=label)
    if figure.value is not None:
        panel.axvline(abs(figure.value), color=COLOURS["error"], label="as it is")
    if figure.goal is not None:
        panel.axvline(figure.goal, color=COLOURS["reference"], linestyle="--", label="goal")
    best = found.dominating(figure)
    panel.set_yticks(place, [effect.title for effect in found.effects])
    for text, effect in zip(panel.get_yticklabels(), found.effects, strict=True):
        text.set_fontweight("bold" if effect is best else "normal")
    panel.invert_yaxis()
    panel.grid(visible=False, axis="y")
    panel.set_xlabel(f"{figure.name}, {unit_text(figure.unit)}" if figure.unit else figure.name)
    panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
