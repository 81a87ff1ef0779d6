"""No test of `make test` is skipped without a name and a reason in the last lines."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import tally  # noqa: E402

PYTHON = """
import pytest
def test_good(): pass
def test_bad(): assert False
@pytest.mark.skip(reason="no such kernel")
def test_left_out(): pass
@pytest.mark.parametrize("way", [1, 2])
def test_no_way(way): pytest.skip(f"way {way} is closed")
"""
MODULE = 'import pytest\npytest.importorskip("no_such_module", reason="not built")\ndef test_more(): pass\n'


def test_what_pytest_skips_is_named_with_its_reason(tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(PYTHON)
    (tmp_path / "test_b.py").write_text(MODULE)
    file = tmp_path / "python.xml"
    command = [sys.executable, "-m", "pytest", "-q", "--rootdir", ".", "-n", "2", f"--junit-xml={file}", "."]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    *skipped, last = tally.lines([file])
    assert len(skipped) == 4
    assert "skipped: test_a::test_left_out: no such kernel" in skipped
    assert "skipped: test_a::test_no_way[2]: way 2 is closed" in skipped
    assert any("test_b" in line and "not built" in line for line in skipped)
    assert last == "1 passed, 1 failed, 4 skipped"


@pytest.mark.skipif(shutil.which("ctest") is None, reason="no ctest is installed")
def test_what_ctest_skips_is_named(tmp_path: Path) -> None:
    (tmp_path / "CTestTestfile.cmake").write_text(
        'add_test(good true)\nadd_test(bad false)\nadd_test(Board.Unplugged sh -c "echo Skipped; exit 9")\n'
        "set_tests_properties(Board.Unplugged PROPERTIES SKIP_RETURN_CODE 9)\n"
        "add_test(off true)\nset_tests_properties(off PROPERTIES DISABLED TRUE)\n"
    )
    file = tmp_path / "cpp.xml"
    subprocess.run(["ctest", "--output-junit", str(file)], cwd=tmp_path, capture_output=True, check=False)
    *skipped, last = tally.lines([file])
    assert [line.split(":")[1].strip() for line in skipped] == ["Board.Unplugged", "off"]
    assert last == "1 passed, 1 failed, 2 skipped"


def test_results_that_are_not_there_are_said(tmp_path: Path) -> None:
    assert tally.lines([tmp_path / "none.xml"]) == [f"no results: {tmp_path}/none.xml", "0 passed, 0 failed, 0 skipped"]


def test_the_tally_is_the_last_thing_that_make_test_says() -> None:
    script = (ROOT / "toolchain" / "run-tests.sh").read_text(encoding="utf-8").splitlines()
    assert "tally.py" in script[-2]
    assert script[-1].startswith("exit ")
    assert "make test" in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()[-1]
