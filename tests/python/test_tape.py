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
from stillspin.hil.tape import Heading, TapeWriter, recorded

HEADING = Heading("A10", "creep", "bench", False, "1234", "0.1", "hil", "ipm", 0x12345678)
SAID = [(b"\x21question", b"\0answer"), (b"\x21", b"")]


def written(file, *runs):
    with TapeWriter(file, len(runs)) as tape:
        for heading, said in runs:
            tape.begin()
            for pair in said:
                tape.note(*pair)
            tape.keep(heading)
    return file


def test_what_was_said_is_read_again_run_by_run(tmp_path):
    runs = [(HEADING, SAID), (replace(HEADING, run="other"), SAID[:1])]
    tape = written(tmp_path / "one.tape", *runs)
    assert list(recorded(tape)) == runs
    assert written(tmp_path / "two.tape", *runs).read_bytes() == tape.read_bytes()


def test_what_is_not_kept_is_not_there(tmp_path):
    with TapeWriter(tmp_path / "tape", 1) as tape:
        tape.begin()
        tape.note(*SAID[0])
        tape.begin()
        tape.note(*SAID[1])
        tape.keep(HEADING)
        tape.begin()
        tape.note(*SAID[0])
    assert list(recorded(tmp_path / "tape")) == [(HEADING, [SAID[1]])]


@pytest.mark.parametrize("kept", [0, 1])
def test_a_tape_on_which_runs_are_missing_does_not_take_the_place_of_another(tmp_path, capsys, kept):
    old = written(tmp_path / "tape", (HEADING, SAID)).read_bytes()
    with suppress(KeyboardInterrupt), TapeWriter(tmp_path / "tape", 2) as tape:
        for _ in range(kept):
            tape.begin()
            tape.keep(HEADING)
        raise KeyboardInterrupt
    assert (tmp_path / "tape").read_bytes() == old
    there = f", in {tmp_path / 'tape.part'}" if kept else ""
    said = f"--tape {tmp_path / 'tape'}: not written; {kept} of 2 runs can be kept{there}\n"
    assert capsys.readouterr().err == said
    names = ["tape", "tape.part"] if kept else ["tape"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert not kept or list(recorded(tmp_path / "tape.part")) == [(HEADING, [])]


@pytest.mark.parametrize("spoilt", [lambda octets: b"", lambda octets: octets[:-30], lambda octets: b"no tape at all"])
def test_a_tape_that_is_not_whole_is_refused(tmp_path, spoilt):
    tape = written(tmp_path / "tape", (HEADING, SAID * 40))
    tape.write_bytes(spoilt(tape.read_bytes()))
    with pytest.raises(InputError, match=r"--play .*tape: is no whole tape; `stillspin hil ID --port virtual --tape"):
        list(recorded(tape))


def test_files_that_cannot_be_had_are_said(tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        TapeWriter(tmp_path / "nowhere" / "tape", 1)
    with pytest.raises(InputError, match="cannot be read"):
        list(recorded(tmp_path / "tape"))


@pytest.fixture(scope="module")
def tape(tmp_path_factory):
    file = tmp_path_factory.mktemp("made") / "a10.tape"
    made = CliRunner().invoke(app, ["hil", "A10", "--check", "--port", "virtual", "--tape", str(file)])
    assert made.exit_code == 0, made.output
    return file


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    with board_process(tmp_path_factory.mktemp("board"), "--speed", "0") as name:
        yield name


def played(tape, port, *more):
    return CliRunner().invoke(app, ["hil", "--play", str(tape), "--port", port, *more])


@needs_board
def test_a_board_that_answers_as_on_the_tape_is_identical(tape, port, tmp_path):
    said = played(tape, port, "--json", str(tmp_path / "results.json"))
    assert said.exit_code == ExitCode.DONE, said.output
    assert "A10 creep (its start): identical, log " in said.output
    assert '"native": ""' not in (tmp_path / "results.json").read_text()


@needs_board
def test_another_answer_is_found_in_its_step(tape, port, tmp_path):
    [(heading, said)] = recorded(tape)
    steps = [number for number, (request, _) in enumerate(said) if request[0] == Request.HIL_STEP]
    request, answer = said[steps[999]]
    said[steps[999]] = request, answer[:-1] + bytes((answer[-1] ^ 1,))
    found = played(written(tmp_path / "other.tape", (heading, said)), port)
    assert found.exit_code == ExitCode.DIFFERS
    assert "DIFFERS at step 1000 (0.1000 s from power-on): answer to HIL_STEP, octet" in found.output


@needs_board
def test_a_board_that_is_built_otherwise_is_refused_before_the_first_step(tape, port, tmp_path):
    [(heading, said)] = recorded(tape)
    other = written(tmp_path / "other.tape", (replace(heading, board="other", crc=heading.crc ^ 1), said))
    refused = played(other, port)
    assert refused.exit_code == ExitCode.DIFFERS
    assert f"board file {heading.board} on the board, other on the tape; table " in refused.output
    assert "No step was done" in refused.output


@pytest.mark.parametrize(
    "option",
    [
        *("--check", "--resume", "--run creep", "--profile bench", "--seed 1", "--set speed_limit=100"),
        *("--params none", "--scheme paper", "--jobs 1", "--cluster none", "--tape none"),
    ],
)
def test_what_means_nothing_with_a_tape_is_refused(option):
    refused = CliRunner().invoke(app, ["hil", "--play", "tape", "--port", "virtual", *option.split()])
    assert refused.exit_code == ExitCode.BAD_INPUT
    name = option.partition(" ")[0]
    assert f"{name}: no meaning with --play, which asks one board what is on the tape" in refused.output


def test_nothing_is_resumed_without_results():
    refused = CliRunner().invoke(app, ["hil", "A10", "--resume", "--port", "virtual"])
    assert refused.exit_code == ExitCode.BAD_INPUT
    assert "--resume: leaves out what a file of results has; name it with --json FILE" in refused.output


@pytest.mark.parametrize("arguments", [[], ["A10", "--play", "tape"]])
def test_scenarios_or_a_tape(arguments):
    refused = CliRunner().invoke(app, ["hil", *arguments, "--port", "virtual"])
    assert "name scenarios, such as A10, or give --play FILE: one of the two" in refused.output
