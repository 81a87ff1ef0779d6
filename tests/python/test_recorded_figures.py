"""Figures in README.md and the book are those of these sources: two scenarios run anew give the recorded ones."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("stillspin._core", reason="the native module is not built")

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "docs/figures"
DUE = "the drive has other figures than docs/figures: run make figures"


def recorded(name: str) -> dict[str, Any]:
    """What `make figures` has kept of a command."""
    figures: dict[str, Any] = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))["figures"]
    return figures


def run(out: Path, scenario: str, *options: str) -> dict[str, Any]:
    """The figures of a scenario, run now."""
    command = [sys.executable, "-m", "stillspin", "run", scenario, "--no-plots", "--out", str(out), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (out / "metrics.json").exists(), done.stderr
    found: dict[str, Any] = json.loads((out / "metrics.json").read_text(encoding="utf-8"))["scenarios"][scenario]
    return found


@pytest.mark.parametrize("scenario", ["A10", "A16"])
def test_an_ideal_run_gives_the_recorded_figures_to_the_last_digit(scenario: str, tmp_path: Path) -> None:
    now = run(tmp_path / "out", scenario, "--profile", "ideal")
    assert now == recorded("ideal")["metrics"][scenario], DUE


def test_a_commissioned_run_gives_the_recorded_figures_to_the_last_digit(tmp_path: Path) -> None:
    """On the parameters that the recorded commissioning found."""
    bench = recorded("bench")
    told = tmp_path / "params.toml"
    values = "".join(f"{name} = {value!r}\n" for name, value in bench["params"]["parameters"].items())
    told.write_text("[parameters]\n" + values, encoding="utf-8")
    assert run(tmp_path / "out", "A18b", "--params", str(told)) == bench["metrics"]["A18b"], DUE


def test_every_record_says_what_made_it() -> None:
    for path in DATA.glob("*.json"):
        content = json.loads(path.read_text(encoding="utf-8"))
        assert content["command"].startswith(("stillspin ", "make ")), path
        assert len(content["sources"]) == 16 or content["sources"] == "unknown", path
        assert content["figures"], path
