"""When a reading of planted defects ends early: not before every function has shown its own."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from proof.shown import Shown, places_of  # noqa: E402

SOURCE = """static int32_t doubled(int32_t x);

static int32_t twice(int32_t x) {
  return x + x;
}

static int32_t doubled(int32_t x) { return twice(x); }

int32_t long_one(int32_t first,
                 int32_t second) {
  return doubled(first) + second;
}
"""
AT = {"twice": 4, "doubled": 7, "long_one": 11}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    (tmp_path / "a.c").write_text(SOURCE, encoding="utf-8")
    return tmp_path


def alarm(line: int, message: str = "signed overflow. assert x + x <= 2147483647;", file: str = "a.c") -> list[str]:
    """As EVA says it."""
    return [f"[eva:alarm] {file}:{line}: Warning: \n", f"  {message}\n"]


def is_complete(tree: Path, said: list[str], *functions: str) -> bool:
    """After all of that."""
    shown = Shown(tree, ["a.c"], functions)
    return any(shown.is_complete_with(line) for line in [*said, "[eva] done\n"])


@pytest.mark.parametrize(
    ("function", "first", "last"), [("twice", 3, 5), ("doubled", 7, 7), ("long_one", 9, 12), ("no_one", 0, 0)]
)
def test_functions_are_found_where_they_are_defined(tree: Path, function: str, first: int, last: int) -> None:
    assert list(places_of(function, tree, ["a.c"])) == ([("a.c", first, last)] if last else [])


@pytest.mark.parametrize("function", AT)
def test_an_alarm_shows_its_own_function_alone(tree: Path, function: str) -> None:
    said = alarm(AT[function])
    assert is_complete(tree, said, function)
    assert not any(is_complete(tree, said, other) for other in AT if other != function)
    assert not is_complete(tree, alarm(AT[function], file="b.c"), function)


def test_every_function_has_to_show_one(tree: Path) -> None:
    assert not is_complete(tree, alarm(4), "twice", "doubled")
    assert is_complete(tree, alarm(4) + alarm(7), "twice", "doubled")
    on_one_line = ["[eva:alarm] a.c:4: Warning: assertion got status unknown.\n"]
    assert is_complete(tree, on_one_line + alarm(7), "twice", "doubled")


def test_what_a_call_needs_or_gives_counts_at_the_end_alone(tree: Path) -> None:
    assert not is_complete(tree, alarm(4, "function f: precondition got status unknown."), "twice")
    assert not is_complete(tree, alarm(4, "function f: postcondition got status unknown."), "twice")


def test_a_goal_that_is_not_proved_shows_its_function(tree: Path) -> None:
    def goal(verdict: str) -> list[str]:
        return [f"[wp] [Z3 4.8.12] Goal typed_twice_ensures_2 : {verdict}\n"]

    assert is_complete(tree, goal("Timeout (30s)"), "twice")
    assert is_complete(tree, goal("Failed"), "twice")
    assert not is_complete(tree, goal("Valid (Qed:2ms)"), "twice")
    assert not is_complete(tree, goal("Timeout (30s)"), "doubled")


def test_a_reading_without_defects_is_never_ended(tree: Path) -> None:
    assert not is_complete(tree, alarm(4))
