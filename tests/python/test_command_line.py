"""The command line: exit status, one line for what is wrong, results that appear whole or not at all."""

import json
import os
import re
import subprocess
import sys

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import fake_core
from stillspin import cli
from stillspin.report import output
from stillspin.runs import records


def left_over(directory):
    return sorted(path.name for path in directory.iterdir())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("run", "A1O"), "there is no scenario 'A1O'; did you mean 'A1"),
        (("run",), "Missing argument"),
        (("run", "A10", "--profile", "bnch"), "did you mean 'bench'"),
        (("run", "A10", "--profile", "none.toml"), "no such file"),
        (("run", "A10", "--set", "adc.nose=1"), "did you mean 'noise'"),
        (("run", "A10", "--set", "adc.noise=500"), "0 … 100 LSB"),
        (("run", "A10", "--set", "speed_ramp"), "section.entry=value"),
        (("run", "A10", "--seed", "x"), "--seed: 'x' is no number; 0 … 4294967295"),
        (("run", "A10", "--seed", "-1"), "--seed: -1 is out of range"),
        (("run", "A10", "--sede", "1"), "No such option"),
        (("reproduce", "A10", "A99"), "there is no scenario 'A99'"),
        (("reproduce", "A10", "--jobs", "0"), "--jobs: 0 is out of range; 1 … 256"),
        (("reprod",), "Did you mean 'reproduce'"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing_behind(call, tmp_path, arguments, said):
    result = call(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr
    assert result.stderr.startswith("stillspin: ")
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert left_over(tmp_path) == []


def test_a_virtual_drive_that_is_not_installed_is_said_in_one_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "stillspin._core", None)
    result = CliRunner().invoke(cli.app, ["run", "A10"])
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "pip install --find-links dist 'stillspin[virtual]'" in result.stderr


def test_a_run_writes_the_report_the_figures_and_a_record(call, tmp_path):
    result = call("run", "a10", "--seed", 5, "--set", "adc.noise=0.5", "--out", "here")
    assert result.exit_code == 0, result.stderr
    assert "position_error_peak" in result.stdout
    assert left_over(tmp_path) == ["here"]
    assert left_over(tmp_path / "here") == ["metrics.json", "report.html", "runs"]
    assert left_over(tmp_path / "here" / "runs") == ["A10-creep.parquet"]
    about = records.read(tmp_path / "here" / "runs" / "A10-creep.parquet").about
    assert (about["seed"], about["profile"], about["changes"]) == (5, "bench", ["adc.noise=0.5"])
    assert about["plant"]["adc"]["noise"] == 0.5
    assert about["firmware"] == fake_core.FIRMWARE


def test_columns_of_a_record_carry_their_units(call, tmp_path):
    assert call("run", "A10", "--no-plots").exit_code == 0
    schema = pq.read_schema(tmp_path / "results-A10" / "runs" / "A10-creep.parquet")
    assert schema.field("true_speed").metadata == {b"unit": b"rpm"}
    assert schema.field("time").type == "double"


def test_without_plots_nothing_is_drawn(call, tmp_path):
    assert call("run", "A10", "--no-plots").exit_code == 0
    assert "<img" not in (tmp_path / "results-A10" / "report.html").read_text(encoding="utf-8")


def test_a_profile_from_a_file_gives_the_report_its_name(call, tmp_path):
    (tmp_path / "mine.toml").write_text("[adc]\nnoise = 0.0\n", encoding="utf-8")
    assert call("run", "A10", "--profile", "mine.toml", "--no-plots", "--out", "r").exit_code == 0
    metrics = json.loads((tmp_path / "r" / "metrics.json").read_text(encoding="utf-8"))
    assert metrics["profile"] == "mine"
    assert metrics["scenarios"]["A10"]["position_error_peak"]["goal"] == 0.8


def test_a_fault_breaks_the_run_off_and_the_results_say_so(call, tmp_path):
    result = call("run", "A10", "--set", "inverter.dead_short=true", "--out", "r")
    assert result.exit_code == 1
    assert "A10, run creep: broken off: over-current at 0.100 s" in result.stderr
    metrics = json.loads((tmp_path / "r" / "metrics.json").read_text(encoding="utf-8"))
    assert metrics["scenarios"]["A10"]["position_error_peak"]["value"] is None
    assert metrics["scenarios"]["A10"]["position_error_peak"]["met"] is False
    assert "over-current at 0.100 s" in (tmp_path / "r" / "report.html").read_text(encoding="utf-8")


def test_a_shaft_that_does_not_turn_breaks_the_run_off(call):
    result = call("run", "A10", "--no-plots", "--set", "friction=99")
    assert result.exit_code == 1
    assert "the shaft turned at 0.0 rpm" in result.stderr


def test_an_exception_of_the_native_module_breaks_the_run_off(call, core, monkeypatch):
    def fails(**_):
        raise RuntimeError("the solver gave up\nat 0.3 s")

    monkeypatch.setattr(core, "run", fails)
    result = call("run", "A10")
    assert result.exit_code == 1
    assert "broken off: the solver gave up at 0.3 s" in result.stderr


def test_a_programming_error_leaves_no_results(call, core, tmp_path, monkeypatch):
    def broken(**_):
        raise KeyError("a bug")

    monkeypatch.setattr(core, "run", broken)
    with pytest.raises(KeyError):
        CliRunner().invoke(cli.app, ["run", "A10", "--out", str(tmp_path / "r")], catch_exceptions=False)
    assert left_over(tmp_path) == []


def test_an_interrupt_is_said_and_leaves_nothing(call, core, tmp_path, monkeypatch):
    def interrupted(**_):
        raise KeyboardInterrupt

    monkeypatch.setattr(core, "run", interrupted)
    result = call("run", "A10")
    assert (result.exit_code, result.stderr) == (130, "stillspin: interrupted; what was finished before is kept\n")
    assert left_over(tmp_path) == []


def test_earlier_results_are_replaced_as_a_whole(call, tmp_path):
    assert call("run", "A11", "--no-plots", "--out", "r").exit_code == 0
    assert call("run", "A10", "--no-plots", "--out", "r").exit_code == 0
    assert left_over(tmp_path / "r" / "runs") == ["A10-creep.parquet"]
    assert left_over(tmp_path) == ["r"]


def test_nothing_but_earlier_results_is_replaced(call, tmp_path):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.tex").write_text("all my work", encoding="utf-8")
    result = call("run", "A10", "--out", "thesis")
    assert (result.exit_code, left_over(tmp_path / "thesis")) == (2, ["chapter.tex"])
    assert "holds other things" in result.stderr
    assert call("run", "A10", "--out", "thesis/chapter.tex").exit_code == 2
    assert call("run", "A10", "--out", ".").exit_code == 2


def test_an_interrupted_campaign_leaves_the_earlier_results(tmp_path):
    target = tmp_path / "r"
    with output.fresh_directory(target) as directory:
        (directory / output.MARK).write_text("first", encoding="utf-8")
    with pytest.raises(KeyboardInterrupt), output.fresh_directory(target) as directory:
        (directory / output.MARK).write_text("half", encoding="utf-8")
        raise KeyboardInterrupt
    assert (target / output.MARK).read_text(encoding="utf-8") == "first"
    assert left_over(tmp_path) == ["r"]


def test_list_params_and_version_print_what_there_is(call):
    listed = call("list").stdout
    assert all(word in listed for word in ("A10", "A18c", "Fig. 16", "bench", "ideal"))
    assert "speed_ramp" in call("params").stdout
    version, drive = call("version").stdout.splitlines()
    assert version.startswith("stillspin 0.1.0")
    assert re.match(r"virtual drive: stillspin \w+ \(edition \w+, board ", drive)
    assert drive.endswith("; STILLSPIN_EDITION chooses another edition: drive, hil, minimal")


def test_version_names_the_edition_in_use(call, monkeypatch):
    monkeypatch.setenv("STILLSPIN_EDITION", "hil")
    _, drive = call("version").stdout.splitlines()
    assert drive.endswith("; STILLSPIN_EDITION chooses another edition: lab, drive, minimal")


def test_the_same_seed_gives_the_same_bytes(call, tmp_path):
    for name in ("first", "again"):
        assert call("run", "A18a", "--seed", 3, "--out", name).exit_code == 0
    call("run", "A18a", "--seed", 4, "--out", "other")
    first, again, other = (tmp_path / name for name in ("first", "again", "other"))
    for file in ("metrics.json", "runs/A18a-pi.parquet"):
        assert (first / file).read_bytes() == (again / file).read_bytes()
        assert (first / file).read_bytes() != (other / file).read_bytes()


def test_worker_processes_give_the_same_results_as_one(fake_tree, tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(fake_tree)}
    for jobs in ("1", "2"):
        command = [
            sys.executable,
            "-m",
            "stillspin",
            "reproduce",
            "A18a",
            "A10",
            "--jobs",
            jobs,
            "--out",
            f"jobs{jobs}",
        ]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""
    one, two = ((tmp_path / name / "metrics.json").read_text(encoding="utf-8") for name in ("jobs1", "jobs2"))
    assert one == two
    assert list(json.loads(one)["scenarios"]) == ["A18a", "A10"]


def test_a_worker_that_dies_is_said_in_one_line(fake_tree, tmp_path):
    poisoned = tmp_path / "tree"
    poisoned.mkdir()
    (poisoned / "sitecustomize.py").write_text(
        "import sys, os\nif 'multiprocessing.spawn' in ' '.join(sys.orig_argv):\n    os._exit(9)\n", encoding="utf-8"
    )
    environment = {**os.environ, "PYTHONPATH": f"{poisoned}{os.pathsep}{fake_tree}"}
    command = [sys.executable, "-m", "stillspin", "reproduce", "A10", "--jobs", "2", "--out", "r"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith("stillspin: a worker process died")
    assert left_over(tmp_path) == ["tree"]
