"""Executables of the C28x's EABI: words, load addresses and names, and where they are not taken."""

import struct

import pytest
from c28x_chip import blocks, program
from elf_files import FUNCTION, OBJECT, SEGMENT_OCTETS, UNTYPED, altered, elf
from in_process import stillspin

from stillspin.errors import InputError
from stillspin.flash import elf as elf_files
from stillspin.flash.files import drive_image, kernel_program, read_program
from stillspin.flash.names import Names
from stillspin.flash.program import Block

BLOCKS = [Block(0x3F4000, (0x7700, 0x1234, 0x0006)), Block(0x9000, (1, 2))]


def test_words_are_where_they_are_loaded(file):
    there = read_program(file(elf(BLOCKS, load={1: 0x3F5000 - 0x9000})))
    assert there.blocks == (BLOCKS[0], Block(0x3F5000, (1, 2)))
    assert (there.entry, there.kind) == (0x3F4000, "ELF")


def test_names_are_those_of_code():
    symbols = [
        ("main", 0x3F4000, 0, FUNCTION), ("label", 0x3F4001, 0, UNTYPED), ("again", 0x3F4000, 0, FUNCTION),
        ("table", 0x3F4002, 0, OBJECT), ("$C$L1", 0x3F4002, 0, UNTYPED), ("data", 0x9000, 1, UNTYPED),
        ("absolute", 0x3F4002, None, UNTYPED),
    ]  # fmt: skip
    assert elf_files.functions(elf(BLOCKS, symbols=symbols)) == {0x3F4000: "main", 0x3F4001: "label"}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (elf(BLOCKS, machine=40), "is an ELF file for an ARM .machine 40., not for the C28x"),
        (elf(BLOCKS, order=b"\x01\x02"), "another processor"),
        (elf(BLOCKS, kind=1), "has not been linked"),
        (elf(BLOCKS)[:60], "cut short"),
        (elf(BLOCKS)[:40], "cut short"),
        (altered(elf(BLOCKS), SEGMENT_OCTETS, 5), "segment 0 is damaged, its size is 5;"),
        (altered(elf(BLOCKS), SEGMENT_OCTETS, 1 << 20), "segment 0 is damaged, its size is 1048576;"),
    ],
)
def test_what_cannot_be_is_said(file, data, words):
    with pytest.raises(InputError, match=words):
        read_program(file(data))


@pytest.mark.parametrize("read", [drive_image, kernel_program])
def test_the_drive_and_its_kernel_are_coff(file, read):
    with pytest.raises(InputError, match="coffabi"):
        read(file(elf(BLOCKS)))


def test_an_image_is_timed_with_its_names(file):
    made = program("control")
    parts = [Block(first, tuple(words)) for first, words in blocks(made.words)]
    code = next(index for index, block in enumerate(parts) if block.address == 0x3F4000)
    symbols = [(name, made.symbols[name.upper()], code, FUNCTION) for name in ("start", "beside", "sample")]
    image = file(elf(parts, symbols=symbols))
    done = stillspin("image", "time", image, "--after", "0.02", "--for", "0.002")
    assert done.exit_code == 0, done.stderr
    assert "INT1.1 sample " in done.stdout
    assert "\nbeside " in done.stdout


def test_a_name_is_found_with_and_without_its_underscore():
    """COFF has `_main` for C's main, the EABI `main`: a file of either answers to both."""
    for there in ("main", "_main"):
        names = Names(addresses={there: 7, "ain": 8})
        assert [names.address(text, "--from") for text in ("main", "_main")] == [7, 7]
        with pytest.raises(InputError, match="'mai' is neither"):
            names.address("mai", "--from")
    both = Names(addresses={"main": 1, "_main": 2})
    assert [both.of_name(text) for text in ("main", "_main", "__main")] == [1, 2, 2]


def test_what_is_copied_may_have_a_segment_at_either_address(file):
    """The EABI's way (SPRAC71): words at the address to load to, nothing but room at the one to run at."""
    there = [BLOCKS[0], Block(0x3F5000, (0x7700, 0x0006))]
    data = elf(there, symbols=[("copied", 0x9000, 2, FUNCTION)], runs={1: 0x9000})
    assert read_program(file(data)).blocks == tuple(there)
    assert elf_files.functions(data) == {0x9000: "copied"}
    rows = [row[1:] for row in elf_files.sections(data)]
    assert rows == [(3, 0x3F4000, 0x3F4000), (2, 0x3F5000, 0x3F5000), (2, 0x9000, None), (100, 0x8000, None)]


def test_a_section_is_loaded_where_its_content_s_segment_says(file):
    """Whatever of the two addresses its own head has."""
    there = [BLOCKS[0], Block(0x3F5000, (0x7700, 0x0006))]
    data = elf(there, runs={1: 0x9000})
    address = data.index(struct.pack("<IIII", 0, 1, 6, 0x3F5000)) + 12
    rows = [row[1:] for row in elf_files.sections(altered(data, address, 0x9000))]
    assert (2, 0x9000, 0x3F5000) in rows
    assert not any(name == "(segment)" and load for name, _, _, load in elf_files.sections(data))
