"""How variables get their initial values: by the tables of the EABI's start, and by who loads COFF of --ram_model."""

import struct

import flash_files
import pytest
from c28x_chip import PROGRAMS, blocks
from typer.testing import CliRunner

from stillspin import cli
from stillspin.c28x import linked
from stillspin.c28x.program import assemble
from stillspin.errors import InputError
from stillspin.flash.program import Block
from stillspin.image import opened

NEAR, FAR = 0x9000, 0x3F9800
FIRST_SECTION, SECTION, COPY_OF_DATA = 22 + 28, 48, 0x10 | 0x40
ADDS = f"""
        .org 0x8000
start:  MOVL XAR4,#{NEAR}
        MOVL XAR5,#{FAR}
        MOV AL,*XAR4++
        ADD AL,*XAR4++
        ADD AL,*XAR5++
        MOV *XAR4,AL
stay:   SB stay,UNC
"""
VALUES = (2, NEAR, 100, 20, 0xFFFF, FAR & 0xFFFF, FAR >> 16, 3, 0, 0)


def ram_model(values, *more):
    """COFF whose initial values are a section to copy, as the linker's --ram_model makes it."""
    code = [Block(first, tuple(words)) for first, words in blocks(assemble(ADDS).words)]
    data = bytearray(flash_files.coff([Block(0, values), *code, *more], entry=0x8000))
    head = FIRST_SECTION + 2 * SECTION
    struct.pack_into("<8s", data, head, b".cinit")
    struct.pack_into("<I", data, head + 40, COPY_OF_DATA)
    return bytes(data)


def words_of(path, seconds, address, count):
    image = opened.read(path)
    board = opened.power_on(image, "bench", "A", 1)
    with opened.closing(board, image):
        opened.advance(board, seconds)
        assert opened.warnings(board, image) == []
        return board.words(address, count)


def test_a_program_in_ram_finds_what_its_loader_sets(file):
    assert words_of(file(ram_model(VALUES)), 0.001, NEAR, 3) == [100, 20, 123]


def test_from_the_flash_nobody_sets_them(file):
    path = file(ram_model(VALUES, Block(0x3F7FF6, (0x0040, 0x8000))))
    image = opened.look(path)
    assert image.program.word(NEAR) is None
    assert image.remarks[0].startswith(".cinit: initial values of variables that a debugger would load")


@pytest.mark.parametrize("values", [(3, NEAR, 1), (1,), (0xFFFF, NEAR), (0x8000, 0, 0)])
def test_values_that_are_cut_short_are_said(file, values):
    path = file(ram_model(values))
    with pytest.raises(InputError, match=r"the initial values in \.cinit are cut short; link the program again"):
        opened.look(path)
    done = CliRunner().invoke(cli.app, ["image", "show", str(path)])
    assert done.exit_code == 2


DATA, ZEROED, COPIED, UNPACKED, REPEATED = 0x3F5000, 0x8100, 0x3F9100, 0x8200, 0x3F9200
COPIES, PLAIN_CODE, PACKED_CODE, RAM_CODE = 0x3F5180, 0x3F51A0, 0x3F51C0, 0x8000
BUILT, DONE = 0x9000, 0x9001
MARK = 0xA5A5
PLAIN = [7, 0xFFFF, 0, MARK, 9]
RUNS = [1, 2, MARK, MARK, *[5] * 300, MARK, *[MARK] * 40, 0]
PACKED = [MARK, 1, 2, MARK, 2, MARK, 300, 5, MARK, 1, MARK, 40, MARK, 0, MARK, 0, 0]
"""As the linker packs runs, each kind of length once."""
PATTERN = [*range(30), *range(10, 30), 3, 4, *[6] * 200, *range(5), 0x8000]
IN_RAM = " .org 0x8000\nin_ram: MOVB AL,#20\n LCR other\n LRETR\n .org 0x8040\nother: ADDB AL,#3\n LRETR\n"
"""Two sections that a table of copies brings to RAM: one as it is, the other packed."""


def padded(number, count, *words):
    """A handler's number, then at an even address how many words, then these."""
    return [number, 0, count & 0xFFFF, count >> 16, *words]


def repeated(words):
    """The same words as the linker packs repetitions (LZSS): what is there already goes by its distance and length."""
    tokens, at = [], 0
    while at < len(words):
        most, far = 0, 0
        for back in range(1, min(at, 0xFFE) + 1):
            run = next((k for k in range(len(words) - at) if words[at + k] != words[at - back + k]), len(words) - at)
            most, far = max((most, far), (run, back))
        if most >= 2:
            tokens.append((0, [far - 1 << 4 | min(most - 2, 15), *([most - 17] if most >= 17 else [])]))
        else:
            tokens.append((1, [words[at]]))
        at += most if most >= 2 else 1
    tokens.append((0, [0xFFF << 4]))
    packed = []
    for first in range(0, len(tokens), 16):
        group = tokens[first : first + 16]
        packed += [sum(mark << k for k, (mark, _) in enumerate(group)), *(word for _, some in group for word in some)]
    return packed


def long(*values):
    return [half for value in values for half in (value & 0xFFFF, value >> 16)]


def eabi_parts():
    """Names, and everything that is loaded, in its blocks."""
    code = assemble(IN_RAM)
    plain, packed = (
        [code.words[at] for at in range(first, first + 4) if at in code.words] for first in (0x8000, 0x8040)
    )
    assert len(plain) == 4
    data = {
        DATA: padded(0, 50), DATA + 0x10: padded(1, len(PLAIN), *PLAIN), DATA + 0x40: [2, *PACKED],
        DATA + 0x80: [3, *repeated(PATTERN)], PLAIN_CODE: plain, PACKED_CODE: [3, *repeated(packed)],
        COPIES: [6, 2, *long(PLAIN_CODE, 0x8000, len(plain), PACKED_CODE, 0x8040, 0)],
    }  # fmt: skip
    records = zip(data, (ZEROED, COPIED, UNPACKED, REPEATED), strict=False)
    lines = [f" .org {at}\n .word {','.join(map(str, words))}" for at, words in data.items()]
    return assemble("\n".join([
        f"BUILT .set {BUILT}\nDONE .set {DONE}\nCOPIES .set {COPIES}\nin_ram .set {RAM_CODE}",
        (PROGRAMS / "eabi.asm").read_text(),
        " .org 0x3F5200\nHANDLERS: .long zero_init,copy_none,rle,lzss",
        f"CINIT_BASE: .long {','.join(f'{at},{run}' for at, run in records)}\nCINIT_LIMIT:",
        "INIT_BASE: .long construct,construct\nINIT_LIMIT:",
        *lines,
    ]))  # fmt: skip


def test_the_eabi_s_tables_are_unpacked(file):
    path = file(linked.to_elf(eabi_parts(), 0x3F7FF6))
    assert words_of(path, 0.005, BUILT, 2) == [2, 23], "constructors, and code that was copied"
    assert words_of(path, 0.005, COPIED, len(PLAIN)) == PLAIN
    assert words_of(path, 0.005, UNPACKED, len(RUNS)) == RUNS
    assert len(repeated(PATTERN)) < len(PATTERN) / 3
    assert words_of(path, 0.005, REPEATED, len(PATTERN)) == PATTERN
