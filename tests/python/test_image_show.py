"""`stillspin image show`: what an image loads, how full the memories are, and its code as instructions."""

import re
import struct

import flash_files
import pytest
from c28x_chip import linked_file, program
from elf_files import elf
from test_image_time import symbol, with_symbols
from typer.testing import CliRunner

from stillspin import cli
from stillspin.c28x.program import assemble
from stillspin.flash import coff as coff_files
from stillspin.flash.memories import Extent, Filled
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


def test_sections_and_how_full_the_memories_are(tmp_path):
    count = len(blocks()[1].words)
    status, lines, _ = show(tmp_path, blocks())
    assert status == 0
    assert lines == [
        f"some.out: COFF, {count + 5} words, entry 0x3F7FF6",
        "section               words  loaded to  runs at   memory",
        ".ebss                   100  -          0x008000  L0",
        "sect0                     3  0x3E8000   0x3E8000  sector D",
        f"sect1                {count:>6}  0x3F4000   0x3F4000  sector A",
        "sect2                     2  0x3FBFFE   0x3FBFFE  H0 high",
        "L0           100 of 4096 words",
        "H0             2 of 8192 words",
        "RAM          102 of 18432 words",
        "sector D       3 of 16384 words",
        f"sector A  {count:>6} of 16384 words",
        f"flash     {count + 3:>6} of 65536 words",
    ]


def test_what_runs_elsewhere_than_it_is_loaded_takes_both(tmp_path):
    path = tmp_path / "some.out"
    moved = {0x3F4000: (0x9000, 0x3F4000)}  # run address, load address
    there = [Block(0x3F4000, (1, 2, 3)), Block(0x3F5000, (4,))]
    path.write_bytes(flash_files.coff(there, heads_of=lambda address: moved.get(address, (address, address))))
    lines = CliRunner().invoke(cli.app, ["image", "show", str(path)]).stdout.splitlines()
    assert "sect0                     3  0x3F4000   0x009000  sector A, runs in L1" in lines
    assert "L1             3 of 4096 words" in lines
    assert "sector A       4 of 16384 words" in lines


def test_elf_tells_load_addresses_by_its_program_headers(tmp_path):
    path = tmp_path / "some.out"
    path.write_bytes(elf([Block(0x3F4000, (1, 2)), Block(0x9000, (3, 4, 5))], load={1: 0x3F5000 - 0x9000}))
    lines = CliRunner().invoke(cli.app, ["image", "show", str(path)]).stdout.splitlines()
    assert [line.split()[1:5] for line in lines[3:5]] == [
        ["3", "0x3F5000", "0x009000", "sector"],
        ["100", "-", "0x008000", "L0"],
    ]
    assert "L1             3 of 4096 words" in lines
    assert "sector A       5 of 16384 words" in lines


def test_names_of_elf_and_coff_s_long_ones(tmp_path):
    lines = CliRunner().invoke(cli.app, ["image", "show", str(linked_file(tmp_path, "control"))]).stdout.splitlines()
    assert lines[2].split()[0] == ".text0"
    rows = coff_files.sections(with_name(flash_files.coff(blocks()), 2, "a_section_with_a_long_name"))
    assert next(name for name, _, run, _ in rows if run == 0x3E8000) == "a_section_with_a_long_name"


def with_name(data, index, name):
    """The COFF file with a name of a section in its table of strings, behind all."""
    at = 22 + 28 + 48 * index
    table = struct.pack("<I", len(data)) + struct.pack("<I", 0)
    return data[:8] + table + data[16:at] + struct.pack("<II", 0, 4) + data[at + 8 :] + bytes(4) + name.encode() + b"\0"


def test_damaged_names_are_said(tmp_path):
    path = tmp_path / "some.out"
    path.write_bytes(with_symbols(flash_files.coff(blocks()), [symbol("\x01", START)], bytearray()))
    lines = CliRunner().invoke(cli.app, ["image", "show", str(path)]).stdout.splitlines()
    assert lines[1] == "warning: 1 symbol cannot be read: left out"


def test_what_takes_no_memory_is_left_out():
    kinds = {0x01: False, 0x02: True, 0x10: False, 0x20: True, 0x80: True}
    for kind, shown in kinds.items():
        data = bytearray(flash_files.coff([Block(0x3F4000, (1,))]))
        struct.pack_into("<I", data, 22 + 28 + 48 * 2 + 40, kind)
        assert (0x3F4000 in [run for _, _, run, _ in coff_files.sections(bytes(data))]) == shown, hex(kind)


def test_a_word_in_two_sections_counts_once():
    """L0 is there twice, and overlays share their words."""
    extents = [Extent(0x8000, 10, loaded=False), Extent(0x3F8005, 10, loaded=True), Extent(0x8002, 3, loaded=False)]
    assert list(Filled(extents).rows()) == [("L0", 15, 4096), ("RAM", 15, 18432)]


def test_sections_that_are_loaded_to_one_place_are_named(tmp_path):
    status, _, error = show(tmp_path, [Block(0x3F4000, (1, 2, 3)), Block(0x3F4100, (4,)), Block(0x3F4002, (5,))])
    assert status == 2
    assert "its sections sect0 and sect2 are loaded to the same place, 0x3F4002" in error


def test_sections_that_run_at_one_place_are_named(tmp_path):
    """.ebss has 0x8000 to 0x8063; L0 is there again at 0x3F8000."""
    path = tmp_path / "some.out"
    moved = {0x3F4000: (0x3F8063, 0x3F4000), 0x3F5000: (0x8064, 0x3F5000)}
    there = [Block(0x3F4000, (1,)), Block(0x3F5000, (2,))]
    path.write_bytes(flash_files.coff(there, heads_of=lambda address: moved.get(address, (address, address))))
    done = CliRunner().invoke(cli.app, ["image", "show", str(path)])
    assert done.exit_code == 0
    shared = [line for line in done.stdout.splitlines() if "share" in line]
    assert shared == [".ebss and sect0 share 0x008063 to 0x008063: an overlay, or a mistake of the command file"]


