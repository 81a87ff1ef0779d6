"""The virtual board's desk without a drive: the pace, what passes between port and board, what it says of itself."""

from __future__ import annotations

import io
import os
from collections import deque

import pytest
from desk import open_port
from rich.console import Console

from stillspin.board.desk import SLICE, TICKS_PER_SECOND, Desk
from stillspin.board.pacer import LAG, Pacer
from stillspin.board.show import Show
from stillspin.drive.state import WORDS
from stillspin.errors import CampaignError

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
    with open_port(port.name) as client:
        client.write(message)
        answer = b""
        for _ in range(1000):
            desk.step(SLICE)
            answer += client.read(client.in_waiting)
        assert answer == message
    assert desk.octets_in == desk.octets_out == len(message)
    assert desk.time == pytest.approx(1000 * SLICE)


def test_program_that_writes_too_fast_is_held_back(desk, port):
    with open_port(port.name, write_timeout=0) as client:
        client.write(b"x" * 3000)
        desk.step(SLICE)
        assert desk.octets_in <= 0.01 * 115200 / 10
        for _ in range(5):
            desk.step(SLICE)
        assert desk.board.serial_pending <= 0.025 * TICKS_PER_SECOND


def test_wrong_rate_is_told(desk, port):
    with open_port(port.name):
        desk.step(SLICE)
        assert desk.wrong_rate is None
    with open_port(port.name, 9600):
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
    with Show(Console(file=out, width=160, **terminal), desk, pacer, 1.0, WORDS) as show:
        for _ in range(3):
            show.look()
    return out.getvalue()


def test_status_line_tells_time_pace_state_shaft_and_port(desk, port):
    with open_port(port.name):
        desk.step(SLICE)
        line = Show(Console(file=io.StringIO()), desk, SlowPacer(), 1.0, WORDS).line()
    for words in ("0.0 s", "0.42 × real time", "running", "599.5 rpm", "2.00 Nm", "open at 115200 bit/s"):
        assert words in line
    assert "not open" in Show(Console(file=io.StringIO()), desk, SlowPacer(), 1.0, WORDS).line()
    assert "running" in _shown(desk, SlowPacer(), force_terminal=True)


def test_warnings_come_once_and_also_without_a_terminal(desk, port):
    with open_port(port.name, 9600):
        desk.step(SLICE)
        words = _shown(desk, SlowPacer())
    assert words.count("does not keep up: 0.42 × real time instead of 1 ×") == 1
    assert words.count("the terminal is set to 9600 bit/s and the drive to 115741") == 1
    assert "rpm" not in words, "the line is for those who look at it"
