"""What an image's interrupts and functions took: the notes of the core, names of COFF, and `stillspin image time`."""

import re
import struct

import pytest
from c28x_chip import MILLISECOND, blocks, linked_file, program
from flash_files import coff, intel_hex
from in_process import stillspin

from stillspin import core
from stillspin.c28x import timed
from stillspin.c28x.program import assemble
from stillspin.flash import coff as coff_files
from stillspin.flash.program import Block, Program
from stillspin.image import vectors

PLANT = {"solver": {"method": "rk4"}}
FIRST_SECTION = 3
"""Of the encoder's files: two without content come before."""
ENTRY_CYCLES = 14


def symbol(name, value, *, section=FIRST_SECTION, kind=2, more=0, strings=None):
    """An entry of the table; a long name goes to the strings."""
    field = name.encode()
    if len(field) > 8:
        field = struct.pack("<II", 0, 4 + len(strings))
        strings += name.encode() + b"\0"
    return struct.pack("<8sIhHBB", field, value, section, 0, kind, more) + bytes(18 * more)


def with_symbols(data, entries, strings):
    """The file with a table of symbols behind everything."""
    count = sum(len(entry) // 18 for entry in entries)
    head = data[:8] + struct.pack("<II", len(data), count)
    return head + data[16:] + b"".join(entries) + struct.pack("<I", 4 + len(strings)) + bytes(strings)


def named(name, symbols):
    """A program as cl2000 would link it, with these of its labels."""
    made = program(name)
    parts = [Block(first, tuple(words)) for first, words in blocks(made.words)]
    strings = bytearray()
    entries = [symbol(label, made.symbols[label.upper()], strings=strings) for label in symbols]
    return with_symbols(coff(parts), entries, strings)


def test_names_of_code_come_from_the_table():
    strings = bytearray()
    entries = [
        symbol("_main", 0x3F4000, more=1),
        symbol("a_name_that_is_long", 0x3F4010, strings=strings),
        symbol("_static", 0x3F4020, kind=3),
        symbol("_again", 0x3F4000),
        symbol(".text", 0x3F4000, kind=3),
        symbol("$C$L1", 0x3F4004, kind=6),
        symbol("_data", 0x8000, section=1),
        symbol("_abs", 0x3F4030, section=-1),
        symbol("_type", 0x3F4031, kind=13),
    ]
    data = with_symbols(coff([Block(0x3F4000, (0x7700,) * 64)]), entries, strings)
    assert coff_files.functions(data) == {0x3F4000: "_main", 0x3F4010: "a_name_that_is_long", 0x3F4020: "_static"}
    assert coff_files.functions(coff([Block(0x3F4000, (0x7700,))])) == {}


@pytest.fixture
def noted():
    """Cycles by address, of interrupts, the stack, the run's cycles and the statistics of a program."""

    def run(name, begin, end, patch=()):
        image = blocks({**program(name).words, **dict(patch)})
        board = core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1, image=image)
        try:
            board.advance(begin)
            before, counted = board.code()["cycles"], board.statistics()["interrupts"]
            board.profile()
            board.advance(end - begin)
            spent, interrupts, stack = board.spent()
            cycles = board.code()["cycles"] - before
            return spent, interrupts, stack, cycles, board.statistics()["interrupts"] - counted
        finally:
            board.close()

    return run


def test_every_cycle_is_somewhere(noted):
    spent, interrupts, stack, cycles, taken = noted("control", 20 * MILLISECOND, 30 * MILLISECOND)
    assert cycles == pytest.approx(10 * MILLISECOND, abs=50)
    assert sum(count for count, *_ in spent.values()) + ENTRY_CYCLES * taken == pytest.approx(cycles, abs=50)
    assert stack == 0x402 + 17, "the call of main, one context, and the call of the law"
    at = program("control").symbols
    ((which, each),) = interrupts.items()
    assert which == (32, at["SAMPLE"])
    assert len(each) == pytest.approx(taken, abs=1)
    inside = sum(count for address, (count, *_) in spent.items() if address >= at["SAMPLE"])
    assert inside + ENTRY_CYCLES * len(each) == pytest.approx(sum(each), abs=200)


def test_what_comes_in_between_is_not_the_interrupts_own(noted):
    at = program("nested").symbols
    alone = noted("nested", 8 * MILLISECOND, 12 * MILLISECOND, {at["ALLOWED"]: 0})[1]
    nested = noted("nested", 8 * MILLISECOND, 12 * MILLISECOND, {at["ALLOWED"]: 1})[1]
    assert set(alone) == set(nested) == {(38, at["TICK"]), (48, at["PERIOD"])}
    lengths = [max(each[48, at["PERIOD"]]) for each in (alone, nested)]
    assert 6900 < lengths[0] < 8100
    assert lengths[1] == pytest.approx(lengths[0], abs=60), "the ticks within are theirs"


def test_functions_reach_to_the_next_name():
    words = (0x7700, 0x7700, 0x0006, 0x28A9, 0x0005, 0x0006)  # NOP, NOP, LRETR; MOV AL,#5, LRETR
    there = Program((Block(0x3F4000, words),))
    spent = {0x3F4000: (4, 3, 0, 0), 0x3F4003: (10, 0, 2, 5), 0x3F4005: (1, 0, 0, 0), 0x8000: (7, 1, 2, 3)}
    rows = timed.functions(there, {0x3F4000: "one", 0x3F4003: "two"}, spent)
    assert [(row.name, row.spent, row.ran, row.end - row.first) for row in rows] == [
        ("two", (11, 0, 2, 5), 3, 3),
        ("one", (4, 3, 0, 0), 1, 3),
    ]
    assert timed.elsewhere(rows, spent) == (7, 1, 2, 3)


