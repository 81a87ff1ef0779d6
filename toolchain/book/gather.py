"""The figures of a command's results: what it wrote for programs, and what its records say speed by speed."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from stillspin import csv_table
from stillspin.measure import metrics, speed_profile
from stillspin.runs import records

OVER_SPEED = ("S08", "S09", "S10")
"""Scenarios whose tables have a row or a column for each speed that is held."""


def gather(out: Path) -> dict[str, Any]:
    """What tables are made of, by the name of the file that has it."""
    return dict(_files(out))


def worst(each: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Of the scenarios' figures of several seeds the largest, none where a run was lost, and with how many that was."""
    found: dict[str, Any] = {}
    for scenario, figures in each[0].items():
        for name, figure in figures.items():
            values = [one[scenario][name]["value"] for one in each]
            lost = values.count(None)
            largest = None if lost else max(values, key=abs)
            found.setdefault(scenario, {})[name] = {"value": largest, "lost": lost, "unit": figure["unit"]}
    return found


def _files(out: Path) -> Iterator[tuple[str, Any]]:
    for path in sorted(out.iterdir()):
        if path.suffix == ".toml":
            yield path.stem, tomllib.loads(path.read_text(encoding="utf-8"))
        elif path.name == "startup.csv":
            yield "startup", _starts(path)
        elif path.suffix == ".json":
            content = json.loads(path.read_text(encoding="utf-8"))
            yield path.stem, content.get("scenarios", content)
    holds = {name: _holds(out / "runs", name) for name in OVER_SPEED if any((out / "runs").glob(f"{name}-*.parquet"))}
    if holds:
        yield "holds", holds


def _holds(runs: Path, scenario: str) -> dict[str, list[list[float | None]]]:
    """Of each run the speeds that were held, rpm, and the peak of the position error there; None where it was lost."""
    found = {}
    for path in sorted(runs.glob(f"{scenario}-*.parquet")):
        if path.stem.endswith(".waveform"):
            continue
        signals = records.read(path).signals
        held = speed_profile.holds(signals, metrics.position_error(signals))
        run = path.stem.removeprefix(f"{scenario}-")
        found[run] = [[hold.reference, hold.peak if hold.followed else None] for hold in held]
    return found


def _starts(path: Path) -> list[dict[str, Any]]:
    """The worst of each group of starts: how the shaft was, and what the drive was told wrong."""
    groups: dict[tuple[str, str], list[dict[str, str]]] = {}
    for row in csv_table.read(path)[1]:
        groups.setdefault((row["way"], row["error"]), []).append(row)
    return [
        {
            "way": way,
            "error": error,
            "starts": len(rows),
            "failed": sum(bool(row["problem"]) for row in rows),
            "backward_deg": max(float(row["backward_deg"]) for row in rows),
            "angle_error_deg": max(abs(float(row["angle_error_deg"])) for row in rows),
        }
        for (way, error), rows in groups.items()
    ]
