"""Expressions, macros and conditions of the assembler, and what `toolchain/c28x_iqmath.py` makes of routines."""

import sys
from pathlib import Path

import pytest

from stillspin.c28x.assembler import assemble_line
from stillspin.c28x.expression import evaluated
from stillspin.c28x.program import assemble
from stillspin.errors import InputError

sys.path.append(str(Path(__file__).resolve().parents[2] / "toolchain"))
import c28x_iqmath


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1+2*3", 7), ("(1+2)*3", 9), ("7-2-1", 4), ("1<<4-1", 8), ("0X10+0FH", 31), ("-(3-5)", 2), ("#", None),
        ("A/2+B", 7), ("A>=10&B<3", 1), ("A==10&B==3", 0), ("(A&1)==0", 1), ("A!=10|B!=2", 0), ("7^2", 5),
        ("1+", None), ("(1", None), ("1)", None), ("1 2", None), ("C", None), ("1/0", None), ("1<<99", None),
    ],
)  # fmt: skip
def test_expressions_have_c_s_order(text, value):
    names = {"A": 10, "B": 2}
    if value is None:
        with pytest.raises(ValueError, match=r"value|parenthesis"):
            evaluated(text, names)
    else:
        assert evaluated(text, names) == value


def words(source, **symbols):
    return list(assemble(f" .org 0x100\n{source}\n", symbols=symbols).words.values())


def test_macros_are_written_out_with_their_parameters():
    macro = "PUT .macro VALUE, where\n MOV where,#VALUE+1 ; VALUE\n .endm\n"
    assert words(f"{macro} PUT 4,@AR2\n PUT\t5,@AR3") == words(" MOV @AR2,#5\n MOV @AR3,#6")


def test_conditions_choose_lines_and_macros():
    source = "COUNT .set 3\n .if COUNT > N\n NOP\n .elseif COUNT == N\n .word 1\n .if 0\n .word 9\n .endif\n"
    source += " .else\n .word 2\n .endif"
    assert [words(source, n=n) for n in (2, 3, 4)] == [[0x7700], [1], [2]]
    assert words(" .if 0\n .if N\n .else\n .word 1\n .endif\n .else\n .word 2\n .endif", n=0) == [2]
    choice = "ONE .macro q\n .if q >= 2\n .word q\n .else\n .word 0\n .endif\n .endm\n ONE 1\n ONE 2\n"
    assert words(choice) == [0, 2]


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (" .if 1\n NOP", "no .endif"), (" .endif", "line 2: .endif without"), (" NOP\n .if LATER", "line 3"),
        ("M .macro a\n NOP", "no .endm"), ("M .macro a\n .endm\n M 1,2", "line 4: macro M has 1"),
        ("M .macro\n M\n .endm\n M", "within itself"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_line(source, message):
    with pytest.raises(InputError, match=message):
        words(source)


def test_subtracting_a_constant_is_adding_its_negative():
    assert assemble_line("SUB @AH,#254") == assemble_line("ADD @AH,#-254")
    assert assemble_line("MOVL\t*SP++,ACC") == assemble_line("MOVL *SP++,ACC")


# ---- cycles of routines in TI's form, with a routine of our own in its place

ROUTINE = """;; Benchmark:
;; Cycles = {} (if _IQxTable in 0-wait SARAM)
;;          {} (if _IQxTable in 1-wait ROM)
;;          99 (if Den == 0)
;;
IQNx\t.macro\tq_value
\t\tMOVL\tXAR7,#_IQxTable
\t\tMOVL\tACC,*XAR7++
\t\tADDL\tACC,*XAR7
\t\t.if q_value > 20
\t\tNOP
\t\t.endif
\t\tLRETR
\t\t.endm
\t\t.sect\t"IQmath"
\t\t.if\tGLOBAL_Q == 24
_IQ24x:
\t\tIQNx\tGLOBAL_Q
\t\t.endif
"""
"""Four cycles of the call, one for each of four instructions, four of the return; each read of the table waits."""


@pytest.mark.parametrize(
    ("written", "table"),
    [
        ("SUB ACC,#1", "SUB ACC,#1 << #0"),
        ("ADD ACC,#100 << 4", "ADD ACC,#100 << #4"),
        ("MOV ACC,*-SP[3] << 16", "MOV ACC,*-SP[3] << #16"),
        ("OR ACC,#0x8000<<15", "OR ACC,#0x8000 << #15"),
        ("LSL ACC,1", "LSL ACC,#1"),
        ("ASR AL,3", "ASR AL,#3"),
        ("MOVH @5,ACC << 1", "MOVH @5,ACC << #1"),
        ("MOV *+XAR4[2],ACC << 8", "MOV *+XAR4[2],ACC << #8"),
        ("SPM #0", "SPM 0"),
    ],
)
def test_a_shift_may_be_written_as_the_compiler_writes_it(written, table):
    assert assemble_line(written) == assemble_line(table)


def test_a_shift_by_t_stays_one():
    assert assemble_line("ADD ACC,@5 << T") != assemble_line("ADD ACC,@5 << #1")


def test_a_dollar_is_the_address_of_its_instruction():
    program = assemble(" .org 0x1000\n NOP\n LB $\n SB $-1,UNC\nhere: .word $, $C1\n$C1 .set 7")
    assert [program.words[0x1001 + k] for k in range(2)] == assemble_line("LB 0x1001")
    assert program.words[0x1003] == assemble_line("SB 0x1002,UNC", 0x1003)[0]
    assert (program.words[0x1004], program.words[0x1005]) == (0x1004, 7)


def test_heads_say_cycles_by_memory_and_fraction():
    lines = c28x_iqmath.published(ROUTINE.format(12, 14))
    assert [line.cycles for line in lines] == [12, 14, 99]
    assert [line.cycles for line in lines if line.holds(24, 0)] == [12]
    assert [line.cycles for line in lines if line.holds(24, 1)] == [14]
    more = c28x_iqmath.published(
        ";; Cycles = 65 (30 >= Q >= 24 if x in 0-wait)\n;;        = 64 (1 <= Q <= 23 and x in 0-wait)"
    )
    assert [line.cycles for line in more if line.holds(23, 0)] == [64]
    assert [line.cycles for line in more if line.holds(24, 0)] == [65]


@pytest.mark.parametrize(("said", "status"), [((12, 14), 0), ((15, 11), 0), ((16, 14), 1)])
def test_routines_are_held_against_their_heads(tmp_path, monkeypatch, capsys, said, status):
    (tmp_path / "IQNx.asm").write_text(ROUTINE.format(*said))
    monkeypatch.setattr(sys, "argv", ["c28x_iqmath.py", str(tmp_path)])
    assert c28x_iqmath.main() == status
    rows = [line.split() for line in capsys.readouterr().out.splitlines()[1:]]
    assert [row[:5] for row in rows] == [
        ["_IQ24x", "0", "waits", str(said[0]), "12"],
        ["_IQ24x", "1", "waits", str(said[1]), "14"],
    ]


def test_a_folder_without_routines_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["c28x_iqmath.py", str(tmp_path)])
    assert c28x_iqmath.main() == 2
