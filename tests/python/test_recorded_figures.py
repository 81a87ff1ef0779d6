"""Figures in README.md and the book are those of these sources: two scenarios run anew give the recorded ones."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("stillspin._core", reason="the native module is not built")

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import figures as renewal  # noqa: E402
import keep  # noqa: E402
from book import gather, records  # noqa: E402

DATA = ROOT / "docs/figures"
SEEDS = ((1.0, -3.0, 2.0), (50.0, None, None))
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
        assert all(len(part) == 16 for part in content["sources"].split("+")) or content["sources"] == "unknown", path
        assert content["figures"], path


def test_of_several_seeds_the_worst_is_kept_and_how_many_were_lost() -> None:
    each = [
        {"A10": {"peak": {"value": v, "unit": "deg"}, "dip": {"value": w, "unit": "rpm"}}}
        for v, w in zip(*SEEDS, strict=True)
    ]
    found = gather.worst(each)["A10"]
    assert found["peak"] == {"value": -3.0, "lost": 0, "unit": "deg"}
    assert found["dip"] == {"value": None, "lost": 2, "unit": "rpm"}


def test_a_command_with_several_seeds_runs_with_each(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    ran: list[list[str]] = []

    def run_command(words: list[str], **_: object) -> subprocess.CompletedProcess[str]:
        ran.append([str(word) for word in words[1:]])
        out = tmp_path / "two"
        out.mkdir(exist_ok=True)
        value = float(words[-3])
        metrics = {"scenarios": {"A10": {"peak": {"value": value, "unit": "deg"}}}}
        (out / "metrics.json").write_text(json.dumps(metrics), encoding="utf-8")
        return subprocess.CompletedProcess(words, 0)

    monkeypatch.setattr(renewal, "WORK", tmp_path)
    monkeypatch.setattr(renewal, "ROOT", tmp_path)
    monkeypatch.setattr(renewal.subprocess, "run", run_command)
    step = renewal.Step("two", "reproduce A10 --seed SEED --out OUT", seeds=2)
    assert renewal.carry_out(step)
    assert [words[-3] for words in ran] == ["1", "2"]
    record = records.load(tmp_path)["two"]
    assert record["figures"]["metrics"]["A10"]["peak"] == {"value": 2.0, "lost": 0, "unit": "deg"}


@pytest.fixture
def renewed(monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[int, list[str]]]:
    """`toolchain/figures.py` where commands only note that they ran: its exit status, and what ran in which order."""
    ran: list[str] = []
    kept = {step.name: {"command": f"stillspin {step.command}", "sources": "now"} for step in renewal.STEPS}
    kept |= {name: {"command": made.command, "sources": "now"} for name, made in records.COMMANDS.items()}

    def run(old: set[str], failing: str, *arguments: str) -> tuple[int, list[str]]:
        def carry_out(name: str) -> bool:
            ran.append(name)
            return name != failing

        monkeypatch.setattr(
            records, "load", lambda _: {k: v | {"sources": "old"} if k in old else v for k, v in kept.items()}
        )
        monkeypatch.setattr(records, "outdated", lambda _: {k: kept[k]["command"] for k in kept if k in old})
        monkeypatch.setattr(records, "sources_of", lambda *_: "now")
        monkeypatch.setattr(renewal, "render", lambda *_, **__: ())
        monkeypatch.setattr(renewal, "carry_out", lambda step: carry_out(step.name))
        monkeypatch.setattr(renewal, "carry_out_make", carry_out)
        monkeypatch.setattr(sys, "argv", ["figures.py", *arguments])
        return renewal.main(), ran

    return run


def test_what_is_fresh_is_left_out_and_a_failure_stops_nothing(renewed: Callable[..., tuple[int, list[str]]]) -> None:
    """In one run that nobody has to attend; of what takes hours nothing."""
    old = {"bench", "startup", "isr-cost", "prove", "mutants"}
    assert renewed(old, "startup", "--long") == (1, ["bench", "startup", "isr-cost", "prove"])


def test_what_takes_long_runs_where_it_is_asked_for(renewed: Callable[..., tuple[int, list[str]]]) -> None:
    assert renewed({"bench", "startup", "prove"}, "") == (0, ["bench"])


def test_what_is_named_runs_alone(renewed: Callable[..., tuple[int, list[str]]]) -> None:
    assert renewed({"bench", "mutants"}, "", "mutants", "drift") == (0, ["mutants"])


def test_records_of_older_sources_are_listed(
    renewed: Callable[..., tuple[int, list[str]]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert renewed({"prove"}, "", "--list") == (1, [])
    assert capsys.readouterr().out == "figures: prove was made from older sources; renew it: make prove\n"


def test_the_checks_that_take_long_end_with_the_figures_of_older_sources() -> None:
    """Where make runs it, a failure of the last line is one of `make verify`."""
    said = subprocess.run(
        ["make", "-n", "--no-print-directory", "verify"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert said.splitlines()[-1].endswith("toolchain/figures.py --list")


@pytest.mark.parametrize(("status", "writes", "kept"), [(0, True, 2), (1, True, 2), (1, False, 1), (0, False, 1)])
def test_what_a_command_measured_is_kept_even_when_it_is_beyond_its_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, status: int, writes: bool, kept: int
) -> None:
    """Of a command that ended before it had measured anything, the old record stays."""
    result = tmp_path / "result.json"
    result.write_text("1", encoding="utf-8")
    os.utime(result, (0, 0))
    monkeypatch.setattr(keep, "ROOT", tmp_path)
    monkeypatch.setattr(keep, "render", lambda *_, **__: ())
    monkeypatch.setitem(records.COMMANDS, "image", records.Made("make image-check", result.name, ("control",)))
    records.keep(tmp_path, "image", "make image-check", 1, "before")
    written = f"open({str(result)!r}, 'w').write('2')" if writes else "pass"
    assert keep.main("image", sys.executable, "-c", f"{written}; raise SystemExit({status})") == status
    record = records.load(tmp_path)["image"]
    assert record["figures"] == kept
    assert (record["sources"] == "before") is (status == 1 and not writes)
