"""Host in the loop, run after run: results that are kept, several virtual boards, and that none is left behind."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from typer.testing import CliRunner

from stillspin.cli import app
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.hil.results import Results, Row

pytest.importorskip("stillspin._core", reason="the native module is not built")


def test_results_are_kept_run_by_run(tmp_path):
    file = tmp_path / "results.json"
    results = Results(file)
    results.add(Row("A10", "creep", "ideal", True, "can", "r1", "aa", "aa", 10, 2.0))
    results.add(Row("A10", "creep", "ideal", True, "serial", "r1", lost="unplugged"))
    later = Results(file)
    later.add(
        Row(
            "A10",
            "creep",
            "ideal",
            True,
            "serial",
            "r2",
            "aa",
            "ab",
            10,
            2.0,
            step=9,
            words="x",
        )
    )
    later.add(Row("A10", "creep", "ideal", False, "serial", "r2", "aa", "aa", 5, 2.0))
    kept = Results(file).rows
    assert kept["A10", "creep", "ideal", True, "can"].identical
    assert kept["A10", "creep", "ideal", True, "can"].rate == 5.0
    assert not kept["A10", "creep", "ideal", True, "serial"].identical
    assert kept["A10", "creep", "ideal", False, "serial"].identical
    assert kept["A10", "creep", "ideal", True, "serial"].revision == "r2"
    file.write_text("[]")
    with pytest.raises(InputError, match="holds no results"):
        Results(file)


def test_virtual_boards_do_several_runs_at_a_time(tmp_path):
    file = tmp_path / "results.json"

    def call(*arguments):
        return CliRunner().invoke(app, ["hil", "A14", "--check", *arguments, "--json", str(file)])

    done = call("--can", "virtual", "--jobs", "2")
    assert done.exit_code == 0, done.output
    rows = json.loads(file.read_text())["runs"]
    assert {(row["run"], row["link"]) for row in rows} == {("avv", "can"), ("zvv", "can")}
    assert all(row["board"] == row["native"] and row["steps"] > 2000 for row in rows)
    again = call("--can", "virtual", "--resume")
    assert again.exit_code == 0, again.output
    assert again.stdout == ""
    refused = call("--port", "/dev/none", "--jobs", "2")
    assert refused.exit_code == 2
    assert "a board does one run at a time" in refused.stderr


def boards_of(directory):
    """The processes whose files lie there."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if str(directory).encode() in (process / "cmdline").read_bytes():
                found.append(process.name)
    return found


def test_whoever_ends_the_campaign_ends_its_boards(tmp_path):
    command = [sys.executable, "-m", "stillspin", "hil", "A10", "A11", "--can", "virtual", "--jobs", "2"]
    campaign = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "TMPDIR": str(tmp_path)}
    )
    assert wait_until(lambda: len(boards_of(tmp_path)) == 2, 60)
    campaign.terminate()
    _, said = campaign.communicate(timeout=60)
    assert campaign.returncode == 130
    assert said.strip().splitlines()[-1] == "stillspin: interrupted; what was finished before is kept"
    assert wait_until(lambda: boards_of(tmp_path) == [], 60)


def test_one_board_is_enough():
    done = CliRunner().invoke(app, ["hil", "A10", "--port", "/dev/a", "--can", "/dev/b"])
    assert done.exit_code != 0
