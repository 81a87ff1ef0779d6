"""A run in the loop as a file: recorded with the virtual drive, played into a board without it."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import pytest
from desk import board as board_process
from desk import needs_board
from typer.testing import CliRunner

from stillspin.cli import app
from stillspin.drive.protocol import Request
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.hil.recording import Heading, RecordingWriter, recorded

HEADING = Heading("A10", "creep", "bench", False, "1234", "0.1", "hil", "ipm", 0x12345678)
SAID = [(b"\x21question", b"\0answer"), (b"\x21", b"")]


def written(file, *runs):
    with RecordingWriter(file, len(runs)) as recording:
        for heading, said in runs:
            recording.begin()
            for pair in said:
                recording.note(*pair)
            recording.keep(heading)
    return file


def test_what_was_said_is_read_again_run_by_run(tmp_path):
    runs = [(HEADING, SAID), (replace(HEADING, run="other"), SAID[:1])]
    recording = written(tmp_path / "one.rec", *runs)
    assert list(recorded(recording)) == runs
    assert written(tmp_path / "two.rec", *runs).read_bytes() == recording.read_bytes()


def test_what_is_not_kept_is_not_there(tmp_path):
    with RecordingWriter(tmp_path / "recording", 1) as recording:
        recording.begin()
        recording.note(*SAID[0])
        recording.begin()
        recording.note(*SAID[1])
        recording.keep(HEADING)
        recording.begin()
        recording.note(*SAID[0])
    assert list(recorded(tmp_path / "recording")) == [(HEADING, [SAID[1]])]


@pytest.mark.parametrize("kept", [0, 1])
def test_a_recording_in_which_runs_are_missing_does_not_take_the_place_of_another(tmp_path, capsys, kept):
    old = written(tmp_path / "recording", (HEADING, SAID)).read_bytes()
    with suppress(KeyboardInterrupt), RecordingWriter(tmp_path / "recording", 2) as recording:
        for _ in range(kept):
            recording.begin()
            recording.keep(HEADING)
        raise KeyboardInterrupt
    assert (tmp_path / "recording").read_bytes() == old
    there = f", in {tmp_path / 'recording.part'}" if kept else ""
    said = f"--record {tmp_path / 'recording'}: not written; {kept} of 2 runs can be kept{there}\n"
    assert capsys.readouterr().err == said
    names = ["recording", "recording.part"] if kept else ["recording"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert not kept or list(recorded(tmp_path / "recording.part")) == [(HEADING, [])]


@pytest.mark.parametrize(
    "spoilt", [lambda octets: b"", lambda octets: octets[:-30], lambda octets: b"no recording at all"]
)
def test_a_recording_that_is_not_whole_is_refused(tmp_path, spoilt):
    recording = written(tmp_path / "recording", (HEADING, SAID * 40))
    recording.write_bytes(spoilt(recording.read_bytes()))
    with pytest.raises(
        InputError, match=r"--play .*recording: is no whole recording; `stillspin hil ID --port virtual --record"
    ):
        list(recorded(recording))


def test_files_that_cannot_be_had_are_said(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        RecordingWriter(tmp_path / "nowhere" / "recording", 1)
    with pytest.raises(InputError, match="cannot be read"):
        list(recorded(tmp_path / "recording"))


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    file = tmp_path_factory.mktemp("made") / "a10.rec"
    made = CliRunner().invoke(app, ["hil", "A10", "--check", "--port", "virtual", "--record", str(file)])
    assert made.exit_code == 0, made.output
    return file


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    with board_process(tmp_path_factory.mktemp("board"), "--speed", "0") as name:
        yield name


def played(recording, port, *more):
    return CliRunner().invoke(app, ["hil", "--play", str(recording), "--port", port, *more])


@needs_board
def test_a_board_that_answers_as_in_the_recording_is_identical(recording, port, tmp_path):
    said = played(recording, port, "--json", str(tmp_path / "results.json"))
    assert said.exit_code == ExitCode.DONE, said.output
    assert "A10 creep (its start): identical, log " in said.output
    assert '"native": ""' not in (tmp_path / "results.json").read_text()


@needs_board
def test_another_answer_is_found_in_its_step(recording, port, tmp_path):
    [(heading, said)] = recorded(recording)
    steps = [number for number, (request, _) in enumerate(said) if request[0] == Request.HIL_STEP]
    request, answer = said[steps[999]]
    said[steps[999]] = request, answer[:-1] + bytes((answer[-1] ^ 1,))
    found = played(written(tmp_path / "other.rec", (heading, said)), port)
    assert found.exit_code == ExitCode.DIFFERS
    assert "DIFFERS at step 1000 (0.1000 s from power-on): answer to HIL_STEP, octet" in found.output


@needs_board
def test_a_board_that_is_built_otherwise_is_refused_before_the_first_step(recording, port, tmp_path):
    [(heading, said)] = recorded(recording)
    other = written(tmp_path / "other.rec", (replace(heading, board="other", crc=heading.crc ^ 1), said))
    refused = played(other, port)
    assert refused.exit_code == ExitCode.DIFFERS
    assert f"board file {heading.board} on the board, other in the recording; table " in refused.output
    assert "No step was done" in refused.output


@pytest.mark.parametrize(
    "option",
    [
        *("--check", "--resume", "--run creep", "--profile bench", "--seed 1", "--set speed_limit=100"),
        *("--params none", "--scheme paper", "--jobs 1", "--cluster none", "--record none"),
    ],
)
def test_what_means_nothing_with_a_recording_is_refused(option):
    refused = CliRunner().invoke(app, ["hil", "--play", "recording", "--port", "virtual", *option.split()])
    assert refused.exit_code == ExitCode.BAD_INPUT
    name = option.partition(" ")[0]
    assert f"{name}: no meaning with --play, which asks one board what is in the recording" in refused.output


def test_nothing_is_resumed_without_results():
    refused = CliRunner().invoke(app, ["hil", "A10", "--resume", "--port", "virtual"])
    assert refused.exit_code == ExitCode.BAD_INPUT
    assert "--resume: leaves out what a file of results has; name it with --json FILE" in refused.output


@pytest.mark.parametrize("arguments", [[], ["A10", "--play", "recording"]])
def test_scenarios_or_a_recording(arguments):
    refused = CliRunner().invoke(app, ["hil", *arguments, "--port", "virtual"])
    assert "name scenarios, such as A10, or give --play FILE: one of the two" in refused.output
