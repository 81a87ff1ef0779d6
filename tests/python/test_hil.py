"""Host in the loop: a virtual board in a process of its own is stepped through runs, over its port and its bus."""

from __future__ import annotations

import json
import os
import re
from contextlib import suppress
from dataclasses import replace

import pytest
from desk import board as board_process
from typer.testing import CliRunner

from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.cli import app
from stillspin.drive import describe
from stillspin.drive.connect import connect
from stillspin.drive.protocol import Request
from stillspin.drive.requester import Requester
from stillspin.hil import Loop, built, runs, told
from stillspin.link.errors import LinkError, NoAnswerError, RefusedError
from stillspin.runs import execute

pytest.importorskip("stillspin._core", reason="the native module is not built")


@pytest.fixture(scope="module")
def link(tmp_path_factory):
    """The serial port of a board that runs as fast as it can; `can` beside it is its adapter."""
    directory = tmp_path_factory.mktemp("board")
    with board_process(directory, "--speed", "0"):
        yield directory / "drive"


@pytest.fixture
def requester(link):
    """A board that is not in the loop, and is not left in it."""
    requester = Requester(connect(str(link)), timeout=5.0)
    yield requester
    with suppress(RefusedError):
        for _ in range(100):  # refused once the reset has come, which swallows what comes with it
            with suppress(NoAnswerError):
                requester.request(Request.HIL_LEAVE, repeat=False, timeout=0.5)
    requester.close()


@pytest.fixture
def settings():
    native = core.load()
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native))
    return execute.Settings(chosen, profile.Changes({"solver": {"method": "rk4"}}), 1, "test")


@pytest.fixture
def play(settings):
    """The start of a run and a moment of it."""
    job = execute.prepare(scenario_file.load("A10"), settings, core.load())[0]

    def of(duration):
        short = replace(job, run=replace(job.run, duration=duration))
        return lambda native, progress, loop: execute.play(native, short, progress, loop).reason

    return of


def test_a_board_computes_what_the_virtual_drive_computes(requester, play):
    loop = Loop(requester)
    result = loop.run(core.load(), play(0.05))
    assert result.difference is None
    assert result.board == result.native
    assert result.steps > 1500  # the start procedure and the run
    again = loop.run(core.load(), play(0.01))  # from a drive that runs
    assert again.difference is None
    loop.leave()


def test_an_interrupt_may_end_in_the_next_period(requester, settings):
    late = {
        "late_interrupts": 95.0,
        "late_interrupts_at": 0.01,
        "late_interrupts_time": 0.001,
    }
    late_plant = profile.Changes({"solver": {"method": "rk4"}, "fault": late})
    job = execute.prepare(scenario_file.load("A10"), replace(settings, changes=late_plant), core.load())[0]
    short = replace(job, run=replace(job.run, duration=0.02))
    result = Loop(requester).run(core.load(), lambda *loop: execute.play(loop[0], short, *loop[1:]).reason)
    assert result.difference is None
    assert result.board == result.native
    assert result.reason == "fault: control interrupt overrun"


@pytest.mark.parametrize("late", [10.0, 95.0])
def test_parameters_may_change_while_interrupts_are_late(requester, settings, late):
    faults = {
        "late_interrupts": late,
        "late_interrupts_at": 0.01,
        "late_interrupts_time": 0.02,
    }
    plant = profile.Changes({"solver": {"method": "rk4"}, "fault": faults})
    job = execute.prepare(scenario_file.load("A10"), replace(settings, changes=plant), core.load())[0]
    changes = tuple((0.0051 + 0.0007 * k, "set:speed_ramp", 900.0 + k) for k in range(36))
    short = replace(
        job,
        run=replace(
            job.run,
            duration=0.04,
            commands=tuple(sorted((*job.run.commands, *changes))),
        ),
    )
    result = Loop(requester).run(core.load(), lambda *loop: execute.play(loop[0], short, *loop[1:]).reason)
    assert result.difference is None
    assert result.board == result.native
    assert result.steps > 1200


def test_a_board_that_says_nothing_is_told():
    board, port = os.openpty()
    done = CliRunner().invoke(app, ["hil", "A10", "--check", "--port", os.ttyname(port)])
    os.close(board)
    os.close(port)
    assert done.exit_code == 3
    assert "stillspin: no answer from the drive on serial port" in done.output


