"""The bound of the interrupts' instructions fails where it is passed, or where a run shows that it does not hold.

Paths and counts are given: neither compiler nor emulator is needed. The paths themselves: test_paths.py.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import m3_bound  # noqa: E402
import m3_cost  # noqa: E402
from paths.bound import Way  # noqa: E402
from paths.facts import Facts  # noqa: E402

TURNING = ("observer turning", "flux turning", "paper turning")
LAST = len(m3_cost.STEPS) - 1


@dataclass
class Given:
    """A bound of 100 instructions for each step and 800 for all, 50 for a window's; runs that take as much."""

    most: int = 800
    cost: dict[str, int] = field(default_factory=dict)
    against: str = ""
    reached: tuple[str, ...] = ("control_isr", "memcpy")
    never: tuple[str, ...] = ("schedule_next",)

    def steps(self) -> list[int]:
        """Of each step, the last one the whole."""
        return [100] * LAST + [800]

    def table(self) -> m3_cost.Table:
        """What a run has taken."""
        worst = {f"turning {step}": most for step, most in zip(m3_cost.STEPS, self.steps(), strict=True)}
        worst["turning window"] = 50 + m3_bound.WINDOW_CALLER
        return {name: m3_cost.Cost(10, 50.0, cost) for name, cost in (worst | self.cost).items()}


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Given], int]:
    """The command with what is given."""
    monkeypatch.setattr(sys, "argv", ["m3_bound.py", "recorder", str(tmp_path)])

    def main(given: Given) -> int:
        facts = Facts(never=set(given.never), most=given.most)
        mode = m3_bound.Mode(facts, [Way(cost) for cost in given.steps()], [""] * (LAST + 1))
        modes = dict.fromkeys((*TURNING, *m3_bound.ALONE, *m3_bound.WINDOW_MODES), facts)
        window = SimpleNamespace(of_function=lambda _name: Way(50))
        reached = [SimpleNamespace(name=name) for name in given.reached]
        program = SimpleNamespace(taken_apart=lambda: reached)

        def record(_recorder: Path, out: Path, source: str, run: m3_cost.Run) -> Path:
            trace = out / f"{source} {run.name}"
            trace.touch()
            return trace

        changes: dict[str, Any] = {
            "read_program": lambda _image: program,
            "read_facts": lambda *_: modes,
            "bound_of": lambda *_: mode,
            "Bound": lambda *_: window,
            "Regions": lambda *_: None,
            "watch": lambda *_: (given.table(), given.against),
            "WATCHED": {"observer": ("600",)},
        }
        for name, value in changes.items():
            monkeypatch.setattr(m3_bound, name, value)
        monkeypatch.setattr(m3_cost, "missing_tools", list)
        monkeypatch.setattr(m3_cost, "build", lambda out: out / "replay.elf")
        monkeypatch.setattr(m3_cost, "record", record)
        return m3_bound.main()

    return main


def complaints_of(text: str) -> list[str]:
    """The lines behind the table and the runs."""
    lines = (line.removeprefix("isr-bound: ") for line in text.splitlines() if line.startswith("isr-bound: "))
    return [line for line in lines if not line.endswith(m3_bound.FACTS.name)]


def test_what_keeps_the_bound_passes(run: Callable[[Given], int], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(Given()) == 0
    out = capsys.readouterr().out
    assert "isr-bound: observer, 600 rpm: 0 contradictions to m3_paths.txt" in out
    assert "| observer turning |" in out
    assert complaints_of(out) == []


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (Given(most=799), "observer turning: 800 instructions, 799 are allowed"),
        (
            Given(cost={f"turning {m3_cost.STEPS[1]}": 101}),
            f"observer, 600 rpm: turning, {m3_cost.STEPS[1]}: 101 instructions, by the bound at most 100",
        ),
        (
            Given(cost={"turning window": 51 + m3_bound.WINDOW_CALLER}),
            f"observer, 600 rpm: a window's own interrupt: {51 + m3_bound.WINDOW_CALLER} instructions, by the bound at "
            "most 50",
        ),
        (Given(against="period 7: speed runs"), "observer, 600 rpm: period 7: speed runs"),
        (Given(reached=("control_isr", "__aeabi_ldivmod")), "an interrupt may call __aeabi_ldivmod"),
        (Given(reached=("control_isr", "sqrtf")), "an interrupt may call sqrtf"),
        (Given(never=("schedule_last",)), "m3_paths.txt: schedule_last is defined in no file"),
    ],
)
def test_what_passes_it_or_contradicts_it_is_caught(
    run: Callable[[Given], int], capsys: pytest.CaptureFixture[str], given: Given, said: str
) -> None:
    assert run(given) == 1
    assert said in complaints_of(capsys.readouterr().out)
