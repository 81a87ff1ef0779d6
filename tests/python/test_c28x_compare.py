"""The table of instructions beside other descriptions of them: `toolchain/c28x_compare.py` on small ones made here."""

import sys
from pathlib import Path

import pytest

from stillspin.c28x.table import forms

sys.path.append(str(Path(__file__).resolve().parents[2] / "toolchain"))
import c28x_compare

VALUE = "constexpr uint32_t ABS_ACC = 0xFF56;  // of the accumulator\n"


def octets(bits, words):
    return "".join(f"\\x{octet:02x}" for octet in bits.to_bytes(2 * words, "big"))


def as_values():
    """Of the table: what such a description has no mask for, it says by its value alone."""
    return "".join(f"#define {form.syntax.split()[0]}_{n} 0x{form.opcode:X}\n" for n, form in enumerate(forms()))


def as_octets():
    return "".join(
        f'insert(mnem("{form.syntax.split()[0].lower()}", {2 * form.words}, '
        f'"{octets(form.opcode, form.words)}", "{octets(form.mask, form.words)}"))\n'
        for form in forms()
    )


def as_bits():
    made = []
    for form in forms():
        width = 16 * form.words
        fixed = range(width - 1, -1, -1)
        text = "".join(str(form.opcode >> bit & 1) if form.mask >> bit & 1 else "L" for bit in fixed)
        groups = " ".join(text[at : at + 4] for at in range(0, width, 4))
        made.append(f"        case 0b0101: // {groups} {form.syntax}\n")
    return "".join(made)


@pytest.fixture
def compared(tmp_path, capsys):
    def run(*texts, decided=None):
        files = [tmp_path / f"description{number}" for number in range(len(texts))]
        for file, text in zip(files, texts, strict=True):
            file.write_text(text)
        undecided, missing = c28x_compare.compare(files, decided or {})
        return undecided, missing, capsys.readouterr().out

    return run


@pytest.mark.parametrize("description", [as_octets, as_bits])
def test_a_description_of_the_table_itself_has_no_difference(compared, description):
    undecided, missing, said = compared(description())
    assert undecided == 0
    assert f"rows: {len(forms())}; " in said
    assert missing == []


def test_values_alone_are_compared_as_well(compared):
    """Two forms that begin with one value cannot be told apart by it: the first is meant."""
    undecided, missing, _ = compared(as_values())
    assert undecided == 0
    assert [form.syntax for form in missing] == ["NOP loc16"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("constexpr uint32_t ABS_ACC = 0xFF57;", "ABS FF57; the table has SAT ACC: FF57, mask FFFF"),
        ("#define ABS_ACC 0xFF560000", "ABS FF560000; the table has ABS ACC: FF56, mask FFFF"),
        ("constexpr uint32_t MOV_X = 0xE000;", "MOV E000; the table has nothing there"),
        ('mnem("abs", 2, "\\xff\\x56", "\\xff\\xfe")', "ABS FF56, mask FFFE; the table has ABS ACC: FF56, mask FFFF"),
        (
            'mnem("add", 2, "\\x94\\x00", "\\xff\\x00")',
            "ADD 9400, mask FF00; the table has ADD AX,loc16: 9400, mask FE00",
        ),
        (
            "// 0101 0110 0001 0111 0000 0001 LLLL LLLL SUBCUL ACC,loc32",
            "SUBCUL 56170100, mask FFFFFF00; the table has ",
        ),
        ("// 1111 1111 0101 011. ABS ACC", "ABS FF56, mask FFFE; the table has ABS ACC: FF56, mask FFFF"),
    ],
)
def test_a_row_that_the_table_has_not_is_told_with_both(compared, line, words):
    undecided, _, said = compared(f"{VALUE}\n{line}\n")
    assert undecided == 1
    assert f"description0:3: {words}" in said
    assert said.splitlines()[0].endswith("NOT DECIDED")


def test_parts_that_are_all_of_a_form_are_the_form(compared):
    al = 'mnem("add", 2, "\\x94\\x00", "\\xff\\x00")\n'
    ah = 'mnem("add", 2, "\\x95\\x00", "\\xff\\x00")\n'
    undecided, missing, _ = compared(al + ah)
    assert undecided == 0
    assert "ADD AX,loc16" not in [form.syntax for form in missing]
    assert compared(al + al)[0] == 2


def test_what_was_decided_is_said_and_no_failure(compared):
    undecided, _, said = compared("#define MOV_OLD 0xE000\n", decided={("MOV", "E000", ""): "Object mode 0."})
    assert undecided == 0
    assert said.startswith("description0:1: MOV E000; the table has nothing there. Object mode 0.\n")


def test_other_instructions_and_other_lines_are_no_rows(compared):
    _, missing, said = compared(f"{VALUE}#define ADDF32_X 0xE710\nint x = 0x10; // 0101 of them\n", VALUE)
    assert said.count("rows: 1; forms of the table in it as they are: 1 of ") == 2
    assert "forms that stand in 2 of 2: 1\n" in said
    assert len(missing) == len(forms()) - 1


def test_every_decision_is_one():
    for (mnemonic, value, mask), decision in c28x_compare.decisions().items():
        assert mnemonic in {form.syntax.split()[0] for form in forms()}
        assert len(value) in (4, 8)
        assert len(mask) in (0, len(value))
        assert decision


def test_the_command(tmp_path, capsys):
    file = tmp_path / "x.h"
    file.write_text(VALUE)
    assert c28x_compare.main([str(file), "--missing"]) == 0
    assert "in none: ABORTI: 0001, mask FFFF" in capsys.readouterr().out
    file.write_text(VALUE + "#define ABS_X 0xFF57\n")
    assert c28x_compare.main([str(file)]) == 1
    assert "decided.csv): 1\n" in capsys.readouterr().out
    file.write_text("nothing\n")
    assert c28x_compare.main([str(file)]) == 2
    assert c28x_compare.main([str(tmp_path / "none")]) == 2
    assert c28x_compare.main([]) == 2
