"""A program in the shapes of a C compiler, in a file as TI's linker leaves one: tests/c28x/programs/compiled.asm."""

import re
import struct

import pytest
from c28x_chip import PROGRAMS
from coff_files import ABSOLUTE, BSS, COPY, DATA, DUMMY, FILE, LABEL, STATIC, TEXT, Named, Part, linked
from elf_files import FUNCTION, UNTYPED, elf
from in_process import stillspin

from stillspin.c28x.program import assemble
from stillspin.flash.program import Block
from stillspin.image import opened

RUN, LOAD, CONST, BEGIN, MAIN = 0x8000, 0x3F6292, 0x3F6100, 0x3F7FF6, 0x3F4000
IN_RAM = """
        .org 0x8000
_InitCpuTimer:
        MOVW DP,#0x0C00>>6
        MOV @2,#4999
        MOV @3,#0
        MOV @4,#0x4020
        LRETR
"""
FUNCTIONS = ("_c_int00", "_exit", "_memcpy", "_main", "_user_isr", "_cpu_timer0_isr", "_rsvd_ISR", "I$$DIV", "FS$$MPY")
EABI = {"I$$DIV": "__c28xabi_divi", "FS$$MPY": "__c28xabi_mpyf"}
REGISTERS = (
    *(("DevEmuRegsFile", 0x0880, 4), ("PieCtrlRegsFile", 0x0CE0, 26), ("PieVectTableFile", 0x0D00, 256)),
    *(("EmuKeyVar", 0x0D00, 1), ("CpuTimer0RegsFile", 0x0C00, 8), ("CsmPwlFile", 0x3F7FF8, 8)),
)


def text(name):
    return (PROGRAMS / f"{name}.asm").read_text()


@pytest.fixture(scope="module")
def made():
    """The program, and what of it runs from RAM."""
    ram = assemble(IN_RAM)
    source = text("compiled").replace('.copy   "runtime.asm"', "") + text("runtime")
    isrs = ["_rsvd_ISR"] * 128
    isrs[20] = isrs[32 + 8] = "_user_isr"  # TRAP #20, and INT2 by hand: its row of the PIE gives the first vector
    isrs[32 + 6] = "_cpu_timer0_isr"
    table = "".join(f" .long {name}\n" for name in isrs)
    known = {"RUN": RUN, "LOAD": LOAD, "SIZE": len(ram.words), "_InitCpuTimer": RUN}
    return assemble(f"{source}\n .org {CONST}\n_PieVectTableInit:\n{table}", symbols=known), ram


def words(program, first, end):
    return tuple(program.words[at] for at in range(first, end) if at in program.words)


def as_coff(made):
    """Long names of sections, dummies, empty ones, words at odd places, long debug information, auxiliary entries."""
    program, ram = made
    parts = [
        Part("$build.attributes", 0, bytes(39), COPY),
        Part("ramfuncs", RUN, words(ram, RUN, RUN + 100), load=LOAD),
        Part("csm_rsvd", 0x3F7F80, (0,) * 0x76),
        *(Part(name, at, size, BSS, page=1) for name, at, size in REGISTERS),
        Part(".pinit", 0x3F6000, 0, BSS),
        Part("codestart", BEGIN, words(program, BEGIN, BEGIN + 2)),
        Part("csmpasswds", 0x3F7FF8, (0xFFFF,) * 8),
        Part(".stack", 0x0050, 0x200, BSS, page=1),
        Part(".ebss", 0x8800, 0x298, BSS, page=1),
        Part(".econst", CONST, words(program, CONST, CONST + 256), DATA),
        Part(".reset", 0x3FFFC0, (0x0040, 0), TEXT | DUMMY),
        Part("vectors", 0x3FFFC2, 0, TEXT | DUMMY),
        Part(".text", MAIN, words(program, MAIN, CONST)),
        Part(".debug_info", 0, bytes(70_001), COPY),
    ]
    at = program.symbols
    symbols = [
        Named("{7B59F295-3030-4813-8466-600627BDA2FC}", 0, -2, FILE),
        Named("$C$FSL1", CONST, ".econst", LABEL),
        Named(".text", MAIN, ".text", STATIC, b"\1"),
        *(Named(name, at[name], ".text", LABEL) for name in ("L1", "L2", "L3")),
        Named("DW$L$_memcpy$2$B", at["L1"], ".text", STATIC),
        *(Named(name, at[name.upper()], ".text") for name in FUNCTIONS),
        Named("_RamfuncsRunStart", RUN, "ramfuncs"),
        Named("_InitCpuTimer", RUN, "ramfuncs"),
        Named("_etext", 0xFFFFFFFF, ABSOLUTE),
        Named("_RamfuncsLoadStart", LOAD, ABSOLUTE),
        Named("__STACK_SIZE", 0x200, ABSOLUTE),
        *(Named(name, at[name.upper()], ".ebss") for name in ("_ticks", "_value", "_caught")),
        Named("_AdcRegs", 0x7100, ABSOLUTE, more=bytes(36)),
    ]
    return linked(parts, symbols, BEGIN)


