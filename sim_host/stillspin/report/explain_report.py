"""What came of `stillspin explain`: numbers by figure and effect, the dominating one, a picture with bars."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from stillspin.extras import need
from stillspin.measure.figures import Result
from stillspin.report import output
from stillspin.report.explanation import Explanation
from stillspin.runs.effects import ALONE, WITHOUT
from stillspin.runs.execute import Settings

PICTURE = "explain.svg"


def content(found: Explanation, settings: Settings) -> dict[str, Any]:
    """The content of `metrics.json`."""
    return {
        "profile": settings.profile.name,
        "seed": settings.seed,
        "revision": settings.revision,
        "firmware": settings.firmware,
        "scenario": found.scenario.id,
        "effects": {effect.mark: effect.title for effect in found.effects},
        "figures": {figure.name: _figure(found, figure) for figure in found.figures},
        "broken": found.broken,
    }


def _figure(found: Explanation, figure: Result) -> dict[str, object]:
    best = found.dominating(figure)
    row: dict[str, object] = {
        **figure.as_json(),
        "dominating": best.mark if best else None,
        "without": {effect.mark: found.value(WITHOUT, effect, figure.name) for effect in found.effects},
    }
    if found.alone:
        row["ideal"] = found.value(ALONE, None, figure.name)
        row["alone"] = {
            effect.mark: found.value(ALONE, effect, figure.name) for effect in found.effects if not effect.exact
        }
    return row


def write(directory: Path, found: Explanation, settings: Settings) -> None:
    """Write `metrics.json` and the picture into an existing directory."""
    text = json.dumps(content(found, settings), indent=2, ensure_ascii=False, allow_nan=False)
    (directory / output.MARK).write_text(text + "\n", encoding="utf-8")
    (directory / PICTURE).write_text(_drawn(found), encoding="utf-8")


def _drawn(found: Explanation) -> str:
    need("matplotlib")
    from stillspin.report import explain_plot  # noqa: PLC0415 - matplotlib takes a second to load, and not all need it

    return explain_plot.draw(found)
