"""Stops and traces of the core on the virtual board, and `stillspin image trace`."""

import re

import pytest
from c28x_chip import MILLISECOND, linked_file
from in_process import stillspin

from stillspin.image import opened, trace

UP = 20 * MILLISECOND


@pytest.fixture
def board(tmp_path):
    image = opened.read(linked_file(tmp_path, "control"))
    made = opened.power_on(image, "bench", "A", 1)
    yield made, image.names
    made.close()


def state(board, names):
    at = names.addresses
    return board.code(), board.registers(), board.words(at["REF"], 8), board.statistics()


def test_stopping_changes_nothing(board, tmp_path):
    made, names = board
    made.advance(UP + 5 * MILLISECOND)
    undisturbed = state(made, names)
    made.close()
    again = opened.power_on(opened.read(linked_file(tmp_path, "control")), "bench", "A", 1)
    try:
        stops = 0
        again.stop_at([names.addresses["sample"], names.addresses["beside"]])
        again.trace(10)
        again.advance(UP)
        while again.now < UP:
            stops += 1
            again.advance(UP - again.now)
            if stops == 500:
                again.stop_at([])
        again.advance(5 * MILLISECOND)
        assert stops > 450, "the interrupt and the loop beside it, in turn"
        assert state(again, names) == undisturbed
    finally:
        again.close()


def test_a_trace_has_each_instruction_with_its_cycles(board):
    made, names = board
    made.advance(UP)
    first = names.addresses["sample"]
    assert opened.run_to(made, [first], 0.001)
    made.trace(100)
    made.stop_after(8)
    opened.run_to(made, (), 0.001)
    rows = made.traced()
    assert len(rows) == 8
    assert [row["PC"] for _, row in rows[:4]] == [first, first + 1, first + 3, first + 4]
    lines = list(trace.lines(made, names))
    assert sum("control.asm:" in line for line in lines) == 8
    took = [int(line[55:].split()[0]) for line in lines if "0x3F" in line]
    assert sum(took) == made.code()["cycles"] - rows[0][0]
    assert any("MOVW DP,#0x2c" in line and "DP 2C" in line for line in lines)
    made.trace(3)
    made.stop_after(8)
    opened.run_to(made, (), 0.001)
    assert len(made.traced()) == 3, "the last ones are kept"


def test_interrupts_are_asked_for_by_vector(board):
    made, names = board
    made.advance(UP)
    before = made.statistics()["interrupts"]
    opened.run_to(made, [names.addresses["beside"]], 0.001)
    made.raise_interrupt(32)
    opened.step(made, 0.001)
    assert made.statistics()["interrupts"] == before + 1
    assert names.functions[made.registers()["PC"] - 1] == "sample", "its first instruction was executed"
    with pytest.raises(ValueError, match="no interrupt line"):
        made.raise_interrupt(12)


def test_registers_are_set_by_name(board):
    made, _ = board
    made.advance(UP)
    values = {"ACC": 0x89ABCDEF, "P": 1, "XT": 2, "XAR0": 3, "XAR7": 4, "SP": 0x450, "DP": 7, "ST0": 0x0081, "IER": 9}
    for name, value in values.items():
        made.set_register(name, value)
    there = made.registers()
    assert {name: there[name] for name in values} == values
    for name in ("XAR8", "AX", ""):
        with pytest.raises(ValueError, match="no register"):
            made.set_register(name, 0)


def test_the_table_of_vectors_is_looked_at(board):
    made, names = board
    made.advance(UP)
    low, high = made.words(0x0D00 + 2 * 32, 2)
    assert high << 16 | low == names.addresses["sample"]


def test_the_command_lists_from_a_place_and_up_to_one(tmp_path):
    image = linked_file(tmp_path, "control")

    def run(*more):
        return stillspin("image", "trace", image, "--after", "0.02", *more)

    done = run("--from", "sample", "--instructions", "3")
    assert done.exit_code == 0, done.stderr
    assert "SETC SXM" in done.stdout.splitlines()[1]
    assert done.stdout.count("0x3F") == 3
    until = run("--to", "sample", "--instructions", "5").stdout.splitlines()
    assert "beside" not in until[-1]
    assert len([line for line in until if "  0x3F" in line]) == 5
    for option in ("--from", "--to"):
        missed = run(option, "main", "--within", "0.001", "--instructions", "5")
        assert missed.exit_code == 1, "it has been there before"
        assert re.fullmatch(rf".*{option}: 0x3F.* main .* was not reached within 0.001 s; .*--within\n", missed.stderr)
    assert missed.stdout.count("  0x3F") == 5, "what was executed last is shown all the same"


def test_a_core_that_sleeps_ends_the_list(tmp_path):
    source = tmp_path / "sleeper.asm"
    source.write_text(" .org 0x3F7FF6\n LB start\n .org 0x3F4000\nstart: SETC INTM\n IDLE\nstay: B stay,UNC\n")
    image = linked_file(tmp_path, "sleeper", [source])
    done = stillspin("image", "trace", image, "--within", "0.001")
    assert done.exit_code == 0, done.stderr
    assert "IDLE" in done.stdout
    assert done.stdout.splitlines()[-1] == "no more instructions within 0.001 s: the core sleeps"


def test_a_watched_word_takes_no_time(tmp_path):
    """The same program with and without: its cycles at one place are the same."""
    found = []
    for words in ([], [(0x8003, 3), (0x8001, 1)]):
        image = opened.read(linked_file(tmp_path, "control"))
        board = opened.power_on(image, "bench", "A", 1)
        with opened.closing(board, image):
            board.stop_at([image.names.addresses["sample"]], words=words)
            stopped = 0
            while stopped < 5:
                board.advance(100_000)
                stopped += board.halted and board.registers()["PC"] == image.names.addresses["sample"]
            found.append(board.code()["cycles"])
    assert found[0] == found[1]


def test_what_is_repeated_stands_beside_its_rpt(tmp_path):
    source = tmp_path / "copies.asm"
    source.write_text(
        " .org 0x8000\nstart: MOVL XAR6,#0x9000\n MOVL XAR7,#0x3F8000\n RPT #15\n || PREAD *XAR6++,*XAR7\n"
        " RPT @AR6\n || NOP\nstay: SB stay,UNC\n"
    )
    image = tmp_path / "copies.out"
    assert stillspin("image", "assemble", source, "--out", image).exit_code == 0
    done = stillspin("image", "trace", image, "--from", "start", "--instructions", "5")
    texts = [line[22:56].strip() for line in done.stdout.splitlines() if "  0x" in line]
    assert texts[2:4] == ["RPT #0xf || PREAD *XAR6++,*XAR7", "RPT @AR6 || NOP"]