def as_elf(made):
    program, ram = made
    blocks = [Block(LOAD, words(ram, RUN, RUN + 100)), Block(CONST, words(program, CONST, CONST + 256))]
    blocks += [Block(MAIN, words(program, MAIN, CONST)), Block(BEGIN, words(program, BEGIN, BEGIN + 2))]
    at = program.symbols
    symbols = [(EABI.get(name, name.removeprefix("_")), at[name.upper()], 2, FUNCTION) for name in FUNCTIONS]
    symbols += [("$C$L1", at["L1"], 2, UNTYPED), ("ramfuncs_run", RUN, 4, UNTYPED), ("InitCpuTimer", RUN, 4, FUNCTION)]
    symbols += [(name[1:], at[name.upper()], None, 1) for name in ("_ticks", "_value", "_caught")]
    return elf(blocks, BEGIN, symbols=symbols, runs={0: RUN})


FORMS = {"coff": as_coff, "elf": as_elf}


@pytest.mark.parametrize("form", FORMS)
def test_it_runs(made, file, form):
    image = opened.read(file(FORMS[form](made)))
    board = opened.power_on(image, "bench", "A", 1)
    with opened.closing(board, image):
        opened.advance(board, 0.03)
        place = image.names.address
        ticks, caught = (board.words(place(name, ""), 1)[0] for name in ("_ticks", "_caught"))
        low, high = board.words(place("_value", ""), 2)
        assert opened.warnings(board, image) == []
    value = 1.0
    for _ in range(ticks):
        value = struct.unpack("<f", struct.pack("<f", value * struct.unpack("<f", b"\xcd\xcc\x8c\x3f")[0]))[0]
    assert 30 < ticks < 70
    assert struct.unpack("<f", struct.pack("<HH", low, high))[0] == value
    assert caught == 2


@pytest.mark.parametrize("form", FORMS)
def test_its_functions_are_named_and_nothing_within_them(made, file, form):
    done = stillspin("image", "time", file(FORMS[form](made)), "--for", "0.02", "--functions", "40")
    assert done.exit_code == 0, done.output
    rows = re.findall(r"(?m)^(\S+) +\d+ +[\d.]+%(?: +[\d.]+%){3} +(copied|\d+%)", done.stdout)
    names = {name.removeprefix("_") for name, _ in rows}
    known = [EABI.get(name, name) if form == "elf" else name for name in FUNCTIONS]
    assert {name.removeprefix("_") for name in known} <= names
    assert not names & {"L1", "L2", "L3", "DW$L$_memcpy$2$B", "$C$L1"}
    assert dict(rows)["_InitCpuTimer" if form == "coff" else "InitCpuTimer"] == "copied"
    assert form == "elf" or "codestart" in names, "which nothing in it has named"
    assert "INT1.7" in done.stdout
    assert " of 512 words from 0x0050" in done.stdout or form == "elf"


def test_its_sections_are_listed_by_their_names(made, file):
    done = stillspin("image", "show", file(as_coff(made)))
    assert done.exit_code == 0, done.output
    assert re.search(r"PieVectTableFile +256  - +0x000D00  registers", done.stdout)
    assert re.search(r"ramfuncs +\d+  0x3F6292   0x008000  sector A, runs in L0", done.stdout)
    assert ".reset" not in done.stdout
    assert ".debug_info" not in done.stdout
    assert "share" not in done.stdout, "names for registers and passwords take nothing from others"
    assert "warning" not in done.stdout


def test_an_interrupt_between_any_two_instructions_of_a_routine_changes_nothing(made, file):
    image = file(as_coff(made))
    places = ("--from", "I$$DIV", "--interrupt", "INT1.7", "--compare", "_caught:1")
    done = stillspin("image", "inject", image, *places)
    assert done.exit_code == 0, done.output
    assert "I$$DIV" in done.stdout


def test_a_name_without_an_address_is_no_place(made, file):
    done = stillspin("image", "trace", file(as_coff(made)), "--from", "etext")
    assert done.exit_code == 2
    assert "--from: etext is a number in the image (0xFFFFFFFF), no address" in done.stderr