def test_a_function_ends_where_its_section_does():
    """Constants behind it are not its own; code without a name goes by its section's."""
    there = Program((Block(0x3F4000, (0x7700, 0x0006, 1, 2, 3, 0x0040, 0x8000)),))
    spent = {0x3F4000: (4, 0, 0, 0), 0x3F4005: (2, 0, 0, 0), 0x8000: (5, 0, 0, 0)}
    sections = {0x3F4000: ".text", 0x3F4002: ".econst", 0x3F4005: "codestart", 0x8000: "ramfuncs"}
    rows = timed.functions(there, {0x3F4000: "main"}, spent, sections)
    assert [(row.name, row.cycles, row.end - row.first) for row in rows] == [
        *(("ramfuncs", 5, 1), ("main", 4, 2), ("codestart", 2, 2))
    ]


def test_a_function_that_runs_from_ram_goes_by_its_name():
    there = Program((Block(0x3F4000, (0x7700, 0x0006, 0x7700, 0x0006)),))
    spent = {
        0x3F4000: (4, 0, 0, 0),
        0x8000: (5, 0, 0, 0),
        0x8001: (7, 1, 2, 3),
        0x8010: (9, 0, 0, 0),
        0x07FF: (2, 0, 0, 0),
        0x010000: (3, 0, 0, 0),
    }
    rows = timed.functions(there, {0x3F4000: "main", 0x8000: "control_isr", 0x8010: "helper"}, spent)
    assert [(row.name, row.cycles, row.copied) for row in rows] == [
        ("control_isr", 12, True),
        ("helper", 9, True),
        ("main", 4, False),
    ]
    assert timed.elsewhere(rows, spent) == (2, 0, 0, 0), "in a memory without a name"
    assert timed.outside(spent) == (3, 0, 0, 0)


def test_bars_have_every_value():
    lines = list(timed.histogram([100] * 3 + [117, 131, 131]))
    assert [int(line.split("#")[0].split()[-1]) for line in lines] == [3, 1, 2]
    assert list(timed.histogram([7, 7])) == [f"    {'7':>16}  {2:>8}  {'#' * 24}"]


def test_vectors_have_ti_s_names():
    names = [vectors.name(number) for number in (32, 37, 48, 127, 13, 14, 16, 18, 19, 20, 31)]
    assert names == [
        *("INT1.1", "INT1.6", "INT3.1", "INT12.8", "INT13", "INT14", "RTOSINT", "NMI", "ILLEGAL", "USER1", "USER12")
    ]


def run_command(image, *more):
    return stillspin("image", "time", image, *more)


def test_the_command_names_interrupts_and_functions(tmp_path):
    image = tmp_path / "control.out"
    image.write_bytes(named("control", ["start", "main", "serial", "vector", "beside", "sample"]))
    done = run_command(image, "--after", "0.02", "--for", "0.01", "--functions", "2")
    assert done.exit_code == 0, done.stderr
    lines = done.stdout.splitlines()
    cycles = re.match(r"control\.out: 0\.01 s, (\d+) cycles, ", lines[0])
    assert abs(int(cycles[1]) - 1_000_000) < 20, "the last instruction at either end may be cut or not"
    assert lines[1].startswith("waited for registers ")
    assert any(line.startswith("INT1.1 sample ") and " 200 " in line for line in lines)
    assert any(line.startswith("beside ") for line in lines)
    assert any(line.startswith("sample ") and "100%" in line for line in lines)
    assert any(line.startswith("and ") and "more" in line for line in lines)
    assert lines[-1] == "stack: up to 0x0413, 19 words from 0x0400"


def test_without_names_there_are_addresses(tmp_path):
    image = tmp_path / "control.hex"
    image.write_bytes(intel_hex([Block(first, tuple(words)) for first, words in blocks(program("control").words)]))
    done = run_command(image, "--after", "0.02", "--for", "0.002")
    assert f"INT1.1 0x{program('control').symbols['SAMPLE']:06X}" in done.stdout
    assert "(no name)" in done.stdout


STACK = """
        .org 0x9000
start:  MOV @SP,#0x200
        LCR below
stay:   SB stay,UNC
below:  ADDB SP,#10
        SUBB SP,#10
        LRETR
"""


@pytest.mark.parametrize(
    ("room", "says"),
    [
        (((b".stack", 0x200, 0x40),), "stack: up to 0x020C, 12 of 64 words from 0x0200"),
        ((), "stack: up to 0x020C"),
    ],
)
def test_a_stack_begins_where_the_program_says(tmp_path, room, says):
    """Below the place where the boot ROM has its own, as many programs of TI's have it."""
    image = tmp_path / "stack.out"
    made = [Block(first, tuple(words)) for first, words in blocks(assemble(STACK).words)]
    image.write_bytes(coff(made, entry=0x9000, empty=room))
    assert run_command(image, "--for", "0.001").stdout.splitlines()[-1] == says


def test_a_program_that_sleeps_for_good_is_said_to_sleep(tmp_path):
    """Also where nothing has woken it: a stretch that begins and ends within its sleep."""
    source = tmp_path / "sleeps.asm"
    source.write_text(
        " .org 0x3F7FF6\n LB start\n .org 0x3F4000\nstart: EALLOW\n MOVW DP,#0x7029>>6\n MOV @0x29,#0x68\n IDLE\n"
        "stay: SB stay,UNC\n"
    )
    image = linked_file(tmp_path, "sleeps", [source])
    done = stillspin("image", "time", image, "--after", "0.005", "--for", "0.01")
    assert done.exit_code == 0, done.stderr
    first, second, *_ = done.stdout.splitlines()
    assert first == "sleeps.out: 0.01 s, 100000 cycles, 0 instructions", "at the 10 MHz of a chip whose PLL is off"
    assert second.endswith("asleep 100.0 %")
