"""`hil --image`: an image in the loop, from the board that executes it to the difference that is named.

Nobody here has an image of the drive. The program is the control program of this project's assembler: it speaks the
protocol, and in a step computes something of its own, which no native drive computes; so what the drive's run brought
is held against what the program should compute, in the place of the native drive's answers, and all else is what a
user's image goes through.
"""

from contextlib import suppress
from dataclasses import replace

import loop_program
import pytest
from c28x_chip import linked_file
from desk import board as board_process
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.board.image import blocks_of
from stillspin.cases import profile, scenario_file
from stillspin.drive import describe
from stillspin.drive.connect import connect
from stillspin.drive.own import virtual_ask
from stillspin.drive.protocol import Request
from stillspin.drive.requester import Requester
from stillspin.exit_codes import ExitCode
from stillspin.hil import Loop, boards, campaign
from stillspin.hil.runs import LoopRun
from stillspin.hil.wish import Wish
from stillspin.image import opened
from stillspin.image.serial_client import SerialClient
from stillspin.link.errors import NoAnswerError, RefusedError
from stillspin.runs import execute

pytest.importorskip("stillspin._core", reason="the native module is not built")

SETTINGS, ENTRY = 0x3F6000, 0x3F7FF6
CMPA = 0x6809


class Noting:
    """A requester that keeps what the loop asks of a board."""

    def __init__(self, requester):
        self._requester, self.asked = requester, []

    @property
    def transport(self):
        class Elsewhere:
            port = None

        return Elsewhere

    def request(self, kind, body=b"", **words):
        self.asked.append(bytes([kind]) + body)
        return self._requester.request(kind, body, **words)


@pytest.fixture(scope="module")
def requests(tmp_path_factory):
    """All that a scenario's run asks of a board, from power-on to its end, behind the entry into the loop."""
    native = core.load()
    chosen = profile.load("bench", core.plant_schema(native), core.parameters(native))
    settings = execute.Settings(chosen, profile.Changes({"solver": {"method": "rk4"}}), 1, "test")
    job = execute.prepare(scenario_file.load("A10"), settings, native)[0]
    short = replace(job, run=replace(job.run, duration=0.01))
    with board_process(tmp_path_factory.mktemp("board"), "--speed", "0") as link:
        requester = Requester(connect(link), timeout=5.0)
        noting = Noting(requester)
        result = Loop(noting).run(native, lambda *loop: execute.play(loop[0], short, *loop[1:]).reason)
        with suppress(NoAnswerError):
            requester.request(Request.HIL_LEAVE, repeat=False)
        requester.close()
    assert result.difference is None
    assert result.steps > 1000
    return noting.asked[1:]


@pytest.fixture(scope="module")
def drive():
    """What the drive that is built here calls itself, and its signals."""
    with virtual_ask() as ask:
        who = describe.identity(ask)
        return ask(Request.IDENTITY, b""), [signal.name for signal in describe.table(ask, who).signals]


@pytest.fixture
def without_memory(monkeypatch):
    """The program has no use for the memory that a board of its own is made for, which takes another process."""
    monkeypatch.setattr(boards, "memory", lambda: b"")


@pytest.fixture
def stepped(monkeypatch, requests, drive):
    """`hil --image` with the program's own expectation beside it."""
    names = drive[1]

    class Beside(Loop):
        def run(self, native, play, progress=None):
            return super().run(loop_program.native(names), play, progress)

    def play(_native, progress, loop):
        for number, request in enumerate(requests):
            if not loop.send(request) or not progress(number / len(requests)):
                break
        return ""

    monkeypatch.setattr(campaign, "Loop", Beside)
    monkeypatch.setattr(Wish, "runs", lambda *_: [LoopRun("A10", "creep", play, "bench", True, 0.01)])
    return hil


def hil(file, *more):
    return CliRunner().invoke(cli.app, ["hil", "A10", "--image", str(file), *more])


def modelled(requests, names):
    """The model behind each step."""
    model = loop_program.Model(names)
    for request in requests:
        if request[0] == Request.HIL_STEP:
            model.answer(request[1:])
            yield model


def code(file):
    """Without the settings, which say whose table it has."""
    blocks = blocks_of(opened.read(file).program, str(file))
    words = {first + place: word for first, block in blocks for place, word in enumerate(block)}
    return {address: word for address, word in words.items() if not SETTINGS <= address < ENTRY}


