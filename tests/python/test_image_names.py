"""Tables of symbols that are damaged: what can be read is used, and how much could not is said."""

import struct

import pytest
from c28x_chip import blocks, program
from elf_files import FUNCTION, elf
from flash_files import coff
from in_process import stillspin
from test_image_time import symbol, with_symbols

from stillspin.flash import names
from stillspin.flash.program import Block

CODE = [Block(0x3F4000, (0x7700,) * 64)]
ELF_SYMBOLS = [
    ("_main", 0x3F4000, 0, FUNCTION),
    ("_other", 0x3F4010, 0, FUNCTION),
    ("_third", 0x3F4020, 0, FUNCTION),
]


@pytest.fixture
def read(file):
    return lambda data: names.read(file(data))


def coff_with(spoilt=b""):
    """Three symbols; in the place of the second these octets of a head."""
    strings = bytearray()
    entries = [
        symbol("_main", 0x3F4000),
        symbol("_a_long_name", 0x3F4010, strings=strings),
        symbol("_third", 0x3F4020),
    ]
    entries[1] = spoilt + entries[1][len(spoilt) :]
    return with_symbols(coff(CODE), entries, strings)


@pytest.mark.parametrize("spoilt", [struct.pack("<II", 0, 0x7FFFFFFF), b"\x01\xff\x80abc\x07d"])
def test_one_damaged_symbol_of_coff_goes_alone(read, spoilt):
    assert not read(coff_with()).damage
    there = read(coff_with(spoilt))
    assert there.functions == {0x3F4000: "_main", 0x3F4020: "_third"}
    assert there.addresses == {"_main": 0x3F4000, "_third": 0x3F4020}
    assert there.damage == ["1 symbol cannot be read: left out"]


def test_one_damaged_symbol_of_elf_goes_alone(read):
    data = elf(CODE, symbols=ELF_SYMBOLS)
    assert not read(data).damage
    second = data.index(struct.pack("<II", 7, 0x3F4010))  # where its name is, and its value
    there = read(data[:second] + struct.pack("<I", 0x7FFFFFFF) + data[second + 4 :])
    assert there.functions == {0x3F4000: "_main", 0x3F4020: "_third"}
    assert there.damage == ["1 symbol cannot be read: left out"]


def test_a_table_that_is_cut_short_has_those_before(read):
    strings = bytearray()
    entries = [symbol(f"_f{k}", 0x3F4000 + k, strings=strings) for k in range(4)]
    data = with_symbols(coff(CODE), entries, strings)
    there = read(data[: -(4 + len(strings)) - 20])
    assert there.functions == {0x3F4000: "_f0", 0x3F4001: "_f1"}
    assert there.damage == ["2 symbols cannot be read: left out"]


def test_symbols_without_their_texts_are_counted(read):
    data = elf(CODE, symbols=ELF_SYMBOLS)
    link = len(data) - 2 * 40 + 24  # of the table of symbols, the last but one of the sections
    there = read(data[:link] + struct.pack("<I", 999) + data[link + 4 :])
    assert not there.functions
    assert there.damage == ["3 symbols cannot be read: left out"]


def test_a_symbol_without_a_name_is_no_damage(read):
    data = with_symbols(coff(CODE), [symbol("", 0x3F4000), symbol("_main", 0x3F4001)], bytearray())
    there = read(data)
    assert there.functions == {0x3F4001: "_main"}
    assert not there.damage


def test_the_commands_say_it(tmp_path):
    made = program("control")
    parts = [Block(first, tuple(words)) for first, words in blocks(made.words)]
    entries = [symbol(name, made.symbols[name.upper()]) for name in ("start", "sample")]
    spoilt = struct.pack("<II", 0, 0x7FFFFFFF) + entries[0][8:]
    file = tmp_path / "control.out"
    file.write_bytes(with_symbols(coff(parts), [spoilt, entries[1]], bytearray()))
    done = stillspin("image", "time", file, "--after", "0.02", "--for", "0.002")
    assert done.exit_code == 0, done.stderr
    assert "INT1.1 sample" in done.stdout
    assert done.stdout.splitlines()[-1] == "warning: control.out: 1 symbol cannot be read: left out"
