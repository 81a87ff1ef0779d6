"""Records of older sources count as today's where a part of each, run anew, has its figures to the last digit."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import figures as renewal  # noqa: E402
from book import probes, records  # noqa: E402

ALONE = renewal.Step("alone", "reproduce A10 A11 --out OUT")
LONG = renewal.Step("long", "startup-matrix --out OUT")
SEEDS = renewal.Step("seeds", "reproduce A10 --seed SEED --out OUT", seeds=5)
PEAK = {"peak": {"value": 1.25, "unit": "deg"}}


@pytest.mark.parametrize(
    ("command", "probe"),
    [
        ("reproduce --no-nameplate --out OUT", "reproduce A16 --no-nameplate --out OUT"),
        ("reproduce --motor B --out OUT", "reproduce B17 --motor B --out OUT"),
        ("reproduce A18a A15 --scheme paper --out OUT", "reproduce A18a --scheme paper --out OUT"),
        (SEEDS.command, ""),
        ("drift --out OUT", ""),
    ],
)
def test_a_probe_is_the_command_with_one_scenario_of_it(command: str, probe: str) -> None:
    assert probes.probe_of(command) == probe


def test_each_step_whose_scenarios_can_be_told_apart_has_a_probe() -> None:
    without = {step.name for step in renewal.STEPS if not probes.probe_of(step.command)}
    assert {name for name in without if not name.startswith(("hil-", "papers-trips-", "trips-", "papers-seeds-"))} == {
        "commission",
        "drift",
        "explain",
        "startup",
        "type-test",
    }


@pytest.fixture
def confirmed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., tuple[bool, dict[str, Any]]]:
    """`confirm` of three records of sources "a = 1" after these were changed; runs give `peak`."""
    source = tmp_path / "control/a.c"
    source.parent.mkdir()
    source.write_text("a = 1\n", encoding="utf-8")
    steps = [ALONE, LONG, SEEDS]
    for step in steps:
        records.keep(tmp_path, step.name, f"stillspin {step.command}", {"metrics": {"A10": PEAK, "A11": PEAK}})
    source.write_text("a = 2\n", encoding="utf-8")
    monkeypatch.setattr(renewal, "ROOT", tmp_path)

    def confirm(peak: float, *others: str) -> tuple[bool, dict[str, Any]]:
        figures = {"metrics": {"A10": {"peak": {"value": peak, "unit": "deg"}}}}
        monkeypatch.setattr(renewal, "_run", lambda *_, **__: (0, figures))
        return renewal.confirm([step for step in steps if step.name not in others]), records.load(tmp_path)

    return confirm


def test_what_does_as_before_is_confirmed_and_says_of_what_it_was_made(
    confirmed: Callable[..., tuple[bool, dict[str, Any]]],
) -> None:
    done, kept = confirmed(1.25)
    assert done
    for name in ("alone", "long", "seeds"):
        assert kept[name]["made_of"] != kept[name]["sources"]
    assert records.outdated(renewal.ROOT) == {}
    again = json.loads((renewal.ROOT / records.FOLDER / "long.json").read_text(encoding="utf-8"))
    assert again["figures"]["metrics"]["A11"] == PEAK


def test_the_last_digit_of_one_probe_holds_back_all_records_of_its_sources(
    confirmed: Callable[..., tuple[bool, dict[str, Any]]], capsys: pytest.CaptureFixture[str]
) -> None:
    done, kept = confirmed(1.2500000000000002)
    assert not done
    assert all("made_of" not in record for record in kept.values())
    assert "alone has other figures now" in (said := capsys.readouterr().out)
    assert "long is of older sources still; renew it: toolchain/figures.py long" in said


def test_nothing_is_confirmed_where_no_probe_vouches_for_it(
    confirmed: Callable[..., tuple[bool, dict[str, Any]]],
) -> None:
    done, kept = confirmed(1.25, "alone")
    assert not done
    assert all("made_of" not in record for record in kept.values())


def test_a_record_of_yet_other_sources_is_not_vouched_for(
    confirmed: Callable[..., tuple[bool, dict[str, Any]]],
) -> None:
    path = renewal.ROOT / records.FOLDER / "long.json"
    path.write_text(path.read_text(encoding="utf-8").replace('"sources": "', '"sources": "0'), encoding="utf-8")
    done, kept = confirmed(1.25)
    assert not done
    assert "made_of" in kept["alone"]
    assert "made_of" not in kept["long"]


def test_other_sources_beside_those_of_the_runs_are_not_vouched_for(
    confirmed: Callable[..., tuple[bool, dict[str, Any]]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(records.BESIDE, "long", ("sim_host/stillspin/long",))
    done, kept = confirmed(1.25)
    assert not done
    assert "made_of" not in kept["long"]