@pytest.fixture
def powered(drive, tmp_path):
    """A board that has just been switched on, the program's names, and a client at its port."""
    image = opened.read(loop_program.built(tmp_path, *drive))
    board = opened.power_on(image, "bench", "A", 1)
    board.serial_rate = boards.BAUD
    yield board, image.names.addresses, SerialClient(board, lambda: None, lambda _: None)
    board.close()


def test_it_is_the_control_program(drive, tmp_path):
    """That all other commands are tested on, with a drive's table among its settings."""
    assert code(loop_program.built(tmp_path, *drive)) == code(linked_file(tmp_path, "control"))


def test_it_samples_and_controls_while_nobody_steps_it(powered, drive):
    board, at, client = powered

    def counted():
        (count,), (low, high) = board.words(at["COUNT"], 1), board.words(at["SUM"], 2)
        return count, high << 16 | low

    client.pass_periods(300)
    count, integral = counted()
    assert count > 50
    assert integral > 1 << 31, "the reference is zero, and the samples are not"
    assert client.ask(Request.IDENTITY, b"") == drive[0]
    with pytest.raises(RefusedError):
        client.ask(Request.HIL_STEP, bytes(8))
    assert counted()[1] < integral
    client.ask(Request.HIL_ENTER, b"")
    client.pass_periods(100)
    assert counted()[0] > 150, "samples are taken all the same"
    assert counted()[1] == board.inspect(CMPA) == 0, "and do nothing"
    client.ask(Request.HIL_LEAVE, b"")
    client.pass_periods(300)
    assert counted()[1] > 1 << 31, "on its own again"


def test_an_image_is_stepped_through_a_whole_run(stepped, requests, drive, tmp_path):
    done = stepped(loop_program.built(tmp_path, *drive))
    assert done.exit_code == ExitCode.DONE, done.output
    steps = sum(request[0] == Request.HIL_STEP for request in requests)
    assert "A10 creep: identical, log " in done.stdout
    assert f", {steps} steps in " in done.stdout


@pytest.mark.usefixtures("without_memory")
def test_a_signal_that_differs_is_named_with_its_step(stepped, requests, drive, tmp_path):
    """The program counts at most one window; the first step with two is the one."""
    planted = ("MOVU    ACC,@SHAPE", "MOVU    ACC,@SHAPE\n        ANDB    AL,#1")
    step = next(number for number, model in enumerate(modelled(requests, drive[1])) if model.values["windows"] > 1)
    done = stepped(loop_program.built(tmp_path, *drive, planted))
    assert done.exit_code == ExitCode.DIFFERS, done.output
    words = "signal windows: 0 on the board, 2 on the virtual drive (raw); "
    assert f"DIFFERS at step {step} ({step * 1e-4:.4f} s from power-on): {words}" in done.stdout


@pytest.mark.usefixtures("without_memory")
def test_a_duty_that_differs_is_named_with_its_step(stepped, requests, drive, tmp_path):
    """The program's limit is lower than it should be, and reached behind a hundred steps only."""
    duties = [model.outputs[2] - 7500 for model in modelled(requests, drive[1])]
    limit = max(map(abs, duties[:100]))
    step = next(number for number, duty in enumerate(duties) if abs(duty) > limit)
    done = stepped(loop_program.built(tmp_path, *drive, ("#TURN-100", f"#{limit}")))
    assert done.exit_code == ExitCode.DIFFERS, done.output
    there = 2500 - (limit if duties[step] > 0 else -limit)
    words = f"next period, rise of leg a: {there} on the board, {2500 - duties[step]} on the virtual drive; "
    assert f"DIFFERS at step {step} ({step * 1e-4:.4f} s from power-on): {words}" in done.stdout


@pytest.mark.usefixtures("without_memory")
def test_an_image_that_is_not_the_drive_differs_in_its_first_step(drive, tmp_path):
    """Held against the native drive itself, of which it has nothing but the name."""
    done = hil(loop_program.built(tmp_path, *drive), "--check", "--run", "creep")
    assert done.exit_code == ExitCode.DIFFERS, done.output
    assert (
        "A10 creep (its start): DIFFERS at step 0 (0.0000 s from power-on): the board told its hardware " in done.stdout
    )


@pytest.mark.usefixtures("without_memory")
def test_an_image_of_other_sources_is_not_stepped(drive, tmp_path):
    identity, names = drive
    done = hil(loop_program.built(tmp_path, identity.replace(b"stillspin 0", b"stillspin 9"), names), "--check")
    assert done.exit_code == ExitCode.DIFFERS, done.output
    assert "version stillspin 9.1.0 on the board, stillspin 0.1.0 on the virtual drive" in done.stderr
    assert "No step was done" in done.stderr
