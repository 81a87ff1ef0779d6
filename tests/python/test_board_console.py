"""The whole way: a serial client, a pseudo-terminal, the virtual board in real time, the console of the firmware."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest
import serial

from stillspin.drive import Drive
from stillspin.link.errors import LinkError

_PATIENCE = 20.0  # s; a busy machine runs the board slower than real time


@pytest.fixture(scope="module")
def link(tmp_path_factory):
    """The serial port of a board that runs."""
    link = tmp_path_factory.mktemp("board") / "drive"
    command = [sys.executable, "-m", "stillspin", "board", "--serial-link", str(link)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as board:
        for line in board.stdout:
            if line.startswith("switch off"):
                break
        yield link
        board.terminate()


class Terminal:
    """What a person at a terminal program does: type a line, wait for the prompt."""

    def __init__(self, port):
        self._port = port
        for _ in range(20):  # a board that was just powered does not listen yet
            port.write(b"\r")
            if port.read_until(b"> ").endswith(b"> "):
                break
        else:
            raise AssertionError("no prompt")
        while port.read(100):
            pass

    def say(self, line):
        """The lines of the answer, without the echo and the prompt."""
        self._port.write(line.encode("ascii") + b"\r")
        heard = b""
        end = time.monotonic() + _PATIENCE
        while not heard.endswith(b"\n> "):
            assert time.monotonic() < end, f"no answer to {line!r}, only {heard!r}"
            heard += self._port.read(self._port.in_waiting or 1)
        return heard.decode("ascii").replace("\r", "").splitlines()[1:-1]

    def wait_for(self, line, words):
        """Ask again and again until the answer has the words."""
        end = time.monotonic() + _PATIENCE
        while words not in (answer := "\n".join(self.say(line))):
            assert time.monotonic() < end, f"{line}: {answer}"
            time.sleep(0.1)


def _open(link, rate=115200):
    return serial.Serial(str(link), rate, timeout=0.5, exclusive=True)


@pytest.fixture
def terminal(link):
    with _open(link) as port:
        yield Terminal(port)


def test_version_is_told(terminal):
    assert terminal.say("version")[0].startswith("stillspin ")


def test_parameter_is_shown_changed_and_refused(terminal):
    assert terminal.say("get speed_ramp")[0] == "speed_ramp = 3000 rpm/s"
    assert terminal.say("set speed_ramp 1500") == ["speed_ramp = 1500 rpm/s"]
    assert "outside of" in terminal.say("set speed_ramp 200000")[0]
    assert terminal.say("get speed_ramp")[0] == "speed_ramp = 1500 rpm/s"
    terminal.say("set speed_ramp 3000")


def test_motor_turns_when_told(terminal):
    terminal.say("ref 300 rpm")
    terminal.say("start free")
    terminal.wait_for("status", "running")
    terminal.wait_for("status", "rpm of 300.0 rpm")
    assert "may not change while" in terminal.say("set inertia 0.01")[0]
    terminal.say("stop")
    terminal.wait_for("status", "ready")


def test_client_library_finds_the_drive(link):
    with Drive.open(str(link)) as drive:
        assert drive.status().state


def test_other_rate_reads_rubbish_and_the_next_client_is_well_again(link):
    with _open(link, 38400) as port:
        port.write(b"version\r")
        time.sleep(0.5)
        assert b"stillspin" not in port.read(port.in_waiting)
    with _open(link) as port:
        assert Terminal(port).say("version")[0].startswith("stillspin ")


def test_client_that_dies_while_it_writes_does_no_harm(link):
    writer = f"import os; os.write(os.open({str(link)!r}, os.O_RDWR | os.O_NOCTTY), b'get spe'); os._exit(9)"
    subprocess.run([sys.executable, "-c", writer], check=False)
    with _open(link) as port:
        port.write(b"\x03")  # Ctrl-C: the half line is gone
        assert Terminal(port).say("version")[0].startswith("stillspin ")


def test_second_program_is_refused_while_one_has_the_port(link, terminal):
    with pytest.raises(LinkError, match="in use by another program"):
        Drive.open(str(link))
    assert terminal.say("version")[0].startswith("stillspin ")


def test_line_gives_all_it_has(terminal):
    """A long answer arrives whole."""
    lines = terminal.say("list")
    assert len(lines) > 60
    assert lines == terminal.say("list")


def test_an_answer_that_nobody_reads_ends_the_command(link):
    """`console -c status | head -1`: the lines come in another thread than the one that the command ends in."""
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "stillspin", "console", "--drive", str(link), "-c", "status"]
    begin = time.monotonic()
    done = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")
    assert time.monotonic() - begin < _PATIENCE / 2
