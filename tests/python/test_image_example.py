"""A program that starts as TI's run-time and header files let one start, in each form in which cl2000 may link it.

Table of initial values, constructors, functions copied to RAM, keys to the code security, converter, timer, watchdog:
tests/c28x/programs/example.asm. The file has what theirs have: registers as sections without content, erased passwords.
"""

import pytest
from c28x_chip import PROGRAMS, blocks
from elf_files import FUNCTION, elf
from flash_files import coff
from typer.testing import CliRunner

from stillspin import cli
from stillspin.c28x.program import assemble, assemble_files
from stillspin.flash.program import Block
from stillspin.image import opened

RUN, LOAD = 0x8000, 0x3F6000
PASSWORDS = [Block(0x3F7F80, (0,) * 0x76), Block(0x3F7FF8, (0xFFFF,) * 8)]
REGISTERS = (
    *((b"AdcRegs", 0x7100, 26), (b"PieVect", 0x0D00, 256), (b"DevEmuRe", 0x0880, 208), (b"SciaRegs", 0x7050, 16)),
    *((b"ECanaReg", 0x6000, 52), (b"CsmPwlFi", 0x3F7FF8, 8), (b".stack", 0x0400, 0x100)),
)
TURNS, TURN = 99_999, 5
"""Of the delay's loop, and its cycles as TI's examples count them."""


@pytest.fixture(scope="module")
def parts():
    """Names, what is loaded where it runs, and what is copied to RAM."""
    copied = assemble_files([PROGRAMS / "ramfuncs.asm"])
    text = (PROGRAMS / "example.asm").read_text()
    known = {"FLASHED": len(copied.words), "_DSP28x_usDelay": copied.symbols["_DSP28X_USDELAY"]}
    made = assemble(text, symbols=known)
    functions = [(name, made.labels[name], None, FUNCTION) for name in ("_main", "_tick")]
    return made.symbols, [Block(at, tuple(words)) for at, words in blocks(made.words)], Block(
        RUN, tuple(copied.words[address] for address in sorted(copied.words))
    ), functions  # fmt: skip


def files(parts):
    """By what differs: the format, and which of the two addresses of a COFF section is the one to load to."""
    _, there, copied, functions = parts
    everything = [*there, copied, *PASSWORDS]

    def heads(load, run):
        return lambda address: (load, run) if address == RUN else (address, address)

    yield "elf", elf(everything, 0x3F7FF6, symbols=functions, load={len(there): LOAD - RUN})
    yield "coff", coff(everything, heads_of=heads(LOAD, RUN), empty=REGISTERS)
    yield "coff the other way", coff(everything, heads_of=heads(RUN, LOAD), empty=REGISTERS)


@pytest.mark.parametrize("form", ["elf", "coff", "coff the other way"])
def test_it_starts_and_runs(parts, file, form):
    at = parts[0]
    path = file(dict(files(parts))[form])
    image = opened.read(path)
    board = opened.power_on(image, "bench", "A", 1)
    with opened.closing(board, image):
        opened.advance(board, 0.02)

        def value(name, words=1):
            return sum(word << 16 * k for k, word in enumerate(board.words(at[name], words)))

        assert (value("CLOCK"), value("SUM"), value("FAR", 2)) == (100, 66, 0x12345678), "initial values, near and far"
        assert value("BUILT") == 2, "constructors"
        assert value("SECURE") == 0, "erased passwords open the chip"
        assert value("SAMPLE") == pytest.approx(0x8000, abs=0x40), "the board's 1.5 V, left in its word"
        assert value("TICKS") == pytest.approx((board.now / 1e8 - 0.0118) / 1e-4, abs=20)
        assert value("FED") == 1
        assert board.statistics()["resets"] == 0
        assert opened.warnings(board, image) == []


def test_its_registers_are_no_memory_that_is_missing(parts, file):
    path = file(dict(files(parts))["coff"])
    done = CliRunner().invoke(cli.app, ["image", "show", str(path)])
    assert done.exit_code == 0, done.output
    assert "AdcRegs                  26  -          0x007100  registers" in done.stdout
    assert "in no memory of the chip" not in done.stdout


def test_its_delay_takes_the_cycles_that_it_is_written_for(parts, file):
    at = parts[0]
    path = file(dict(files(parts))["elf"])
    image = opened.read(path)
    board = opened.power_on(image, "bench", "A", 1)
    with opened.closing(board, image):
        cycles = []
        for place in ("DELAY", "DELAYED"):
            assert opened.run_to(board, [at[place]], 0.03)
            cycles.append(board.code()["cycles"])
    assert cycles[1] - cycles[0] == pytest.approx(TURNS * TURN, abs=30)
