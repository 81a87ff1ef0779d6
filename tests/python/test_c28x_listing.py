"""`toolchain/c28x_listing.py`: listings of TI's disassembler, on a small one made here."""

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "toolchain"))

import c28x_listing

from stillspin import cli

LISTING = """
\t.sect "codestart"
3f8010:              code_start:
003f8010   007f       LB           0x3f8000
003f8011   8000

\t.sect ".text"
3f8000:              _main:
003f8000   28ad       MOV          SP, #0x0400
003f8001   0400
003f8002   3b30       SETC         INTM|DBGM
003f8003   f603       RPT          #3
003f8004   7700    || NOP
3f8005:              L1:
003f8005   0009       BANZ         0,AR1--
003f8006   0000
3f8007:              $C$L1:
003f8007   ec02       SBF          2, EQ
003f8008   f5a9       MOV          AL, *(0:0x0882)
003f8009   0882
003f800a   6f00       SB           0, UNC

\t.sect ".cinit"
003f8012   fffe\t.word 0xfffe
003f8013   0000\t.word 0

\t.sect ".reset"
00000000   8000\t.word 0x8000
00000001   003f\t.word 0x3f
"""


@pytest.fixture
def listing(tmp_path):
    file = tmp_path / "listing.txt"
    file.write_text(LISTING)
    return file


def test_instructions_that_agree_become_an_image(listing, tmp_path, capsys):
    image = tmp_path / "listed.out"
    assert c28x_listing.main([str(listing), "--out", str(image)]) == 0
    assert capsys.readouterr().out == "9 instructions, 0 of them differ\n"
    shown = CliRunner().invoke(cli.app, ["image", "show", str(image)])
    assert shown.stdout.splitlines()[0] == "listed.out: ELF, 15 words, entry 0x3F8010"
    code = CliRunner().invoke(cli.app, ["image", "show", str(image), "--code", "_main", "--lines", "2"])
    assert [line.split("  ", 2)[2] for line in code.stdout.splitlines()] == ["MOV @SP,#0x400", "     SETC INTM,DBGM"]


def test_what_differs_is_named(listing, capsys):
    listing.write_text(LISTING.replace("ec02 ", "ec03 ").replace("NOP", "HALT"))
    assert c28x_listing.main([str(listing)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "0x3F8004 7700 HALT: 'HALT' is no instruction",
        "0x3F8007 ec03 SBF          2, EQ: is ec02 here",
        "9 instructions, 2 of them differ",
    ]


def test_moves_between_registers_have_two_codes_of_one_text(listing, capsys):
    rows = "\n".join(f"0000000{k}   {word}       {text}" for k, (word, text) in enumerate([
        ("1eac", "MOVL         XT, ACC"), ("87a9", "MOVL         XT, ACC"), ("aaa9", "MOVL         ACC, XAR2"),
        ("06a2", "MOVL         ACC, XAR2"), ("aaa9", "MOVL         ACC, XAR3"),
    ]))  # fmt: skip
    listing.write_text(f"{rows}\n")
    assert c28x_listing.main([str(listing)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "0x000004 aaa9 MOVL         ACC, XAR3: is 06a3 here",
        "5 instructions, 1 of them differ",
    ]


def test_what_is_no_listing_is_said(listing, tmp_path, capsys):
    listing.write_text("nothing of the kind\n")
    assert c28x_listing.main([str(listing)]) == 2
    assert c28x_listing.main([str(tmp_path / "none")]) == 2
    assert "has no instructions of dis2000" in capsys.readouterr().err
