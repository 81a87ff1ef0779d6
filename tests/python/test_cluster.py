"""Campaigns on a Dask cluster: the same results as here, byte for byte, also when a worker is lost on the way."""

import functools
import json
import os
import signal
import sys
import threading
import time
from pathlib import Path

import distributed
import pytest
import typer
from typer.testing import CliRunner

from stillspin import cli
from stillspin.cases import profile
from stillspin.commands import type_test
from stillspin.drive import own
from stillspin.exit_codes import ExitCode
from stillspin.runs import cluster, execute, startup
from stillspin.runs.workers import Where

pytest.importorskip("stillspin._core", reason="the native module is not built")

REPRODUCE = "reproduce A18a --no-paper-scheme --no-nameplate --junit j.xml"
CAMPAIGNS = [
    REPRODUCE,
    "drift A18a --only flux",
    "explain A18a --profile bench --only cogging --no-alone --params told.toml",
    "startup-matrix --quick --way flying --junit j.xml",
    "type-test --no-commission --junit j.xml",
    "round-trips --runs 2 --no-commission --junit j.xml",
    "campaign --runs 4 --no-commission --json cases.json --junit j.xml",
]
IDEAL = ("--profile", "ideal")
CAMPAIGN = (*REPRODUCE.split(), *IDEAL, "--jobs", "1")
BOARDS = ("hil", "A14", "--check", "--port", "virtual", "--jobs", "1", "--json", "rows.json")
FEWER = 6  # of a matrix and a type test


@pytest.fixture(scope="module")
def two():
    """Two workers, each a process."""
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as made:
        yield made


def call(folder, monkeypatch, *words):
    folder.mkdir()
    monkeypatch.chdir(folder)
    done = CliRunner().invoke(cli.app, [*words])
    return done, {
        str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()
    }


def fewer(monkeypatch, place, name):
    """One of several of the tasks that this finds."""
    every = getattr(place, name)
    monkeypatch.setattr(place, name, lambda *arguments: every(*arguments)[::FEWER])


@pytest.mark.parametrize("campaign", CAMPAIGNS, ids=lambda words: words.partition(" ")[0])
def test_a_campaign_gives_the_same_files(campaign, two, tmp_path, monkeypatch):
    monkeypatch.setattr(execute.Outcome, "speed_ratio", 0.0)  # how fast a computer was, which the report says
    once = functools.cache(own.firmware)  # a second for each time that it is asked
    for module in [place for place in sys.modules.values() if getattr(place, "firmware", None) is own.firmware]:
        monkeypatch.setattr(module, "firmware", once)
    fewer(monkeypatch, startup, "chosen")
    fewer(monkeypatch, type_test.carry_out, "asked")
    told = tmp_path / "told.toml"
    told.write_text("[parameters]\nspeed_ramp = 2900\n")
    words = campaign.replace("told.toml", str(told)).split()
    words += ["--jobs", "1", *(() if "--profile" in words else IDEAL)]
    here, ours = call(tmp_path / "here", monkeypatch, *words)
    there, theirs = call(tmp_path / "there", monkeypatch, *words, "--cluster", two.scheduler_address)
    assert (there.exit_code, there.stdout, there.stderr) == (here.exit_code, here.stdout, here.stderr)
    assert here.exit_code in (ExitCode.DONE, ExitCode.SHORT), here.output
    assert len(ours) > 2 and ours.keys() == theirs.keys()
    assert {name for name in ours if ours[name] != theirs[name]} == set()


def test_every_command_that_takes_a_cluster_is_compared():
    commands = typer.main.get_command(cli.app).commands.items()
    takes = {name for name, command in commands if any("--cluster" in option.opts for option in command.params)}
    assert takes == {words.split()[0] for words in CAMPAIGNS} | {BOARDS[0]}


def test_a_worker_that_is_lost_is_no_loss(two):
    common, _ = startup.bench("bench")
    todo = list(startup.cases(1, True, True))[:24]
    victims = []

    def kill(_outcome):
        if not victims:
            with distributed.Client(two, set_as_default=False) as client:
                victims.extend(client.run(os.getpid).values())
            os.kill(victims[0], signal.SIGKILL)

    there = startup.run_all(common, todo, Where(1, two.scheduler_address), kill)
    assert victims
    assert there == startup.run_all(common, todo, Where(1), lambda _: None)


def test_a_board_in_the_loop_of_each_worker(two, tmp_path, monkeypatch):
    rows = []
    for name, more in (("here", ()), ("there", ("--cluster", two.scheduler_address))):
        done, files = call(tmp_path / name, monkeypatch, *BOARDS, *more)
        assert done.exit_code == 0, done.output
        found = json.loads(files["rows.json"])["runs"]
        rows.append(sorted(({**row, "seconds": 0.0} for row in found), key=lambda row: row["run"]))
    assert rows[0] == rows[1]


def test_an_interrupt_ends_what_the_workers_do(two, tmp_path, monkeypatch):
    main = threading.main_thread().ident
    threading.Timer(8.0, lambda: signal.pthread_kill(main, signal.SIGINT)).start()
    begin = time.monotonic()
    words = ("reproduce", "A15", "A16", "A17", "--no-commission", "--cluster", two.scheduler_address)
    done, files = call(tmp_path / "here", monkeypatch, *words)
    assert done.exit_code == 130
    assert files == {}
    assert time.monotonic() - begin < 60.0
    with distributed.Client(two, set_as_default=False) as client:
        end = time.monotonic() + 30.0
        while any(client.processing().values()):
            assert time.monotonic() < end
            time.sleep(0.2)


def test_what_cannot_be_used_is_said_in_one_line(two, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "_PATIENCE", 1.0)
    done, _ = call(tmp_path / "a", monkeypatch, *CAMPAIGN, "--cluster", "tcp://127.0.0.1:1")
    assert (done.exit_code, done.stderr.count("\n")) == (3, 1), done.stderr
    done, _ = call(tmp_path / "b", monkeypatch, *CAMPAIGN, "--cluster", "nonsense://x")
    assert (done.exit_code, done.stderr.count("\n")) == (2, 1), done.stderr
    monkeypatch.setattr(cluster, "_ours", lambda: "others")
    done, _ = call(tmp_path / "c", monkeypatch, *CAMPAIGN, "--cluster", two.scheduler_address)
    assert done.exit_code == 1
    assert "has other sources" in done.stderr
    done, _ = call(tmp_path / "d", monkeypatch, "hil", "A14", "--port", "/dev/none", "--cluster", two.scheduler_address)
    assert done.exit_code == 2


def test_a_cluster_without_workers_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "_PATIENCE", 2.0)
    with distributed.LocalCluster(n_workers=0, dashboard_address=None) as empty:
        done, _ = call(tmp_path / "a", monkeypatch, *CAMPAIGN, "--cluster", empty.scheduler_address)
    assert done.exit_code == 3
    assert "has no worker" in done.stderr


def test_a_profile_is_sent_along(two, tmp_path):
    """A worker reads no file of the computer where the campaign was started."""
    own = tmp_path / "own.toml"
    own.write_text((Path(profile.resources.directory("profiles")) / "ideal.toml").read_text(encoding="utf-8"))
    common, _ = startup.bench(str(own))
    own.unlink()
    todo = list(startup.cases(1, True, True))[:2]
    assert startup.run_all(common, todo, Where(1, two.scheduler_address), lambda _: None)
