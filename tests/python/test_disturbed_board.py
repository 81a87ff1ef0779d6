"""Clients that get in each other's way, die, or make noise: the motor does not notice, and nothing is lost silently.

The ends are real: pseudo-terminals, a second program with the same port open, a process that is killed. Time is the
drive's own and passes only between two looks at the ports, so two runs can be compared number by number.
"""

from __future__ import annotations

import os
import random
import signal
import struct
import subprocess
import sys
import tty
from contextlib import contextmanager

import pytest
import serial

from stillspin import core
from stillspin.board.can_plug import SlcanPlug
from stillspin.board.desk import SLICE, Desk
from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.drive.connect import connect
from stillspin.drive.protocol import Command, Request, StatusCode
from stillspin.link.errors import LinkError
from stillspin.link.records import ANSWER, Record, to_wire
from stillspin.link.segments import Joiner, split
from stillspin.link.splitter import Splitter, Text

pytest.importorskip("stillspin._core", reason="the native module is not built")

READY, START_UNTIL, RUN_UNTIL = 0.1, 0.9, 1.5
STATUS = Record(Request.STATUS, 0x5A)
START = Record(Request.COMMAND, 0x5B, struct.pack("<Bi", Command.START, 0))
DIES = """
import os, signal, sys
port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
os.write(port, bytes.fromhex(sys.argv[2]))
os.kill(os.getpid(), signal.SIGKILL)
"""


class Bench:
    """A board with a program at its serial port and one at its SLCAN adapter."""

    def __init__(self):
        self.board = core.load().VirtualBoard(
            plant={"solver": {"method": "rk4"}}, parameters={"position_source": 0.0}, seed=1
        )
        self.desk = Desk(self.board, PseudoTerminal(), SlcanPlug(self.board, PseudoTerminal()))
        self.port = serial.Serial(self.desk.port.device, 115200, timeout=0)
        self.bus = os.open(self.desk.can.port.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.bus)
        self.splitter, self.joiner = Splitter(), Joiner()
        self.answers, self.text, self.bus_answers = [], b"", []
        self.bus_line = b""
        self.truth = []

    def until(self, seconds, each_step=lambda step: None):
        """Let the drive's time pass; `each_step` may write something."""
        step = 0
        while self.desk.time < seconds:
            each_step(step)
            self.desk.step(SLICE)
            self.truth.append(self._look())
            self._listen()
            step += 1

    def _look(self):
        """The machine, what the drive knows, and every edge of a gate until now."""
        of_drive = {f"drive: {name}": value for name, value in self.board.signals().items()}
        return {**self.board.truth(), **of_drive, "edges": self.board.statistics()["gate_edges"]}

    def interrupt(self):
        """Ticks of 10 ns of the period between which the control interrupt has toggled the enable line."""
        seen = self.board.statistics()
        return seen["enable_earliest"], seen["enable_latest"]

    def on_bus(self, record):
        """Send a record through the adapter."""
        for data in split(record):
            os.write(self.bus, b"t401%d%s\r" % (len(data), data.hex().upper().encode()))

    def _listen(self):
        for item in self.splitter.feed(self.port.read(4096), self.desk.time):
            if isinstance(item, Record):
                self.answers.append(item)
            elif isinstance(item, Text):
                self.text += item.octets
        try:
            self.bus_line += os.read(self.bus, 65536)
        except BlockingIOError:
            return
        *lines, self.bus_line = self.bus_line.split(b"\r")
        for line in lines:
            if line[:4] == b"t481":
                record = self.joiner.feed(bytes.fromhex(line[5:].decode()))
                self.bus_answers += [record] if record else []

    def close(self):
        self.port.close()
        os.close(self.bus)
        self.desk.close()


@contextmanager
def running():
    """A bench whose motor has been told to run at 300 rpm by the program at the serial port."""
    bench = Bench()
    try:
        os.write(bench.bus, b"S6\rO\r")
        bench.until(READY)
        bench.port.write(b"ref 300\rstart free\r")
        bench.until(START_UNTIL)
        assert bench.board.signals()["state"] == 4, bench.text
        yield bench
    finally:
        bench.close()


@pytest.fixture(scope="module")
def quiet():
    """What the machine does when nobody says anything."""
    with running() as bench:
        bench.until(RUN_UNTIL)
        return bench.truth, bench.interrupt()


def same(bench, quiet):
    """No number of the machine, none of the drive and no edge of a gate differs at any look."""
    truth, interrupt = quiet
    assert len(bench.truth) == len(truth)
    for step, (now, then) in enumerate(zip(bench.truth, truth, strict=True)):
        assert now == then, f"at {step * SLICE:.3f} s"
    assert bench.interrupt() == interrupt


def wire_errors(bench):
    """Records damaged, too long, broken off; framing errors, overruns, breaks, octets lost; events dropped."""
    bench.answers.clear()
    bench.port.write(to_wire(Record(Request.LINK, 9)))
    bench.until(bench.desk.time + 0.05)
    (answer,) = [record for record in bench.answers if record.kind == Request.LINK | ANSWER]
    return struct.unpack_from("<8H", answer.body, 1)


