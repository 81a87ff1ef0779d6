#!/usr/bin/env python3
"""Makes the C28x core's decoding table, and the declarations of its operations, from the table of instructions.

Usage: PYTHONPATH=sim_host toolchain/c28x_table.py FOLDER     (writes FOLDER/operations.hpp and FOLDER/forms.cpp)
"""

import re
import sys
from pathlib import Path

from stillspin.c28x.pipeline import phases
from stillspin.c28x.table import Form, forms

MADE = "// Made from sim_host/chip/c28x/instructions.csv by toolchain/c28x_table.py.\n"
LETTERS = ("L", "A", "n", "m", "C", "S", "K", "B")
FIXED = ("loc", "reg", "shift", "cond", "value")
ONE_LESS = ("#1..16", "#2..8")  # a field of these has the shift less one


def _cycles(text: str) -> tuple[int, int]:
    """Cycles of one execution, and of a branch that is not taken."""
    if "/" in text:
        taken, not_taken = text.split("/")
        return int(taken), int(not_taken)
    alone = int(re.sub(r"^5?N\+", "", text))
    return alone, alone


def _row(form: Form) -> str:
    fields = ", ".join("{{{}, {}}}".format(*form.fields.get(letter, (0, 0))) for letter in LETTERS)
    fixed = ", ".join(str(form.fixed.get(name, 0)) for name in FIXED)
    taken, not_taken = _cycles(form.cycles)
    loc_bits = 0 if "L" not in form.fields else 32 if re.search("(loc|mem)32", form.syntax) else 16
    is_signed = "Signed" in form.syntax or "Offset" in form.syntax
    bias = int(any(shift in form.syntax for shift in ONE_LESS))
    flags = [str(flag).lower() for flag in (form.repeatable, "mem" in form.syntax, is_signed)]
    when = phases(form)
    fields_when = (when.early_reg, when.late_reg, when.location_early, when.location_late)
    pipeline = f"0x{when.early:X}, 0x{when.late:X}, " + ", ".join(str(flag).lower() for flag in fields_when)
    return (
        f'    {{"{form.syntax}", 0x{form.opcode:X}, 0x{form.mask:X}, operations::{form.operation}, {form.words}, '
        f"{flags[0]}, {taken}, {not_taken}, {loc_bits}, {flags[1]}, {flags[2]}, {bias}, "
        f"{fields}, {fixed}, {{{pipeline}}}}},\n"
    )


def main() -> None:
    """Write both files."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    names = sorted({form.operation for form in forms()})
    declared = "".join(f"void {name}(Core& core, const Instruction& i);\n" for name in names)
    (folder / "operations.hpp").write_text(
        f'{MADE}#pragma once\n#include "sim_host/chip/c28x/instruction.hpp"\n'
        f"namespace stillspin::c28x::operations {{\n{declared}}}\n"
    )
    rows = "".join(_row(form) for form in forms())
    (folder / "forms.cpp").write_text(
        f'{MADE}#include "made/c28x/operations.hpp"\nnamespace stillspin::c28x {{\n'
        f"const Form kForms[] = {{\n{rows}}};\nconst std::size_t kFormCount = sizeof kForms / sizeof *kForms;\n}}\n"
    )


if __name__ == "__main__":
    main()
