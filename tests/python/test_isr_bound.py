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

from isr import bound, count  # noqa: E402
from isr.paths.bound import Way  # noqa: E402
from isr.paths.facts import Facts  # noqa: E402

TURNING = ("observer turning", "flux turning", "paper turning")
LAST = len(count.STEPS) - 1


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

    def table(self) -> count.Table:
        """What a run has taken."""
        worst = {f"turning {step}": most for step, most in zip(count.STEPS, self.steps(), strict=True)}
        worst["turning window"] = 50 + bound.WINDOW_CALLER
        return {name: count.Cost(10, 50.0, cost) for name, cost in (worst | self.cost).items()}


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[Given], int]:
    """The command with what is given."""
    monkeypatch.setattr(sys, "argv", ["bound.py", "recorder", str(tmp_path)])

    def main(given: Given) -> int:
        facts = Facts(never=set(given.never), most=given.most)
        mode = bound.Mode(facts, [Way(cost) for cost in given.steps()], [""] * (LAST + 1))
        modes = dict.fromkeys((*TURNING, *bound.ALONE, *bound.WINDOW_MODES), facts)
        window = SimpleNamespace(of_function=lambda _name: Way(50))
        reached = [SimpleNamespace(name=name) for name in given.reached]
        program = SimpleNamespace(taken_apart=lambda: reached)

        def record(_recorder: Path, out: Path, source: str, run: count.Run) -> Path:
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
            monkeypatch.setattr(bound, name, value)
        monkeypatch.setattr(count, "missing_tools", list)
        monkeypatch.setattr(count, "build", lambda out: out / "replay.elf")
        monkeypatch.setattr(count, "record", record)
        return bound.main()

    return main


def complaints_of(text: str) -> list[str]:
    """The lines behind the table and the runs."""
    lines = (line.removeprefix("isr-bound: ") for line in text.splitlines() if line.startswith("isr-bound: "))
    return [line for line in lines if not line.endswith(bound.FACTS.name)]


def test_what_keeps_the_bound_passes(run: Callable[[Given], int], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(Given()) == 0
    out = capsys.readouterr().out
    assert "isr-bound: observer, 600 rpm: 0 contradictions to facts.txt" in out
    assert "| observer turning |" in out
    assert complaints_of(out) == []


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (Given(most=799), "observer turning: 800 instructions, 799 are allowed"),
        (
            Given(cost={f"turning {count.STEPS[1]}": 101}),
            f"observer, 600 rpm: turning, {count.STEPS[1]}: 101 instructions, by the bound at most 100",
        ),
        (
            Given(cost={"turning window": 51 + bound.WINDOW_CALLER}),
            f"observer, 600 rpm: a window's own interrupt: {51 + bound.WINDOW_CALLER} instructions, by the bound at "
            "most 50",
        ),
        (Given(against="period 7: speed runs"), "observer, 600 rpm: period 7: speed runs"),
        (Given(reached=("control_isr", "__aeabi_ldivmod")), "an interrupt may call __aeabi_ldivmod"),
        (Given(reached=("control_isr", "sqrtf")), "an interrupt may call sqrtf"),
        (Given(never=("schedule_last",)), "facts.txt: schedule_last is defined in no file"),
    ],
)
def test_what_passes_it_or_contradicts_it_is_caught(
    run: Callable[[Given], int], capsys: pytest.CaptureFixture[str], given: Given, said: str
) -> None:
    assert run(given) == 1
    assert said in complaints_of(capsys.readouterr().out)
