"""The count of the control interrupt's instructions fails where a budget or a charge is passed.

The counts are given: neither recorder nor emulator is needed.
"""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from isr import count  # noqa: E402


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[int, int], int]:
    """The command, where the worst period has 800 instructions, with a budget and the charge of a window."""
    budget, charges, trace = (tmp_path / name for name in ("budget.txt", "charges.h", "a.trace"))

    def record(_recorder: Path, _out: Path, _source: str, run: count.Run) -> Path:
        trace.write_text(run.name)
        return trace

    def replay(_image: Path, trace: Path) -> count.Table:
        worst = {"600": 800, "600, scope": 1600}.get(trace.read_text(), 700)
        return {f"turning {step}": count.Cost(10, 600.0, worst) for step in (*count.STEPS, "window")}

    changes = {"BUDGET": budget, "CHARGES": charges, "missing_tools": list, "record": record, "replay": replay}
    for name, value in changes.items():
        monkeypatch.setattr(count, name, value)
    monkeypatch.setattr(count, "build", lambda out: out / "replay.elf")
    monkeypatch.setattr(sys, "argv", ["count.py", "recorder", str(tmp_path)])

    def main(limit: int, charge: int) -> int:
        budget.write_text(f"# why\nobserver turning 900\npaper turning {limit}  # the worst of all its runs\n")
        worth = dict.fromkeys((*count.CHARGED, "CYCLES_SCOPE"), 1000) | {"CYCLES_WINDOW": charge}
        charges.write_text("".join(f"#define {name} {cycles}u\n" for name, cycles in worth.items()))
        return count.main()

    return main


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((800, 1000), []),
        ((799, 1000), ["isr-cost: paper, turning: 800 instructions, budget 799"]),
        ((800, 1101), ["isr-cost: charges.h: CYCLES_WINDOW is 1101 cycles, the count gives 1000"]),
        ((800, 899), ["isr-cost: charges.h: CYCLES_WINDOW is 899 cycles, the count gives 1000"]),
    ],
)
def test_count_beyond_a_budget_or_a_charge_is_caught(
    run: Callable[[int, int], int], capsys: pytest.CaptureFixture[str], given: tuple[int, int], said: list[str]
) -> None:
    assert run(*given) == len(said)
    assert [line for line in capsys.readouterr().out.splitlines() if line.startswith("isr-cost:")] == said


def test_the_counts_are_left_for_the_book(run: Callable[[int, int], int], tmp_path: Path) -> None:
    run(800, 1000)
    left = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
    assert left["observer"]["steps"]["turning all"]["worst"] == 800
    assert left["paper"]["runs"]["80"] == {"periods": 10, "mean": 600.0, "worst": 700}
