"""Programs that come to what is no instruction: where they first did, and that nothing else is counted for it."""

import pytest
from c28x_chip import MILLISECOND, PROGRAMS, blocks, linked_file
from typer.testing import CliRunner

from stillspin import cli, core
from stillspin.c28x.program import assemble
from stillspin.image import opened

PLANT = {"solver": {"method": "rk4"}}
FOLDED = 0x3F4000 - 0x3E0000
"""An address without memory whose lower bits are those of the program's first word."""


def text(target):
    return f"""
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  NOP
        LCR away
stay:   B stay,UNC
away:   MOVL XAR7,#{target:#x}
        LB *XAR7
        .org 0x3F4020
data:   .word 0xE2AF, 0
"""


@pytest.fixture
def image(tmp_path):
    def make(target):
        source = tmp_path / "lost.asm"
        source.write_text(text(target))
        return linked_file(tmp_path, "lost", [source])

    return make


@pytest.fixture
def powered():
    made = []

    def make(source):
        words = assemble(source).words
        made.append(core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1, image=blocks(words)))
        return made[-1]

    yield make
    for board in made:
        board.close()


@pytest.mark.parametrize(
    ("target", "where", "usually"),
    [
        (0x012345, "0x012345, where the chip has no memory, in cycle ", "a return address or a pointer"),
        (0x008000, "0x008000, L0, in cycle ", "code that runs from RAM was not copied there"),
        (0x3F5000, "0x3F5000 data+4064, sector A, in cycle ", "nothing was loaded there"),
        (0x3FF200, "0x3FF200, boot ROM, in cycle ", "a function of the boot ROM was called"),
        (0x3F4021, "0x3F4021 data+1, sector A, in cycle ", "it is ITRAP0, which somebody wrote there, or data"),
        (0x3F4020, "0x3F4020 data, sector A, in cycle ", "it is data, or code of a C28x with a floating"),
    ],
)
def test_where_it_ran_away_is_named(image, target, where, usually):
    there = opened.read(image(target))
    board = opened.power_on(there, "bench", "A", 1)
    try:
        assert opened.warnings(board, there) == []
        opened.advance(board, 0.0005)
        said = opened.warnings(board, there)[0]
    finally:
        board.close()
    assert f"illegal instruction at {where}" in said
    assert "the last call returns to 0x3F4003 stay (lost.asm:7)" in said
    assert f"(vector 19). Usually: {usually}" in said


def test_the_commands_name_it(image):
    done = CliRunner().invoke(cli.app, ["image", "time", str(image(0x012345)), "--for", "0.001"])
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert "ILLEGAL 0x000066                entered, but none has returned" in lines
    assert any(line.startswith("(outside of the memories) ") for line in lines)
    first, *more = (line for line in lines if line.startswith("warning: "))
    assert first.startswith("warning: the program came to an illegal instruction at 0x012345, ")
    assert any(line.startswith("warning: the chip has no memory at 0x000E00, ") for line in more), "the stack has grown"
    assert all(", behind the illegal instruction. " in line for line in more)


@pytest.fixture
def storm(tmp_path):
    """A program without watchdog that calls code in RAM which nobody has copied there."""
    source = tmp_path / "storm.asm"
    source.write_text(f'        .copy "{PROGRAMS / "start.asm"}"\nmain:   LCR 0x8000\nstay:   B stay,UNC\n')
    return str(linked_file(tmp_path, "storm", [source]))


@pytest.mark.parametrize(
    "command",
    [
        ("time", "STORM", "--for", "0.1"),
        ("record", "RECORDING", "--image", "STORM", "--for", "0.1"),
        ("inject", "STORM", "--from", "stay", "--interrupt", "INT1.7", "--after", "0.1"),
    ],
    ids=lambda words: words[0],
)
def test_what_it_does_to_the_chip_is_not_said_without_the_cause(storm, tmp_path, command):
    """Trap after trap fills the stack, which grows into the registers until the board cannot go on."""
    there = {"STORM": storm, "RECORDING": str(tmp_path / "recording.npz")}
    done = CliRunner().invoke(cli.app, ["image", *(there.get(word, word) for word in command)])
    assert done.exit_code == 1
    said = " ".join(f"{done.output} {done.exception}".split())
    assert "the virtual board stopped: " in said
    assert "Before that, the program came to an illegal instruction at 0x008000, L0, in cycle " in said


def test_a_trace_ends_there(image):
    arguments = ["image", "trace", str(image(0x012345)), "--to", "stay", "--instructions", "3", "--within", "0.001"]
    done = CliRunner().invoke(cli.app, arguments)
    assert done.exit_code == 1
    assert "was not reached within 0.001 s" in done.stderr
    lines = done.stdout.splitlines()
    assert [line.split()[1] for line in lines if line.startswith("  ")] == ["0x3F4005", "0x3F4007", "0x012345"]
    assert any(
        line.endswith("ITRAP0                                  is illegal and traps: the trace ends") for line in lines
    )


def test_an_address_without_memory_is_not_taken_for_another(powered):
    board = powered(text(FOLDED))
    board.profile()
    board.advance(MILLISECOND)
    spent = board.spent()[0]
    assert spent[0x3F4000][0] < 40, "a NOP with its fetch, once"
    assert spent[0x010000][0] == 8, "the trap"
    assert board.within()[19, 0x66][0x010000] == 8


def test_a_stop_at_code_is_none_where_there_is_no_memory(powered):
    board = powered(text(FOLDED))
    board.stop_at([0x3F4000])
    board.advance(MILLISECOND)
    assert board.halted
    board.stop_at([0x3F4000])
    board.advance(MILLISECOND)
    assert not board.halted


def test_the_otp_is_a_memory_of_its_own(powered):
    board = powered(text(0x3D7800))
    board.profile()
    board.advance(MILLISECOND)
    assert board.spent()[0][0x3D7800][0] == 8


def test_what_a_reset_ends_does_not_go_on_behind_it(powered):
    """The trap's routine waits for the watchdog, which resets the chip; what starts then is not the trap's."""
    board = powered(f"{text(0x012345)}        .org 0x66\nwait:   SB wait,UNC\n")
    board.profile()
    board.advance(20 * MILLISECOND)
    assert board.statistics()["resets"] >= 2
    assert set(board.within()[19, 0x66]) == {0x010000, 0x66}


ADDRESS_MODE_1 = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  NOP
        SETC AMODE
stay:   B stay,UNC
"""


@pytest.mark.parametrize(
    "command",
    [
        ["image", "time", "{}", "--for", "0.001"],
        ["board", "--image", "{}", "--for", "0.001", "--speed", "0"],
        ["image", "time", "{}", "A10"],
    ],
    ids=["time", "board", "scenario"],
)
def test_a_board_that_cannot_go_on_says_where_the_program_had_come_to(tmp_path, command):
    source = tmp_path / "mode.asm"
    source.write_text(ADDRESS_MODE_1)
    file = str(linked_file(tmp_path, "mode", [source]))
    done = CliRunner().invoke(cli.app, [word.format(file) for word in command])
    assert done.exit_code == 1
    said = done.stderr + str(done.exception or "")
    assert "address mode 1 is not modelled, and the program sets AMODE" in said
    assert "; the program had come to 0x3F4002 stay (mode.asm:7)" in said