BUILT = r"stillspin \d+\.\d+\.\d+ \(edition lab, board bench, unknown commit, table [0-9a-f]{8}\)"
KINDS = {
    "A09": "id_3",  # locked rotor, encoder
    "A12": "hysteresis",  # slices instead of windows, which interrupt the control step
    "S04": "limited",  # a link that moves
    "commission": "motor",
}
"""One run of every kind that a step has."""


@pytest.mark.parametrize(("way", "kinds"), [("--can", list(KINDS)), ("--port", ["S04", "commission"])])
def test_every_kind_of_run_goes_through_the_loop(link, way, kinds, tmp_path):
    file = tmp_path / "results.json"
    where = link if way == "--port" else link.parent / "can"
    chosen = [part for kind in kinds for part in ("--run", KINDS[kind])]
    done = CliRunner().invoke(app, ["hil", *kinds, "--check", *chosen, way, str(where), "--json", str(file)])
    assert done.exit_code == 0, done.output
    rows = json.loads(file.read_text())["runs"]
    assert {row["scenario"]: row["run"] for row in rows} == {kind: KINDS[kind] for kind in kinds}
    assert not any(row["whole"] for row in rows)
    assert all(row["board"] == row["native"] and row["steps"] > 2000 for row in rows)
    assert all(re.fullmatch(BUILT, row["firmware"]) for row in rows)


def differences(body, at, count):
    """Where the differences of a list begin, by word, and where the list ends (firmware/hil/delta.h)."""
    places = {}
    for word in range(count):
        if word % 8 == 0:
            mask = body[at]
            at += 1
        if mask >> word % 8 & 1:
            places[word] = at
            while body[at] & 0x80:
                at += 1
            at += 1
    return places, at


class Falsified:
    """A requester on whose way to the board the sum of current a in the first window of one step is another one."""

    def __init__(self, requester, step):
        self._requester, self._left, self._shape = requester, step, [0, 0, 0, 0]

    @property
    def transport(self):
        class Elsewhere:
            port = None

        return Elsewhere

    def request(self, kind, body=b"", **words):
        if kind == Request.HIL_STEP:
            self._left -= 1
            body = self._falsify(body)
        return self._requester.request(kind, body, **words)

    def _falsify(self, body):
        shape, at = differences(body, 2, 4)
        for word, place in shape.items():
            self._shape[word] += body[place] >> 1 ^ -(body[place] & 1)
        if self._left != 0:
            return body
        _, at = differences(body, at, self._shape[3])
        _, at = differences(body, at, self._shape[2])
        window, _ = differences(body, at, 1 + self._shape[1])
        return body[: window[1]] + bytes([body[window[1]] ^ 2]) + body[window[1] + 1 :]


def test_a_single_different_bit_is_found_in_its_period(requester, play):
    result = Loop(Falsified(requester, 1300)).run(core.load(), play(0.05))
    assert result.difference is not None
    assert 1299 <= result.difference.step <= 1300
    assert result.board != result.native
    assert "on the virtual drive" in str(result.difference)


class Miscounted(Falsified):
    """A requester to whose board the check sum of its signals in one step is another one."""

    def request(self, kind, body=b"", **words):
        answer = self._requester.request(kind, body, **words)
        if kind == Request.HIL_STEP:
            self._left -= 1
            if self._left == 0:
                return answer[:-1] + bytes([answer[-1] ^ 1])
        return answer


def test_signals_that_are_the_same_are_not_said_to_differ(requester, play):
    """The values that the board tells are read as it tells them: none of them differs here."""
    result = Loop(Miscounted(requester, 1150)).run(core.load(), play(0.05))
    assert result.difference.step == 1149
    assert result.difference.words == "the check sums of the signals differ, the signals do not any more"


class Silent(Falsified):
    """A requester whose way is lost at a step."""

    def request(self, kind, body=b"", **words):
        if kind == Request.HIL_STEP:
            self._left -= 1
            if self._left == 0:
                raise LinkError("unplugged")
        return self._requester.request(kind, body, **words)


