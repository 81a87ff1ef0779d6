"""The virtual board as a process: pseudo-terminal, pace, and the whole of it with a real serial client."""

from __future__ import annotations

import io
import os
import pty
import re
import signal
import subprocess
import sys
import termios
import time
from collections import deque

import pytest
import serial
from rich.console import Console
from typer.testing import CliRunner

from stillspin import cli
from stillspin.board.desk import SLICE, TICKS_PER_SECOND, Desk
from stillspin.board.pacer import LAG, Pacer
from stillspin.board.pseudo_terminal import BACKLOG, PseudoTerminal
from stillspin.board.show import Show
from stillspin.errors import CampaignError, InputError


def _open(name, rate=115200, **options):
    return serial.Serial(str(name), rate, timeout=1.0, exclusive=True, **options)


@pytest.fixture
def port():
    terminal = PseudoTerminal()
    yield terminal
    terminal.close()


# ---- pseudo-terminal


def test_octets_pass_unchanged_both_ways(port):
    everything = bytes(range(256))
    with _open(port.name) as client:
        client.write(everything)
        client.flush()
        assert port.read() == everything
        port.write(everything)
        assert client.read(256) == everything


def test_what_comes_while_nobody_has_the_port_open_is_lost(port):
    assert not port.is_open
    port.write(b"before")
    with _open(port.name) as client:
        assert port.is_open
        port.write(b"after")
        assert client.read(5) == b"after"
    assert not port.is_open
    port.write(b"between")
    with _open(port.name) as client:
        port.write(b"again")
        assert client.read(5) == b"again"


@pytest.mark.parametrize("rate", [9600, 115200, 250000, 230400])
def test_rate_is_the_one_that_the_program_sets(port, rate):
    assert port.rate == 115200
    with _open(port.name, rate):
        assert port.is_open
        assert port.rate == rate
    assert not port.is_open
    assert port.rate == 115200


def test_what_a_program_wrote_before_it_died_arrives(port):
    writer = f"import os; os.write(os.open({port.device!r}, os.O_RDWR | os.O_NOCTTY), b'last words'); os._exit(9)"
    subprocess.run([sys.executable, "-c", writer], check=False)
    assert port.read() == b"last words"
    assert port.read() == b""


def test_a_program_that_does_not_read_is_not_waited_for(port):
    with _open(port.name) as client:
        for _ in range(40):
            port.write(b"x" * 4096)
        assert port.dropped > 0
        client.reset_input_buffer()
        assert BACKLOG + port.dropped <= 40 * 4096


def test_link_is_made_replaced_and_removed(tmp_path):
    link = tmp_path / "drive"
    link.symlink_to("/dev/pts/no-such")
    port = PseudoTerminal(link)
    assert port.name == str(link)
    assert str(link.readlink()) == port.device
    with _open(link) as client:
        client.write(b"?")
        client.flush()
        assert port.read() == b"?"
    port.close()
    port.close()
    assert not link.is_symlink()
    assert list(tmp_path.iterdir()) == []


def test_link_of_a_board_that_runs_is_not_taken_over(tmp_path):
    link = tmp_path / "drive"
    first = PseudoTerminal(link)
    with pytest.raises(InputError, match="another virtual board that runs"):
        PseudoTerminal(link)
    assert str(link.readlink()) == first.device
    first.close()
    second = PseudoTerminal(link)
    assert str(link.readlink()) == second.device
    second.close()


def test_link_of_a_board_that_was_killed_is_taken_over(start, tmp_path):
    process, link = start()
    _until_ready(process)
    process.kill()
    process.wait()
    port = PseudoTerminal(link)
    assert str(link.readlink()) == port.device
    port.close()
    assert list(tmp_path.iterdir()) == []


def test_link_that_is_not_ours_any_more_is_left_alone_at_the_end(tmp_path):
    port = PseudoTerminal(tmp_path / "drive")
    (tmp_path / "drive").unlink()
    (tmp_path / "drive").symlink_to("/dev/null")
    port.close()
    assert str((tmp_path / "drive").readlink()) == "/dev/null"


def test_link_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").write_text("precious")
    with pytest.raises(InputError, match="not a symbolic link"):
        PseudoTerminal(tmp_path / "file")
    with pytest.raises(InputError, match="cannot be made"):
        PseudoTerminal(tmp_path / "none" / "drive")
    assert (tmp_path / "file").read_text() == "precious"


# ---- pace


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def test_time_is_due_as_the_clock_goes():
    clock = Clock()
    pacer = Pacer(2.0, clock)
    clock.now += 0.05
    assert pacer.due(0.0) == pytest.approx(0.1)
    assert pacer.due(0.12) == pytest.approx(-0.02)
    assert pacer.wall(0.02) == pytest.approx(0.01)


def test_a_pause_is_not_caught_up():
    clock = Clock()
    pacer = Pacer(1.0, clock)
    clock.now += 60.0
    assert pacer.due(0.0) == pytest.approx(LAG)
    clock.now += 0.01
    assert pacer.due(LAG) == pytest.approx(0.01)


def test_a_slow_machine_is_noticed():
    clock = Clock()
    pacer = Pacer(1.0, clock)
    simulated = 0.0
    for _ in range(300):
        clock.now += 0.01
        pacer.due(simulated)
        simulated += 0.005
    assert pacer.late
    assert pacer.ratio == pytest.approx(0.5, rel=0.02)
    for _ in range(300):
        clock.now += 0.01
        simulated += max(pacer.due(simulated), 0.0)
    assert not pacer.late