FLOATING = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  SB over,EQ
        MOVL XAR7,#table
stay:   B stay,UNC
over:   LCR other
        B stay,UNC
table:  .word 0xE203, 0xE80A
other:  {}
        LRETR
"""


@pytest.mark.parametrize(
    ("code", "found"),
    [
        (".word 0xE2AF, 0x00C4", True),
        ("MOVL XAR6,#0x00E2AF", False),
        ("LB stay\n .word 0xE2AF", False),
        ("BANZ 0x3F4000,AR1--\n .word 0xB5E8", True),
    ],
    ids=["reached", "an operand", "not reached", "a repeated block"],
)
def test_the_first_instruction_of_a_floating_point_unit_is_named(tmp_path, code, found):
    source = tmp_path / "floating.asm"
    source.write_text(FLOATING.format(code))
    image = str(linked_file(tmp_path, "floating", [source]))
    shown = CliRunner().invoke(cli.app, ["image", "show", image])
    assert (shown.exit_code, "other" in shown.stdout.splitlines()[-1]) == (int(found), found)
    run = CliRunner().invoke(cli.app, ["image", "time", image, "--for", "0.001"])
    assert run.exit_code == (2 if found else 0), run.stderr
    assert bool(re.search(r": 0x3F40\w\w other.* is an instruction of a C28x with a floating", run.stderr)) == found


def test_memories_that_are_not_loaded(tmp_path):
    """Variables may lie on registers and tables in the boot ROM, but no content; the OTP takes it."""
    places = (0x0D00, 0x7100, 0x3FF000, 0x3D7800, 0x3D7C00, 0x010000)
    assert [Filled([Extent(place, 2, loaded=False)]).outside for place in places] == [0, 0, 0, 0, 2, 2]
    assert [Filled([Extent(place, 2, loaded=True)]).outside for place in places] == [2, 2, 2, 0, 2, 2]
    status, lines, _ = show(tmp_path, [Block(0x3D7800, (1, 2))])
    assert status == 0
    assert "OTP            2 of 1024 words" in lines


def test_tables_in_the_boot_rom_are_said_to_read_as_0(tmp_path):
    data = bytearray(flash_files.coff([Block(0x3FF000, (1,) * 64), Block(0x3F4000, (1,))]))
    struct.pack_into("<I", data, 22 + 28 + 48 * 2 + 40, 0x02)  # NOLOAD, as TI's linker command files have it
    path = tmp_path / "some.out"
    path.write_bytes(bytes(data))
    done = CliRunner().invoke(cli.app, ["image", "show", str(path)])
    assert done.exit_code == 0
    assert "sect0                    64  -          0x3FF000  boot ROM" in done.stdout.splitlines()
    assert done.stdout.splitlines()[-1].startswith("sect0: tables of the boot ROM, which the virtual chip has not")


def test_what_is_loaded_into_the_boot_rom_is_told_what_its_section_lacks(tmp_path):
    """The reset vector of TI's run-time, where the linker command file forgets that it is there already."""
    status, lines, _ = show(tmp_path, [Block(0x3F7FF6, (0x6F00,)), Block(0x3FFFC0, (0x4000, 0x003F))])
    assert status == 1
    assert lines[-1].startswith("sect1 is loaded into the boot ROM, which has its own words; ")
    assert "TYPE = DSECT (the reset vector)" in lines[-1]
    done = CliRunner().invoke(cli.app, ["image", "time", str(tmp_path / "some.out")])
    assert done.exit_code == 2
    assert "0x3FFFC0 to 0x3FFFC1 is in the boot ROM" in done.stderr
    assert "TYPE = DSECT (the reset vector)" in done.stderr


def test_a_block_over_a_border_counts_in_both(tmp_path):
    _, lines, _ = show(tmp_path, [Block(0x3EBFFF, (1, 2, 3))])
    assert lines[3].endswith("0x3EBFFF   0x3EBFFF  sector D to sector C")
    assert lines[-3:-1] == ["sector D       1 of 16384 words", "sector C       2 of 16384 words"]


def test_words_in_no_memory_are_said_and_make_the_status(tmp_path):
    status, lines, _ = show(tmp_path, [Block(0x007FFE, (1, 2, 3))])
    assert status == 1
    assert lines[-1] == "2 words in no memory of the chip"
    assert lines[3].endswith("registers to L0")


def test_a_format_without_sections_has_blocks(tmp_path):
    path = tmp_path / "some.hex"
    path.write_bytes(flash_files.intel_hex(blocks()))
    lines = CliRunner().invoke(cli.app, ["image", "show", str(path)]).stdout.splitlines()
    assert lines[2] == "(block)                   3  0x3E8000   0x3E8000  sector D"


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
    by_name = CliRunner().invoke(cli.app, [*command, "--code", "sample", "--lines", "4"]).stdout.splitlines()
    assert by_name == listed


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--code", "0x3F5000"), "the image has nothing at 0x3F5000"),
        (("--code", "start"), "'start' is neither an address such as 0x3F4000, nor FILE:LINE, nor a name"),
        (("--code", "0x400000"), "--code: 0x400000 is out of range; 0x000000 … 0x3FFFFF"),
        (("--lines", "0"), "--lines: 0 is out of range; 1 … 65536"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path, arguments, says):
    status, lines, error = show(tmp_path, blocks(), *arguments)
    assert (status, lines) == (2, [])
    assert says in error
    assert error.count("\n") == 1
