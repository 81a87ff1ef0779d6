"""No test of `make test` is skipped without a name and a reason in the last lines."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import tally  # noqa: E402

MINIMAL = ROOT / "build/release/tests/firmware/firmware_test_minimal"
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


EDITION = """<testsuites><testsuite name="Scope">
<testcase name="Edges" status="run" result="{edges}" classname="Scope">{why}</testcase>
<testcase name="Wraps" status="run" result="skipped" classname="Scope">
<skipped message="a_test.cpp:3&#x0A;scope is not in this edition"/></testcase>
<testcase name="Runs" status="run" result="completed" classname="Scope"/>
<testcase name="Frame" status="run" result="skipped" classname="Can">
<skipped message="b_test.cpp:9&#x0A;can is not in this edition"/></testcase></testsuite></testsuites>
"""


def of_an_edition(where: Path, own: str, status: str = "run") -> list[str]:
    """What is said of an edition that wrote this itself."""
    file = where / "cpp.xml"
    file.write_text(
        f'<testsuite><testcase name="Edition.small" classname="Edition.small" status="{status}"/></testsuite>'
    )
    (where / "editions").mkdir()
    if own:
        (where / "editions" / "firmware_test_small.xml").write_text(own)
    return tally.lines([file])


def test_what_an_edition_skips_is_said_by_feature(tmp_path: Path) -> None:
    why = '<skipped message="c_test.cpp:1&#x0A;scope is not in this edition"/>'
    assert of_an_edition(tmp_path, EDITION.format(edges="skipped", why=why)) == [
        "skipped in Edition.small, 1 of 4: can is not in this edition: Can 1",
        "skipped in Edition.small, 2 of 4: scope is not in this edition: Scope 2",
        "1 passed, 0 failed, 3 skipped",
    ]


@pytest.mark.parametrize(("own", "status", "last"), [("", "run", "1 passed"), (EDITION, "fail", "0 passed, 1 failed")])
def test_an_edition_that_failed_or_wrote_nothing_is_one_case(tmp_path: Path, own: str, status: str, last: str) -> None:
    (said,) = of_an_edition(tmp_path, own, status)
    assert said.startswith(last)


@pytest.mark.skipif(not MINIMAL.is_file(), reason="the C++ tests are not built")
def test_what_the_smallest_edition_skips_is_said(tmp_path: Path) -> None:
    """The real program, as ctest runs it."""
    (tmp_path / "CTestTestfile.cmake").write_text(
        f'add_test(Edition.minimal "{MINIMAL}" --gtest_brief=1 "--gtest_filter=Hysteresis.*:Schedule.*")\n'
    )
    said = {"GTEST_OUTPUT": f"xml:{tmp_path}/editions/"}
    command = ["ctest", "--output-junit", "cpp.xml"]
    subprocess.run(command, cwd=tmp_path, env={**os.environ, **said}, capture_output=True, check=True)
    *skipped, last = tally.lines([tmp_path / "cpp.xml"])
    assert any(
        re.match(r"skipped in Edition.minimal, \d+ of \d+: hysteresis is not .*: Hysteresis \d+$", s) for s in skipped
    )
    assert not last.startswith(("0 ", "1 passed"))


def test_editions_run_apart_and_nothing_runs_twice_or_not_at_all() -> None:
    script = (ROOT / "toolchain" / "run-tests.sh").read_text(encoding="utf-8")
    assert re.findall(r"^(.*)cpp (-[ER]) '(.*?)'", script, re.MULTILINE) == [
        ("", "-E", r"^Edition\."),
        ('GTEST_OUTPUT="xml:$PWD/build/editions/" ', "-R", r"^Edition\."),
    ]


def test_results_that_are_not_there_are_said(tmp_path: Path) -> None:
    assert tally.lines([tmp_path / "none.xml"]) == [f"no results: {tmp_path}/none.xml", "0 passed, 0 failed, 0 skipped"]


def test_the_tally_is_the_last_thing_that_make_test_says() -> None:
    script = (ROOT / "toolchain" / "run-tests.sh").read_text(encoding="utf-8").splitlines()
    assert "tally.py" in script[-2]
    assert script[-1].startswith("exit ")
    assert "make test" in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()[-1]
