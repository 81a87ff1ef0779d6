"""The way over SocketCAN: client and board are two processes with python-can's own SocketCAN bus at both ends.

No kernel with CAN is needed: the frames go over UDP (udp_can.py). What a kernel adds, interfaces and their queues, is
not in it.
"""

import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
import udp_can
from desk import needs_board
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.cases import profile, scenario_file
from stillspin.drive import Drive
from stillspin.drive.connect import connect
from stillspin.drive.requester import Requester
from stillspin.hil import Loop
from stillspin.runs import execute

pytestmark = needs_board
WHERE = "can:socketcan:can0?node=1"
_PATIENCE = 300


@pytest.fixture
def interface(tmp_path):
    """The client's end of the bus; called with the board's speed it switches the board on."""
    client, board = udp_can.pair()
    running = []

    def switch_on(speed):
        log = tmp_path / "board.log"
        options = ["--profile", "ideal", "--speed", str(speed), "--socketcan", "can0"]
        command = [sys.executable, udp_can.__file__, str(board.fileno()), "board", *options]
        with log.open("w") as file:
            running.append(subprocess.Popen(command, pass_fds=[board.fileno()], stdout=file, stderr=file))
        end = time.monotonic() + _PATIENCE
        while "switch off" not in log.read_text():
            assert running[0].poll() is None, log.read_text()
            assert time.monotonic() < end
            time.sleep(0.05)
        assert "CAN:           can0, SocketCAN interface" in log.read_text()

    with udp_can.interface(client.fileno()):
        yield switch_on
    for process in running:
        process.terminate()
        process.wait(_PATIENCE)
    client.close()
    board.close()


@pytest.fixture
def home(tmp_path, monkeypatch):
    for variable in ("XDG_CACHE_HOME", "XDG_STATE_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "home"))


def test_the_client_talks_to_the_board(interface, home):
    interface(1)
    with Drive.open(WHERE, timeout=2.0) as drive:
        assert drive.set("speed_ramp", 1234) == 1234
        with drive.stream(["link_voltage"], period=0.02) as stream:
            samples = [stream.next(20) for _ in range(10)]
        assert all(250 < sample.values[0] < 400 for sample in samples)
        assert drive.link.counts.damaged == 0
    seen = CliRunner().invoke(cli.app, ["can", WHERE, "--duration", "1"])
    assert seen.exit_code == 0, seen.stderr
    assert "181  node 1  STATUS  " in seen.stdout
    shown = CliRunner().invoke(cli.app, ["monitor", "link_voltage", "--drive", WHERE, "--duration", "1"])
    assert shown.exit_code == 0, shown.stderr
    assert len(shown.stdout.splitlines()) > 5


def test_the_board_is_stepped(interface):
    interface(0)
    native = core.load()
    chosen = profile.load("ideal", core.plant_schema(native), core.parameters(native))
    settings = execute.Settings(chosen, profile.Changes({"solver": {"method": "rk4"}}), 1, "test")
    job = execute.prepare(scenario_file.load("A10"), settings, native)[0]
    short = replace(job, run=replace(job.run, duration=0.01))
    requester = Requester(connect(WHERE), timeout=5.0)
    try:
        assert requester.transport.port is None, "every record goes by way of python-can"
        loop = Loop(requester)
        result = loop.run(native, lambda *run: execute.play(run[0], short, *run[1:]).reason)
        loop.leave()
    finally:
        requester.close()
    assert result.difference is None
    assert result.board == result.native
    assert result.steps > 1000


def test_a_bus_that_is_not_there_is_said(tmp_path):
    if Path("/sys/class/net/can0").exists():
        pytest.skip("there is one")
    done = CliRunner().invoke(cli.app, ["monitor", "speed", "--drive", WHERE])
    assert done.exit_code == 3
    assert "there is no CAN interface can0" in done.stderr
