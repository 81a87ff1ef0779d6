"""What commands that execute an image say of the run: that the program used what the virtual chip has not."""

import subprocess
import sys
import time
from pathlib import Path

import pytest
from c28x_chip import linked_file
from typer.testing import CliRunner

from stillspin import cli
from stillspin.hil import boards

READS_ROM = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  MOVL XAR7,#0x3FF000
        MOV AL,*XAR7
stay:   NOP
        B stay,UNC
"""
READS_RAM = READS_ROM.replace("0x3FF000", "0x3F8000")
SAID = "warning: the program accessed parts of the chip that are not modelled (1 time): "


@pytest.fixture
def image(tmp_path):
    def make(text=READS_ROM):
        source = tmp_path / "rom.asm"
        source.write_text(text)
        return str(linked_file(tmp_path, "rom", [source]))

    return make


def ask(*arguments):
    done = CliRunner().invoke(cli.app, ["image", *arguments])
    return done.exit_code, [line for line in done.stdout.splitlines() if line.startswith("warning: ")]


def commands(image, tape):
    return (
        ("time", image, "--for", "0.001"),
        ("trace", image, "--instructions", "5"),
        ("record", tape, "--image", image, "--for", "0.001"),
        ("replay", image, tape),
    )


def test_an_access_to_what_is_not_modelled_is_said(image, tmp_path):
    for command in commands(image(), str(tmp_path / "tape")):
        status, said = ask(*command)
        assert status == 0, command
        assert [line[: len(SAID)] for line in said] == [SAID], command


def test_a_program_that_uses_what_there_is_is_not_warned_of(image, tmp_path):
    for command in commands(image(READS_RAM), str(tmp_path / "tape")):
        assert ask(*command) == (0, []), command


def test_the_board_says_it_when_it_is_switched_off(image):
    command = [sys.executable, "-m", "stillspin", "board", "--image", image(), "--for", "0.005", "--speed", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    *_, said, left = done.stdout.splitlines()
    assert said.startswith(SAID)
    assert left.startswith("switched off after")


def test_a_board_in_the_loop_says_it_too(image, capsys):
    with boards.Board(None, Path(image())) as board:
        board.wait("serial")
        time.sleep(2)  # of which the first milliseconds are enough
    assert capsys.readouterr().out.startswith("warning: the program accessed parts of the chip that are not modelled")


def test_words_for_no_memory_are_said_in_a_scenario_too(image):
    file = image(READS_RAM + "        .org 0x3D7800\n        .word 1\n")
    done = CliRunner().invoke(cli.app, ["image", "time", file, "A10"])
    assert done.exit_code == 2
    assert "0x3D7800" in done.stderr


def test_resets_are_said(image):
    status, said = ask("time", image(READS_RAM), "--for", "0.02")
    assert status == 0
    assert said == ["warning: the watchdog reset the chip (3 times), and the program began anew"]
