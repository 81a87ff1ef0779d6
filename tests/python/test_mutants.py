"""What is changed in the drive's C, in which sources, and how it is counted what the tests notice. No test runs."""

import sys
from pathlib import Path
from typing import cast

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import mutants  # noqa: E402
from mutation.board import FLOORS, Board, Program  # noqa: E402
from mutation.mutate import Mutant  # noqa: E402
from mutation.mutate import mutants as mutants_of  # noqa: E402

# What the images alone have, and what calls TI's flash library: no C++ test has them.
WITHOUT_MUTANTS = {
    *("firmware/boot/image/main.c", "firmware/flash_kernel/image/main.c", "firmware/lamp/image/main.c"),
    *("hal/f2808/flash.c", "hal/f2808/image/ram_code.c", "hal/f2808/image/kernel_identity.c"),
    "hal/f2808/image/no_replay.c",
}


def changed(source: str) -> set[str]:
    """The sources that one change makes."""
    return {mutant.applied(source) for mutant in mutants_of("x.c", source)}


@pytest.mark.parametrize(
    ("source", "wanted"),
    [
        ("int f(int a) { return a < 3; }", {"a <= 3", "a > 3", "a < 4", "a < 2"}),
        ("int f(int a) { return a && !g; }", {"a || !g", "a && g"}),
        ("void f(void) { if (a) b(); }", {"if (!(a)) b();", "if (a) ;"}),
        ("void f(void) { a = 5000; }", {"a = 5312;", "a = 4688;", "{ ; }"}),
        ("#define A (2 + b)\n", {"(2 - b)", "(3 + b)", "(1 + b)"}),
    ],
)
def test_one_token_one_constant_or_one_statement_is_changed(source: str, wanted: set[str]) -> None:
    made = changed(source)
    assert len(made) == len(wanted)
    assert all(any(piece in text for text in made) for piece in wanted)


def test_what_the_compiler_does_not_see_is_not_changed() -> None:
    assert changed('// a + 1\n#include "b/c.h"\nconst char t[] = "1 + 2"; /* < */\n') == set()


def test_every_source_of_the_drive_is_in_one_part() -> None:
    named = [file for part in mutants.PARTS.values() for file in part.files if file.endswith(".c")]
    assert len(named) == len(set(named))
    every = {path.relative_to(ROOT).as_posix() for floor in FLOORS for path in (ROOT / floor).rglob("*.c")}
    assert every - set(named) == WITHOUT_MUTANTS


def test_a_score_has_wilsons_interval() -> None:
    score = mutants.Score(40, distinct=10, killed={"a_test": 9}, invalid=10)
    assert score.line("x").split()[:8] == ["x", "9", "/", "10", "90.0", "%", "[59.6,", "98.2]"]
    assert score.mutants == 20
    left = score.published()
    assert (left["noticed"], left["of"], round(left["low"], 1), round(left["high"], 1)) == (9, 10, 59.6, 98.2)


def test_parts_together_weigh_as_much_as_they_have_mutants() -> None:
    large = mutants.Score(300, distinct=10, killed={"a_test": 10})
    small = mutants.Score(100, distinct=10, killed={"a_test": 5})
    # 9/16 of 12/14 * 2/14 / 14 and 1/16 of 7/14 * 7/14 / 14 are 0.078^2 together, times 1.96
    wanted = ["these", "2", "87.5", "%", "+-15.2", "of", "some", "400", "mutants"]
    assert mutants.of_all([large, small]).split() == wanted


@pytest.mark.parametrize(
    ("links", "fails", "verdict"),
    [
        ({"near", "far"}, set(), "survived"),
        ({"near", "far"}, {"far"}, "killed far"),
        ({"far"}, {"far"}, "killed far"),  # near has not what the source needs
        ({"near", "far"}, {"near", "far"}, "killed near"),
        (set(), {"near"}, "unlinked"),
    ],
)
def test_a_program_that_does_not_link_is_passed_over(
    links: set[str], fails: set[str], verdict: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    board = Board(programs={name: Program(name, []) for name in ("near", "far")})
    run = mutants.Run.__new__(mutants.Run)
    run.board = board
    objects = {"x.c": tmp_path / "x.o"}
    monkeypatch.setattr(mutants.Run, "objects", lambda *_: objects)
    monkeypatch.setattr(mutants, "linked", lambda _board, name, _changed, _out: name in links)
    monkeypatch.setattr(mutants, "passes", lambda out, _limit: out.name not in fails)
    mutant, part = cast(Mutant, None), cast(mutants.Part, None)
    assert run.run_in(mutant, part, ("near", "far"), tmp_path) == verdict
