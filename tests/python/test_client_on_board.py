"""The client and the firmware: pyserial on a pseudo-terminal, behind it the virtual board in real time."""

import os
import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from desk import board, needs_board
from screen import terminal
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.drive import Channel, Drive, Trigger
from stillspin.drive.requester import wait_until
from stillspin.drive.state import ENERGISED
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, RefusedError
from stillspin.link.records import Record, to_wire

pytestmark = needs_board
SLOW = 20
"""Seconds for what the drive does in one or two: the machine may be busy and the board slower than real time."""


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    directory = tmp_path_factory.mktemp("desk")
    with board(directory, "--profile", "ideal") as port:
        yield port


@pytest.fixture
def home(tmp_path, monkeypatch):
    for variable in ("XDG_CACHE_HOME", "XDG_STATE_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "home"))


@pytest.fixture
def desk(port, home):
    """The client; leaves the drive ready and its parameters as they were."""
    with Drive.open(port, timeout=2.0) as desk:
        before = desk.parameters()
        yield desk
        desk.stop()
        if desk.status().fault:
            desk.reset()
        assert wait_until(lambda: desk.status().state == "ready", SLOW)
        for name, value in desk.parameters().items():
            if value != before[name]:
                desk.change(name, before[name])


def test_the_table_is_the_firmwares_own(desk):
    listed = core.load().parameters()
    assert [entry["name"] for entry in listed] == [parameter.name for parameter in desk.table.parameters]
    for entry, parameter in zip(listed, desk.table.parameters, strict=True):
        assert parameter.initial == pytest.approx(entry["default"], abs=10.0**-parameter.decimals / 2)
        assert parameter.unit == entry["unit"]
    assert "speed" in {signal.name for signal in desk.table.signals}


def test_the_motor_starts_and_the_speed_follows(desk):
    desk.set("speed_ramp", 6000)
    with desk.running(300, timeout=SLOW):
        assert wait_until(lambda: abs(desk.status().speed - 300) < 6, SLOW)
        desk.ref(-200)
        assert wait_until(lambda: abs(desk.status().speed + 200) < 6, SLOW)
        with pytest.raises(RefusedError, match="pole_pairs"):
            desk.set("pole_pairs", 3)
    assert not desk.status().energised


def test_a_triggered_capture_shows_the_step_where_it_says(desk):
    desk.set("speed_ramp", 3000)
    with desk.running(100, timeout=SLOW):
        assert wait_until(lambda: abs(desk.status().speed - 100) < 5, SLOW)
        threading.Timer(0.3, desk.ref, (500,)).start()
        trigger = Trigger("speed_reference", 300, "rising")
        capture = desk.capture("speed_reference", Channel("current_q", 8), trigger=trigger, decimation=2, timeout=SLOW)
    reference = capture.signals["speed_reference"]
    at = int(np.flatnonzero(capture.time == 0.0)[0])
    step = 8192 / 2**15
    assert reference[at] >= 300 - step
    assert reference[at - 1] < 300 + step
    # 3000 rpm/s: 0.6 rpm in each record of 0.2 ms, until the reference is reached.
    rising = (capture.time > -0.05) & (capture.time < 0.05)
    slope = np.polyfit(capture.time[rising], reference[rising], 1)[0]
    assert slope == pytest.approx(3000, rel=0.01)
    assert capture.clipped == ()


def test_a_motor_that_a_capture_runs_begins_when_the_records_before_the_trigger_are_there(desk):
    """256 ms of them here; the reference passes its level some 100 ms behind the start."""
    trigger = Trigger("speed_reference", 100, "rising")
    capture = desk.capture("speed_reference", trigger=trigger, decimation=20, timeout=SLOW, run=600)
    assert capture.time[0] == pytest.approx(-0.256)
    assert np.nanmax(capture.signals["speed_reference"][capture.time < 0]) < 100


def test_a_stream_comes_regularly_and_whole(desk):
    with desk.stream(["speed", "link_voltage"], period=0.01) as stream:
        samples = [stream.next(SLOW) for _ in range(100)]
    times = np.array([sample.time for sample in samples])
    assert np.allclose(np.diff(times), 0.01, atol=0.0015)
    assert stream.lost == 0
    assert all(250 < sample.values[1] < 400 for sample in samples)


def test_a_fault_is_told_in_words(desk):
    desk.set("link_minimum", 350)  # the link has 300
    with pytest.raises(DriveError, match=r"the motor does not run: .*below link_minimum"):
        desk.start(300)
        desk.wait_for_run(SLOW)
    newest = desk.faults()[0]
    assert newest.cause == desk.status().fault
    assert "supply" in newest.remedy
    assert 250 < newest.link_voltage < 400
    desk.reset()
    assert wait_until(lambda: desk.status().state == "ready", SLOW)


def test_the_drive_stops_by_itself_when_a_guarded_client_is_silent(desk):
    desk.set("link_timeout", 200)
    desk.start(100, guarded=True)
    with desk.kept_alive():
        desk.wait_for_run(SLOW)
    time.sleep(1.5)
    assert wait_until(lambda: not desk.status().energised, SLOW)
    assert desk.raw_status().link & 2


HOLDS = """
import sys, time
from stillspin.drive import Drive
with Drive.open(sys.argv[1], timeout=2.0) as drive, drive.running(100, timeout=20):
    print("runs", flush=True)
    time.sleep(600)
"""


def test_a_motor_whose_client_is_killed_stops_although_another_asks(port, home):
    with Drive.open(port, timeout=2.0) as before:
        before.set("link_timeout", 4000)  # for the other to be there in time
    with subprocess.Popen([sys.executable, "-c", HOLDS, port], stdout=subprocess.PIPE, text=True) as client:
        assert client.stdout.readline() == "runs\n"
        client.kill()
        client.wait()
        with Drive.open(port, timeout=2.0) as other, other.kept_alive():
            first = other.raw_status()
            assert first.state in ENERGISED
            assert (first.guarded, first.held) == (True, False)
            assert wait_until(lambda: other.raw_status().state not in ENERGISED, SLOW, 0.05)
            assert other.raw_status().link & 2
            other.set("link_timeout", 1000)


def test_noise_and_half_records_leave_the_drive_controllable(desk):
    rng = np.random.default_rng(1)
    for _ in range(20):
        desk.link.transport.send_text(rng.bytes(200))
        desk.link.transport.send_text(to_wire(Record(7, 1, b"\x01\0\0\0\0"))[: int(rng.integers(1, 8))])
    time.sleep(0.3)  # what has begun is given up after 0.1 s
    assert desk.get("speed_limit") == desk.table.parameter("speed_limit").initial
    assert not desk.status().energised


def test_the_console_answers_among_records(desk, port):
    heard = []
    with desk.link.listening(text=heard.append):
        desk.link.transport.send_text(b"\x03\rget speed_ramp\r")
        for _ in range(20):
            desk.status()
        assert wait_until(lambda: b"rpm/s" in b"".join(heard), SLOW)
    assert desk.link.counts.damaged == 0


def test_the_console_ends_with_1_when_the_drive_refuses(port, home):
    lines = ["set speed_limit 70000", "ref 300", "start now", "version", "scope trigger speed above 40000"]
    typed = [part for line in lines for part in ("-c", line)]
    result = CliRunner().invoke(cli.app, ["console", *typed, "--drive", port])
    assert result.exit_code == 1
    said = [line for line in result.stderr.splitlines() if "not saved" not in line]  # what others have set before
    assert said == [f"stillspin: not carried out: {line}" for line in lines[::2]]
    assert "stillspin 0.1.0" in result.stdout
    assert "40000 is outside of -8191.75 .. 8191.75 rpm: nothing changed" in result.stdout


def test_the_commands(port, home, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        result = CliRunner().invoke(cli.app, [*arguments, "--drive", port])
        assert result.exit_code == 0, result.stderr
        return result.stdout

    assert "speed_limit" in call("console", "--command", "get speed_limit", "-c", "save")
    dumped = call("params", "dump", "all.toml")
    assert "parameters; see all.toml" in dumped
    assert call("params", "load", "all.toml").startswith("0 of ")
    assert "512 records every 0.1 ms" in call("scope", "current_d", "current_q", "--out", "x.csv")
    step = ["speed", "speed_reference", "--trigger", "speed_reference", "--level", "100", "--decimation", "2"]
    call("scope", *step, "--run", "600", "--out", "step.csv")
    rows = [line.split(",") for line in (tmp_path / "step.csv").read_text().splitlines() if line[0] in "-0123456789"]
    reference = [float(row[2]) for row in rows]
    assert reference[0] < 100 < reference[-1], "the step is in it, and nobody else had to make it"
    assert "ready" in call("console", "-c", "status"), "the motor ran for the capture alone"
    assert len(call("monitor", "speed", "--duration", "1").splitlines()) > 5


def test_bad_values_are_refused_before_they_are_sent(desk):
    with pytest.raises(InputError, match=r"speed_limit: .* is out of range; "):
        desk.set("speed_limit", 1e6)


@pytest.mark.parametrize("typed", ["5000", "-1e5 rpm", 4000.5])
def test_a_speed_beyond_the_limit_names_what_holds_now_and_what_sets_it(desk, typed):
    before = desk.status().reference
    desk.set("speed_limit", 1200)
    with pytest.raises(InputError) as caught:
        desk.ref(typed)
    words = str(typed).removesuffix(" rpm")
    assert str(caught.value) == f"speed: {words} rpm is out of range; -1200 … 1200 rpm (speed_limit)"
    assert desk.status().reference == before
    with pytest.raises(InputError, match=r"speed: 'fast' is no number; -1200 … 1200 rpm \(speed_limit\)"):
        desk.ref("fast")


def test_pole_pairs_stay_whole_and_a_comma_is_no_point(desk):
    with pytest.raises(InputError, match=r"pole_pairs: 2\.5 is not a whole number; 1 … 30"):
        desk.set("pole_pairs", "2.5")
    with pytest.raises(InputError, match="no comma"):
        desk.set("current_limit", "1,5")
    assert desk.set("pole_pairs", "0.4e1") == 4
    listed = {entry["name"]: entry["whole"] for entry in core.load().parameters()}
    assert listed == {parameter.name: parameter.range.whole for parameter in desk.table.parameters}


def test_defaults_are_the_tables(desk):
    desk.set("speed_ramp", 1234)
    desk.defaults()
    assert wait_until(lambda: desk.get("speed_ramp") == desk.table.parameter("speed_ramp").initial, SLOW)


def test_over_can_the_same_drive_does_the_same(desk, port):
    """Two clients at once, one on each way; records in pieces through a real SLCAN end of python-can."""
    with Drive.open(f"can:slcan:{Path(port).parent / 'can'}?node=1", timeout=2.0) as other:
        assert other.table == desk.table
        other.set("speed_ramp", 6000)
        assert desk.get("speed_ramp") == 6000
        with other.running(300, timeout=SLOW):
            assert wait_until(lambda: abs(desk.status().speed - 300) < 6, SLOW)
            with other.stream(["speed"], period=0.02) as stream:
                samples = [stream.next(SLOW) for _ in range(10)]
            assert all(abs(sample.values[0] - 300) < 10 for sample in samples)
            capture = other.capture("speed", "current_q", timeout=SLOW)
            assert np.all(np.abs(capture.signals["speed"] - 300) < 10)
        assert not desk.status().energised
        assert other.link.counts.damaged == 0


def test_monitor_shows_the_same_drive_over_can(port, home):
    """As numbers, and in a terminal as lines; records in pieces, with the periodic messages of the bus between them."""
    where = f"can:slcan:{Path(port).parent / 'can'}?node=1"
    asked = ["monitor", "speed", "link_voltage", "--period", "20", "--drive", where]
    result = CliRunner().invoke(cli.app, [*asked, "--duration", "4"])
    assert result.exit_code == 0, result.stderr
    assert "lost" not in result.stdout
    head, title, *rows = result.stdout.splitlines()
    assert re.match(r"# firmware: .*board \w+, ", head)
    assert title == "time [s]\tspeed [rpm]\tlink_voltage [V]"
    values = np.array([[float(number) for number in row.split("\t")] for row in rows])
    assert len(values) > 20
    assert np.allclose(np.diff(values[:, 0]), 0.02, atol=0.0015)
    assert np.all((values[:, 2] > 250) & (values[:, 2] < 400))
    seen = terminal([*asked, "--duration", "4"], {**os.environ, "TERM": "xterm-256color"}, 60)
    assert "ready" in seen
    assert "link_voltage 3" in seen
    assert any(0x2800 < ord(character) < 0x2900 for character in seen)


def test_the_bus_is_shown_in_words(port, home):
    where = f"can:slcan:{Path(port).parent / 'can'}?node=1"
    result = CliRunner().invoke(cli.app, ["can", where, "--duration", "1"])
    assert result.exit_code == 0, result.stderr
    assert "181  node 1  STATUS  " in result.stdout
    assert "201  node 1  TELEMETRY_1  " in result.stdout
