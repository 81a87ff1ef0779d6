"""`stillspin image show`: what an image loads, how full the memories are, and its code as instructions."""

import flash_files
import pytest
from c28x_chip import linked_file, program
from typer.testing import CliRunner

from stillspin import cli
from stillspin.c28x.program import assemble
from stillspin.flash.program import Block

START = 0x3F4000
CODE = """
start:  MOVW DP,#0x1C0
        MOV @0x29,#0x68
        RPT #31
     || SUBCUL ACC,@XT
        B start,UNC
        .word 0xEA00, 0x00FF
"""


def blocks():
    program = assemble(f" .org {START}\n{CODE}")
    words = tuple(program.words[START + k] for k in range(len(program.words)))
    return [Block(0x3E8000, (1, 2, 3)), Block(START, words), Block(0x3FBFFE, (7, 8))]


def show(tmp_path, there, *arguments):
    path = tmp_path / "some.out"
    path.write_bytes(flash_files.coff(there))
    result = CliRunner().invoke(cli.app, ["image", "show", str(path), *arguments])
    return result.exit_code, result.stdout.splitlines(), result.stderr


def test_what_is_loaded_and_how_full_the_memories_are(tmp_path):
    count = len(blocks()[1].words)
    status, lines, _ = show(tmp_path, blocks())
    assert status == 0
    assert lines == [
        f"some.out: COFF, {count + 5} words, entry 0x3F7FF6",
        "0x3E8000 to 0x3E8002       3 words  sector D",
        f"0x3F4000 to 0x{START + count - 1:06X}  {count:>6} words  sector A",
        "0x3FBFFE to 0x3FBFFF       2 words  H0 high",
        "sector D       3 of 16384 words",
        f"sector A  {count:>6} of 16384 words",
        "H0 high        2 of 8192 words",
    ]


def test_a_block_over_a_border_counts_in_both(tmp_path):
    _, lines, _ = show(tmp_path, [Block(0x3EBFFF, (1, 2, 3))])
    assert lines[1:] == [
        "0x3EBFFF to 0x3EC001       3 words  sector D to sector C",
        "sector D       1 of 16384 words",
        "sector C       2 of 16384 words",
    ]


def test_words_in_no_memory_are_said_and_make_the_status(tmp_path):
    status, lines, _ = show(tmp_path, [Block(0x007FFE, (1, 2, 3))])
    assert status == 1
    assert lines[-1] == "2 words in no memory of the chip"
    assert lines[1].endswith("nowhere to L0")


def test_code_is_listed_as_instructions(tmp_path):
    status, lines, _ = show(tmp_path, blocks(), "--code", "0x3F4000")
    assert status == 0
    assert lines == [
        "0x3F4000  761F 01C0  MOVW DP,#0x1c0",
        "0x3F4002  2829 0068  MOV @41,#0x68",
        "0x3F4004  F61F       RPT #0x1f",
        "0x3F4005  5617 00AC  SUBCUL ACC,@XT",
        "0x3F4007  FFEF FFF9  B 0x3f4000,UNC",
        "0x3F4009  EA00       SUBR @0,AL",
        "0x3F400A  00FF       .word 0x00ff",
    ]
    assert show(tmp_path, blocks(), "--code", "0x3F4004", "--lines", "2")[1] == lines[2:4]


def test_a_whole_program_is_shown(tmp_path):
    control = program("control")
    command = ["image", "show", str(linked_file(tmp_path, "control"))]
    result = CliRunner().invoke(cli.app, command)
    assert result.exit_code == 0
    assert f"{len(control.words)} words, entry 0x3F7FF6" in result.stdout.splitlines()[0]
    at = control.symbols["SAMPLE"]
    listed = CliRunner().invoke(cli.app, [*command, "--code", hex(at), "--lines", "4"]).stdout.splitlines()
    assert listed[0].split()[2:] == ["SETC", "SXM"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--code", "0x3F5000"), "the image has nothing at 0x3F5000"),
        (("--code", "start"), "'start' is no address"),
        (("--lines", "0"), "--lines"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path, arguments, says):
    status, lines, error = show(tmp_path, blocks(), *arguments)
    assert (status, lines) == (2, [])
    assert says in error
    assert error.count("\n") == 1