def test_two_programs_on_one_port_and_one_on_the_bus(quiet):
    with running() as bench:
        second = os.open(bench.desk.port.device, os.O_RDWR | os.O_NOCTTY)
        asked = 0

        def talk(step):
            nonlocal asked
            if step % 20 == 0:
                bench.port.write(to_wire(STATUS))
                bench.on_bus(STATUS)
                asked += 1
            if step % 20 == 7:
                os.write(second, to_wire(STATUS)[:5])  # what another program begins to say
            if step % 20 == 8:
                os.write(second, b"list\r\x03")

        bench.until(RUN_UNTIL, talk)
        same(bench, quiet)
        os.close(second)
        assert len(bench.bus_answers) >= asked - 1
        assert all(answer.body[0] == StatusCode.OK for answer in bench.answers + bench.bus_answers)
        counts = wire_errors(bench)
        assert sum(counts[:3]) > 0, "what was cut off has been counted"


def test_a_client_that_is_killed_in_the_middle_of_a_record(quiet):
    whole = to_wire(Record(Request.PARAMETER_SET, 3, struct.pack("<Hi", 86, 600 * 256)))
    with running() as bench:

        def die(step):
            if step % 60 == 10:
                cut = whole[: 2 + step % (len(whole) - 3)]
                done = subprocess.run([sys.executable, "-c", DIES, bench.desk.port.device, cut.hex()], check=False)
                assert done.returncode == -signal.SIGKILL

        bench.until(RUN_UNTIL, die)
        same(bench, quiet)
        assert sum(wire_errors(bench)[:3]) >= 3, "each of them"
        bench.port.write(to_wire(STATUS))
        bench.until(bench.desk.time + 0.05)
        assert bench.answers[-1].body[0] == StatusCode.OK


def test_noise_and_a_full_bus(quiet):
    source = random.Random(5)
    with running() as bench:
        garbage = (0x101, False, False, 8, bytes(range(0x12, 0x1A)))  # commands that do not count
        bench.board.can_flood(garbage)
        busy, began = bench.board.can_counts()["busy_ticks"], bench.board.now
        bench.until(RUN_UNTIL, lambda _: bench.port.write(bytes(source.choice(NOISE) for _ in range(22))))
        assert (bench.board.can_counts()["busy_ticks"] - busy) / (bench.board.now - began) > 0.98
        same(bench, quiet)
        bench.board.can_flood(None)
        assert sum(wire_errors(bench)) > 0
        bench.text = b""
        bench.port.write(b"\r\x03can\r")
        bench.until(bench.desk.time + 0.2)
        lost = bench.text.decode().partition("lost        ")[2].splitlines()[0]
        assert int(lost.split("; ")[1].split()[0]) > 100, bench.text  # commands that did not count
        bench.port.write(b"\rstop\r")
        bench.until(bench.desk.time + 1.0)
        assert bench.board.signals()["state"] == 2


def disturbed(octets, source):
    """A bit of one octet flipped, or an octet put in."""
    at = source.randrange(len(octets))
    if source.random() < 0.5:
        return octets[:at] + bytes([octets[at] ^ 1 << source.randrange(8)]) + octets[at + 1 :]
    return octets[:at] + bytes([source.randrange(256)]) + octets[at:]


def test_flipped_and_inserted_octets(quiet):
    """What is disturbed is not obeyed, costs one record more at most, and is counted."""
    source = random.Random(11)
    with running() as bench:
        tags, hurt = [], []

        def ask(step):
            if step % 5 == 0 and bench.desk.time < RUN_UNTIL - 0.1:
                tags.append(len(tags) % 256)
                wire = to_wire(Record(Request.COMMAND, tags[-1], struct.pack("<Bi", Command.SPEED, 300 << 16)))
                if source.random() < 0.5:
                    hurt.append(tags[-1])
                    wire = disturbed(wire, source)
                bench.port.write(wire)

        bench.until(RUN_UNTIL, ask)
        same(bench, quiet)
        answered = [record.tag for record in bench.answers if record.kind == Request.COMMAND | ANSWER]
        missing = set(tags) - set(answered)
        assert len(answered) == len(set(answered))
        assert set(answered) <= set(tags)
        assert len(hurt) > 20
        assert len(missing) <= 2 * len(hurt)
        assert sum(wire_errors(bench)[:3]) > 0.8 * len(missing)  # an opening zero that is hurt leaves text behind it


NOISE = bytes((*range(0x80, 0x100), 0, 0, *b"aeiou \r"))


def test_who_may_command_is_said_in_words():
    with running() as bench:
        bench.on_bus(START)
        bench.port.write(to_wire(START))
        bench.until(bench.desk.time + 0.05)
        for answer in (bench.answers[-1], bench.bus_answers[-1]):
            assert answer.body[0] == StatusCode.STATE
            assert answer.body[1:] == b"the drive is busy, stop it first: running"
        stop = Record(Request.COMMAND, 1, struct.pack("<Bi", Command.STOP, 0))
        bench.on_bus(stop)  # anybody may stop it
        bench.until(bench.desk.time + 1.0)
        assert bench.board.signals()["state"] == 2
        bench.text = b""
        bench.port.write(b"can\r")
        bench.until(bench.desk.time + 0.1)
        assert b"commands    none received" in bench.text


def test_a_port_is_for_one_client(tmp_path):
    terminal = PseudoTerminal()
    try:
        for where in (f"serial://{terminal.device}", f"can:slcan:{terminal.device}?node=1"):
            with serial.Serial(terminal.device, exclusive=True), pytest.raises(LinkError, match="in use by another"):
                connect(where)
    finally:
        terminal.close()
