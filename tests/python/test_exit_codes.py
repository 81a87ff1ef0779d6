"""Every command ends with the status that the book's table says: one table, and no traceback for what users cause."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer

from stillspin import cli
from stillspin.drive import Drive
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import DifferentError, LinkError, NoAnswerError, RefusedError

BOOK = Path(__file__).resolve().parents[2] / "docs" / "command-line.md"
NOBODY = "/dev/none"
TALKS = {
    "params dump": ("params", "dump", "--drive", NOBODY),
    "params diff": ("params", "diff", "defaults", "--drive", NOBODY),
    "params load": ("params", "load", "x.toml", "--drive", NOBODY),
    "console": ("console", "-c", "status", "--drive", NOBODY),
    "scope": ("scope", "speed", "--drive", NOBODY),
    "monitor": ("monitor", "--drive", NOBODY),
    "tune": ("tune", "--no-open", "--drive", NOBODY),
    "version": ("version", "--drive", NOBODY),
}
"""Commands that open a drive with Drive.open."""
BAD = {
    "run": ("run", "A99"),
    "reproduce": ("reproduce", "A99"),
    "drift": ("drift", "A99"),
    "explain": ("explain", "A99"),
    "commission": ("commission", "--profile", "bnch"),
    "board": ("board", "--profile", "bnch"),
    "startup-matrix": ("startup-matrix", "--way", "sideways"),
    "type-test": ("type-test", "none.toml"),
    "round-trips": ("round-trips", "--runs", "0"),
    "campaign": ("campaign", "--motors", "A,"),
    "params dump": ("params", "dump"),
    "params diff": ("params", "diff", "defaults"),
    "params load": ("params", "load", "x.toml"),
    "console": ("console",),
    "scope": ("scope", "speed=fast", "--drive", NOBODY),
    "monitor": ("monitor", "--duration", "-1"),
    "can": ("can", NOBODY),
    "tune": ("tune", "--port", "70000", "--drive", NOBODY),
    "hil": ("hil", "A99", "--port", NOBODY),
    "flash": ("flash", "none.out"),
    "image show": ("image", "show", "none.out"),
    "image time": ("image", "time", "none.out"),
    "demo-image": ("demo-image", "/dev/null/demo"),
    "loader": ("loader", "flash.bin", "--kernel", "none.out"),
}
"""Something that a command does not take, or does not find; for others an option that there is not."""


def commands(group, before=()):
    """Names of all commands."""
    for name, command in group.commands.items():
        yield " ".join((*before, name))
        if hasattr(command, "commands"):
            yield from commands(command, (*before, name))


ALL = list(commands(typer.main.get_command(cli.app)))


def test_the_book_has_every_status():
    text = BOOK.read_text(encoding="utf-8")
    for code in ExitCode:
        assert f"| {code:d} | {code.title} | {code.meaning} |" in text
    assert {int(code) for code in ExitCode} == {0, 1, 2, 3, 4, 130, 141}
    assert set(BAD) < set(ALL)


def test_the_book_says_of_every_command_how_it_may_end():
    table = BOOK.read_text(encoding="utf-8").partition("What that means for each of them")[2].split("\n\n")[1]
    rows = [row.split(" | ")[0] for row in table.splitlines()[2:]]
    named = [name for row in rows for name in re.findall(r"`([^`]+)`", row)]
    groups = {name.rpartition(" ")[0] for name in ALL}
    assert sorted(named) == sorted(set(ALL) - groups), "each in one row"


@pytest.mark.parametrize("name", ALL)
def test_bad_input_is_2_and_one_line(call, monkeypatch, name):
    monkeypatch.delenv("STILLSPIN_DRIVE", raising=False)
    result = call(*BAD.get(name, (*name.split(), "--none")))
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1), result.output
    assert result.stderr.startswith("stillspin: ")


@pytest.mark.parametrize("arguments", [*TALKS.values(), ("can", f"can:slcan:{NOBODY}"), ("can", "can:socketcan:can99")])
def test_no_connection_is_3_and_one_line(call, arguments):
    result = call(*arguments)
    assert (result.exit_code, result.stderr.count("\n")) == (3, 1), result.output
    assert "there is no" in result.stderr


@pytest.mark.parametrize("arguments", TALKS.values(), ids=TALKS)
@pytest.mark.parametrize(
    ("error", "status"),
    [
        (RefusedError("not now", 6), 1),
        (NoAnswerError("no answer"), 3),
        (LinkError("lost"), 3),
        (DifferentError("another version"), 4),
        (KeyboardInterrupt(), 130),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_a_drive_answers_is_one_status_everywhere(call, monkeypatch, arguments, error, status):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr(Drive, "open", fails)
    result = call(*arguments)
    assert (result.exit_code, result.stderr.count("\n")) == (status, 1), result.output


def test_a_drive_of_another_protocol_is_4(call, monkeypatch):
    class Other:
        """A transport at which nothing is."""

        name = "nowhere"

        def close(self):
            pass

    monkeypatch.setattr("stillspin.drive.drive.connect", lambda _where: Other())
    monkeypatch.setattr("stillspin.drive.inspection.Requester", lambda *_: OtherVersion())
    result = call("monitor", "--drive", NOBODY)
    assert result.exit_code == 4
    assert "version 9 of the protocol" in result.stderr


class OtherVersion:
    """A requester behind which a drive speaks version 9."""

    def request(self, *_, **__):
        return b"\x09\0" + bytes(10) + b"x"

    def close(self):
        pass


def test_a_goal_that_is_missed_is_1_and_the_results_are_there(call, tmp_path):
    assert call("run", "A10", "--no-plots", "--out", "r").exit_code == 0
    missed = call("run", "A10", "--no-plots", "--set", "adc.noise=90", "--out", "r")
    assert missed.exit_code == 1
    assert "1 of 3 goals met, 0 runs broken off" in missed.stdout
    assert (tmp_path / "r" / "metrics.json").is_file()


def test_what_differs_is_4(call, fake, tmp_path):
    (tmp_path / "some.toml").write_text("[parameters]\nspeed_ramp = 500\n")
    assert call("params", "diff", "some.toml", "--drive", fake.port).exit_code == 4
    assert call("params", "load", "some.toml", "--drive", fake.port).exit_code == 0
    assert call("params", "diff", "some.toml", "--drive", fake.port).exit_code == 0


def started(fake_tree, *arguments, **how):
    environment = {**os.environ, "PYTHONPATH": str(fake_tree), "PYTHONUNBUFFERED": "1"}
    return subprocess.Popen([sys.executable, "-m", "stillspin", *arguments], env=environment, **how)


@pytest.mark.parametrize("command", ["list", "params", "--help", "version"])
def test_a_closed_pipe_is_no_traceback(fake_tree, command):
    read, write = os.pipe()
    os.close(read)
    running = started(fake_tree, command, stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    _, complaint = running.communicate(timeout=60)
    assert (running.returncode, complaint) == (141, "")


def test_monitor_ends_by_ctrl_c_and_one_with_a_duration_is_interrupted(fake_tree, fake):
    for options, status in (((), 0), (("--duration", "60"), 130)):
        where = ("monitor", "speed", "--drive", fake.port, *options)
        running = started(fake_tree, *where, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert any(line.startswith("time") for line in running.stdout)
        time.sleep(0.2)
        running.send_signal(signal.SIGINT)
        _, complaint = running.communicate(timeout=60)
        assert running.returncode == status
        assert ("interrupted" in complaint) == (status == 130)