def test_a_board_that_is_lost_is_told(requester, play):
    with pytest.raises(LinkError, match="unplugged"):
        Loop(Silent(requester, 100)).run(core.load(), play(0.05))


def test_a_board_that_leaves_the_loop_refuses_its_next_step(requester, play):
    class Leaving(Falsified):
        def request(self, kind, body=b"", **words):
            if kind == Request.HIL_STEP:
                self._left -= 1
                if self._left == 0:
                    body = b"\xff\xff" + body[2:]  # a step out of turn
            return self._requester.request(kind, body, **words)

    with pytest.raises(RefusedError, match="step 99: the board refuses"):
        Loop(Leaving(requester, 100)).run(core.load(), play(0.05))


def test_a_board_that_is_built_otherwise_is_refused_before_the_first_step(fake):
    done = CliRunner().invoke(app, ["hil", "A10", "--check", "--port", fake.port])
    assert (done.exit_code, done.stderr.count("\n")) == (4, 1), done.output
    assert "version fake 1.0 on the board, stillspin 0.1.0 on the virtual drive" in done.stderr
    assert "board file ipm on the board, bench on the virtual drive" in done.stderr
    assert "parameter motor_poles on the board alone" in done.stderr
    assert "No step was done" in done.stderr
    assert Request.HIL_ENTER not in fake.asked


def test_what_differs_in_the_tables_is_named_with_both_values(requester):
    ask = Loop(requester).ask
    ours = describe.table(ask, describe.identity(ask))
    first, second, *others = ours.parameters
    other = replace(first, initial_raw=first.initial_raw + (1 << first.q))
    wider = replace(second, maximum_raw=second.maximum_raw + (1 << second.q))
    theirs = replace(ours, crc=1, parameters=(other, wider, *others[:-1]))
    found = built._of_tables(theirs, ours)
    assert found[0].startswith(f"parameter {others[-1].name} on the virtual drive alone")
    assert found[1].startswith(f"parameter {first.name}: default {other.text(other.initial_raw)} on the board, ")
    assert found[2].startswith(f"parameter {second.name}: range {wider.range_text} on the board, ")
    assert len(found) == 3
    assert built._of_tables(replace(ours, crc=1), ours) == [
        f"words for states and faults, table 00000001 on the board, {ours.crc:08x} on the virtual drive"
    ]
    assert built.check_board(ask).board == "bench"


def test_all_is_every_scenario_and_the_commissioning(settings):
    names = {run.scenario for run in runs.named(["all"], lambda _motor: settings, core.load(), check=True)}
    assert names == {"commission", *scenario_file.ids()}


def test_something_of_everything_comes_first(settings):
    everything = runs.named(["A12", "A14", "A10"], lambda _motor: settings, core.load(), check=False)
    order = [everything[number] for number in runs.broad(everything)]
    assert [run.scenario for run in order] == ["A12", "A14", "A10", "A12", "A14", "A12"]
    assert {run.name for run in order} == {run.name for run in everything}
    lengths = [run.length for run in order if run.scenario == "A12"]
    assert lengths == sorted(lengths)


def test_a_step_that_is_repeated_is_not_carried_out_again(requester):
    requester.request(Request.HIL_ENTER, repeat=True)
    step = bytes((0, 0, 0))
    first = requester.request(Request.HIL_STEP, step, repeat=True)
    assert requester.request(Request.HIL_STEP, step, repeat=True) == first
    with pytest.raises(RefusedError):
        requester.request(Request.HIL_STEP, bytes((2, 0, 0)), repeat=True)


def test_steps_are_refused_before_the_board_is_in_the_loop(requester):
    with pytest.raises(RefusedError, match="enter it first"):
        requester.request(Request.HIL_STEP, bytes((0, 0, 0)), repeat=True)


def test_what_was_told_is_compared_by_name():
    frame = (1, *range(100, 113))
    other = (1, *range(100, 112), 999)
    assert told.difference(frame, frame) is None
    words = told.difference(frame, other)
    assert words == "next period, deadline: 112 on the board, 999 on the virtual drive"
    words = told.difference((3,), (2,))
    assert words == "the board told its hardware 'gates off', the virtual drive 'gates on'"
    words = told.difference((3,), ())
    assert words == "the board told its hardware 'gates off', the virtual drive 'nothing'"
