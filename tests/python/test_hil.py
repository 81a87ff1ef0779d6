"""Host in the loop: a virtual board in a process of its own is stepped through a run, over its serial port."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import pytest

from stillspin import core, execute, profile, scenario_file
from stillspin.drive.protocol import Request
from stillspin.drive.requester import Requester
from stillspin.hil import Loop, told
from stillspin.link import address
from stillspin.link.errors import RefusedError

pytest.importorskip("stillspin._core", reason="the native module is not built")


@pytest.fixture
def link(tmp_path):
    """The serial port of a board that runs as fast as it can."""
    link = tmp_path / "drive"
    command = [sys.executable, "-m", "stillspin", "board", "--speed", "0", "--serial-link", str(link)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as board:
        for line in board.stdout:
            if line.startswith("switch off"):
                break
        yield link
        board.terminate()


@pytest.fixture
def requester(link):
    requester = Requester(address.connect(str(link)), timeout=5.0)
    yield requester
    requester.close()


@pytest.fixture
def job():
    """The start of a run and a moment of it."""
    native = core.load()
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native))
    settings = execute.Settings(chosen, profile.Changes({"solver": {"method": "rk4"}}), 1, "test")
    job = execute.prepare(scenario_file.load("A10"), settings, native)[0]
    return replace(job, run=replace(job.run, duration=0.05))


def test_a_board_computes_what_the_virtual_drive_computes(requester, job):
    loop = Loop(requester)
    result = loop.run(core.load(), job)
    assert result.difference is None
    assert result.board == result.native
    assert result.steps > 1500  # the start procedure and the run
    again = loop.run(core.load(), replace(job, run=replace(job.run, duration=0.01)))  # from a drive that runs
    assert again.difference is None
    loop.leave()


class Falsified:
    """A requester on whose way to the board one bit of one step is turned over, behind the CRC."""

    def __init__(self, requester, step, octet):
        self._requester, self._left, self._octet = requester, step, octet

    def request(self, kind, body=b"", **words):
        if kind == Request.HIL_STEP:
            self._left -= 1
            if self._left == 0:
                body = body[: self._octet] + bytes([body[self._octet] ^ 1]) + body[self._octet + 1 :]
        return self._requester.request(kind, body, **words)


def test_a_single_different_bit_is_found_in_its_period(requester, job):
    # Octet 6 is the first word of the first window: the sum of four codes of current a, which is a signal one step on.
    result = Loop(Falsified(requester, 1300, 6)).run(core.load(), job)
    assert result.difference is not None
    assert 1299 <= result.difference.step <= 1300
    assert result.board != result.native
    assert "on the virtual drive" in str(result.difference)


def test_a_step_that_is_repeated_is_not_carried_out_again(requester):
    requester.request(Request.HIL_ENTER, repeat=True)
    step = bytes((0, 0, 3, 0, 1, 0, 0))
    first = requester.request(Request.HIL_STEP, step, repeat=True)
    assert requester.request(Request.HIL_STEP, step, repeat=True) == first
    with pytest.raises(RefusedError):
        requester.request(Request.HIL_STEP, bytes((2, 0, 3, 0, 0)), repeat=True)


def test_steps_are_refused_before_the_board_is_in_the_loop(requester):
    with pytest.raises(RefusedError, match="enter first"):
        requester.request(Request.HIL_STEP, bytes((0, 0, 3, 0, 0)), repeat=True)


def test_what_was_told_is_compared_by_name():
    frame = (1, *range(100, 113))
    other = (1, *range(100, 112), 999)
    assert told.difference(told.Answer(0, False, frame, 1), told.Answer(0, False, frame, 2)) is None
    words = told.difference(told.Answer(0, False, frame, 1), told.Answer(0, False, other, 1))
    assert words == "next period, deadline: 112 on the board, 999 on the virtual drive"
    words = told.difference(told.Answer(0, False, (3,), 1), told.Answer(0, False, (2,), 1))
    assert words == "the board told its hardware 'gates off', the virtual drive 'gates on'"
