"""The virtual board as a process: how it begins and ends, its pace, a terminal that takes nothing."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
import termios
import time

import pytest
from desk import open_port
from typer.testing import CliRunner

from stillspin import cli
from stillspin.board.pseudo_terminal import PseudoTerminal


@pytest.fixture
def start(tmp_path):
    started = []

    def run(*arguments, stderr=subprocess.PIPE):
        command = [sys.executable, "-m", "stillspin", "board", "--serial-link", str(tmp_path / "drive"), *arguments]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=stderr, text=True)
        started.append(process)
        return process, tmp_path / "drive"

    yield run
    for process in started:
        process.kill()
        process.communicate()


def until_ready(process):
    """The lines that tell how to connect."""
    lines = []
    for line in process.stdout:
        lines.append(line)
        if line.startswith("switch off"):
            return "".join(lines)
    raise AssertionError(f"the board ended: {process.stderr.read()}")


def test_link_of_a_board_that_was_killed_is_taken_over(start, tmp_path):
    process, link = start()
    until_ready(process)
    process.kill()
    process.wait()
    port = PseudoTerminal(link)
    assert str(link.readlink()) == port.device
    port.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_process_ends_orderly_when_asked(start, number):
    process, link = start()
    words = until_ready(process)
    assert str(link) in words
    assert "115200 bit/s" in words
    with open_port(link) as client:
        client.write(b"\r")
        time.sleep(0.3)
        process.send_signal(number)
        out, err = process.communicate(timeout=10)
    assert process.returncode == 0, err
    assert "switched off after" in out
    assert err == ""
    assert not link.is_symlink()


def test_a_terminal_that_takes_nothing_does_not_stop_the_drive(start):
    """Ctrl-S, text that is selected: the drive answers at its port all the same."""
    master, terminal = pty.openpty()
    process, link = start(stderr=terminal)
    until_ready(process)
    with open_port(link) as client:
        assert os.read(master, 1)
        termios.tcflow(terminal, termios.TCOOFF)
        time.sleep(1.0)
        client.write(b"\rversion\r")
        assert b"protocol" in client.read_until(b"protocol")
    termios.tcflow(terminal, termios.TCOON)
    process.send_signal(signal.SIGTERM)
    out, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    assert "switched off after" in out
    os.close(master)
    os.close(terminal)


@pytest.mark.parametrize("way", [signal.SIGTERM, signal.SIGINT, "\x03"])
def test_a_board_ends_at_once_on_a_terminal_that_takes_nothing(tmp_path, way):
    """Everything of it stands on a terminal that was stopped with Ctrl-S."""
    master, terminal = pty.openpty()
    link = tmp_path / "drive"
    board = [sys.executable, "-m", "stillspin", "board", "--serial-link", str(link)]
    command = ["setsid", "--ctty", *board]  # the terminal's keys are signals for it
    process = subprocess.Popen(command, stdin=terminal, stdout=terminal, stderr=terminal)
    try:
        seen = b""
        while b"real time" not in seen:
            seen += os.read(master, 4096)
        os.write(master, b"\x13")  # Ctrl-S
        time.sleep(1.0)
        if isinstance(way, str):
            os.write(master, way.encode())
        else:
            process.send_signal(way)
        assert process.wait(timeout=10) == 0
        assert not link.is_symlink()
    finally:
        process.kill()
        process.wait()
        os.close(master)
        os.close(terminal)


def test_process_keeps_real_time(start):
    process, _ = start("--for", "3")
    until_ready(process)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0
    # Its own figure: what the system takes to end a process is not the board's pace.
    ratio = float(re.search(r"after 3\.0 s of the drive's time, (\S+) × real time", out)[1])
    assert ratio <= 1.01
    assert ratio >= 0.9 or "does not keep up" in err


def test_machine_that_cannot_keep_up_is_named(start):
    process, _ = start("--speed", "100000")
    until_ready(process)
    warning = process.stderr.readline()
    assert "does not keep up" in warning
    assert "× real time instead of 100000 ×" in warning


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--profile", "benhc"], "did you mean 'bench'"),
        (["--load", "1e9"], "--load 1e+09"),
        (["--set", "solver.method=euler"], "not a choice"),
        (["--set", "speed_ramp=-1"], "out of range"),
        (["--speed", "-1"], "--speed"),
    ],
)
def test_bad_input_is_said_in_one_line(arguments, words, tmp_path):
    link = tmp_path / "drive"
    result = CliRunner().invoke(cli.app, ["board", "--serial-link", str(link), *arguments])
    assert result.exit_code == 2
    assert words in result.stderr
    assert result.stderr.count("\n") == 1
    assert not link.is_symlink()