def test_as_fast_as_possible_is_never_late():
    clock = Clock()
    pacer = Pacer(0.0, clock)
    for step in range(300):
        clock.now += 0.01
        assert pacer.due(step * 0.001) == float("inf")
    assert not pacer.late
    assert pacer.wall(1.0) == 0.0


# ---- desk


class EchoBoard:
    """A board whose drive sends back what it gets, a slice later, at 115200 bit/s."""

    def __init__(self):
        self.now = 0
        self.serial_rate = 115200.0
        self.pending = deque()
        self.closed = False
        self.broken = False
        self.out = b""

    @property
    def serial_pending(self):
        return sum(len(octets) for octets in self.pending) * 10 * TICKS_PER_SECOND / self.serial_rate

    def advance(self, ticks):
        if self.broken:
            raise RuntimeError("interrupts nested too deeply")
        self.now += ticks
        room = ticks * self.serial_rate / 10 / TICKS_PER_SECOND
        while self.pending and room > 0:
            octets = self.pending.popleft()
            self.out += octets
            room -= len(octets)

    def serial_write(self, octets):
        self.pending.append(octets)

    def serial_read(self):
        octets, self.out = self.out, b""
        return octets

    def serial_counts(self):
        return {"drive_rate": 115740.7}

    def signals(self):
        return {"state": 4.0}

    def truth(self):
        return {"speed": 599.5, "load_torque": 2.0}

    def close(self):
        self.closed = True


@pytest.fixture
def desk(port):
    return Desk(EchoBoard(), port)


def test_desk_carries_octets_between_program_and_drive(desk, port):
    message = os.urandom(3000)
    with _open(port.name) as client:
        client.write(message)
        answer = b""
        for _ in range(1000):
            desk.step(SLICE)
            answer += client.read(client.in_waiting)
        assert answer == message
    assert desk.octets_in == desk.octets_out == len(message)
    assert desk.time == pytest.approx(1000 * SLICE)


def test_program_that_writes_too_fast_is_held_back(desk, port):
    with _open(port.name, write_timeout=0) as client:
        client.write(b"x" * 3000)
        desk.step(SLICE)
        assert desk.octets_in <= 0.01 * 115200 / 10
        for _ in range(5):
            desk.step(SLICE)
        assert desk.board.serial_pending <= 0.025 * TICKS_PER_SECOND


def test_wrong_rate_is_told(desk, port):
    with _open(port.name):
        desk.step(SLICE)
        assert desk.wrong_rate is None
    with _open(port.name, 9600):
        desk.step(SLICE)
        assert desk.board.serial_rate == 9600
        assert desk.wrong_rate == (9600, 115741)
    assert desk.wrong_rate is None


def test_board_that_cannot_go_on_says_why(desk):
    desk.board.broken = True
    with pytest.raises(CampaignError, match="nested too deeply"):
        desk.step(SLICE)


# ---- what it says


class SlowPacer:
    ratio, late = 0.42, True


def _shown(desk, pacer, **terminal):
    out = io.StringIO()
    with Show(Console(file=out, width=160, **terminal), desk, pacer, 1.0) as show:
        for _ in range(3):
            show.look()
    return out.getvalue()


def test_status_line_tells_time_pace_state_shaft_and_port(desk, port):
    with _open(port.name):
        desk.step(SLICE)
        line = Show(Console(file=io.StringIO()), desk, SlowPacer(), 1.0).line()
    for words in ("0.0 s", "0.42 × real time", "running", "599.5 rpm", "2.00 Nm", "open at 115200 bit/s"):
        assert words in line
    assert "not open" in Show(Console(file=io.StringIO()), desk, SlowPacer(), 1.0).line()
    assert "running" in _shown(desk, SlowPacer(), force_terminal=True)


def test_warnings_come_once_and_also_without_a_terminal(desk, port):
    with _open(port.name, 9600):
        desk.step(SLICE)
        words = _shown(desk, SlowPacer())
    assert words.count("does not keep up: 0.42 × real time instead of 1 ×") == 1
    assert words.count("the terminal is set to 9600 bit/s and the drive to 115741") == 1
    assert "rpm" not in words, "the line is for those who look at it"


# ---- the process


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


def _until_ready(process):
    """The lines that tell how to connect."""
    lines = []
    for line in process.stdout:
        lines.append(line)
        if line.startswith("switch off"):
            return "".join(lines)
    raise AssertionError(f"the board ended: {process.stderr.read()}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_process_ends_orderly_when_asked(start, number):
    process, link = start()
    words = _until_ready(process)
    assert str(link) in words
    assert "115200 bit/s" in words
    with _open(link) as client:
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
    _until_ready(process)
    with _open(link) as client:
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
    _until_ready(process)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 0
    # Its own figure: what the system takes to end a process is not the board's pace.
    ratio = float(re.search(r"after 3\.0 s of the drive's time, (\S+) × real time", out)[1])
    assert ratio <= 1.01
    assert ratio >= 0.9 or "does not keep up" in err


def test_machine_that_cannot_keep_up_is_named(start):
    process, _ = start("--speed", "100000")
    _until_ready(process)
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
