"""The coverage of decisions fails where a condition is not covered, or the list of unreachable ones is wrong.

What clang counts is given: no test runs.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import mcdc  # noqa: E402

CODE = """int f(int a, int b) {
  if (a) return 1;
  return a && b;
}
"""


def export(file: Path, false: int, decides: bool) -> dict[str, Any]:
    """What llvm-cov says: how often the first condition was false, and whether the last was seen to decide."""
    branches = [
        [2, 7, 2, 8, 5, false, 0, 0, 4],
        [3, 10, 3, 11, 5, 5, 0, 0, mcdc.OF_SEVERAL],
        [3, 15, 3, 16, 5, 5, 0, 0, mcdc.OF_SEVERAL],
    ]
    records = [[3, 10, 3, 16, 1, 0, 0, 0, 5, [True, decides]]]
    function = {"name": "x.c:f", "filenames": [str(file)], "branches": branches, "mcdc_records": records}
    return {
        "functions": [function],
        "files": [{"filename": str(file), "summary": {"lines": {"count": 4, "covered": 4}}}],
    }


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[int, bool, str], int]:
    """The command, with counts and a line of the list."""
    file, unreachable = tmp_path / "hal/x.c", tmp_path / "list.txt"
    file.parent.mkdir()
    file.write_text(CODE)
    for name, value in (("ROOT", tmp_path), ("BUILD", tmp_path), ("UNREACHABLE", unreachable)):
        monkeypatch.setattr(mcdc, name, value)
    monkeypatch.setattr(mcdc, "tools", lambda: ("clang", "profdata", "cov", tmp_path))
    monkeypatch.setattr(sys, "argv", ["mcdc.py", "--report"])

    def main(false: int, decides: bool, listed: str) -> int:
        unreachable.write_text(f"# file | function | condition | reason\n{listed}\n")
        monkeypatch.setattr(mcdc, "export", lambda _: export(file, false, decides))
        return mcdc.main()

    return main


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ((5, True, ""), []),
        ((0, True, ""), ["mcdc: hal/x.c:2:7 f: a: never false"]),
        ((5, False, ""), ["mcdc: hal/x.c:3:15 f: b: never alone decides"]),
        ((5, False, "hal/x.c | f | b | why"), []),
        ((5, True, "hal/x.c | f | b | why"), ["mcdc: list.txt: hal/x.c, f: b: is covered"]),
        ((5, True, "hal/x.c | f | c | why"), ["mcdc: list.txt: hal/x.c, f: c: there is no such condition"]),
    ],
)
def test_condition_that_is_not_covered_is_caught(
    run: Callable[[int, bool, str], int],
    capsys: pytest.CaptureFixture[str],
    given: tuple[int, bool, str],
    said: list[str],
) -> None:
    assert run(*given) == len(said)
    assert [line for line in capsys.readouterr().out.splitlines() if line.startswith("mcdc:")] == said
