"""The reference page of the C28x's instructions, from the table that core, assembler and disassembler are made from."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from stillspin.c28x.pipeline import DP, SP, Phases, phases
from stillspin.c28x.table import WORD, Form, forms

_NAMES = {SP: "SP", DP: "DP", **{1 << number: f"XAR{number}" for number in range(8)}}


def page(_root: Path) -> str:
    """All forms, in the order of the table."""
    return "\n".join(_lines())


def counts(_root: Path) -> str:
    """How many there are."""
    all_ = forms()
    names = {form.syntax.split()[0] for form in all_}
    two = sum(form.words == 2 for form in all_)
    repeated = sum(form.repeatable for form in all_)
    return (
        f"The table has {len(all_)} forms of {len(names)} instructions, {two} of them in two words; {repeated} may "
        f"stand behind `RPT`; {len({form.operation for form in all_})} operations carry them out."
    )


def _lines() -> Iterator[str]:
    yield "| form | bits | cycles | `RPT` | status bits | needed early | changed late |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for form in forms():
        when = phases(form)
        cells = (
            f"`{form.syntax}`",
            f"`{_bits(form)}`",
            form.cycles,
            "yes" if form.repeatable else "",
            *(f"`{text}`" if text else "" for text in (_ordered(form.flags), _early(form, when), _late(form, when))),
        )
        yield f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _bits(form: Form) -> str:
    """Ones, zeros, the fields' letters, and x where nothing is decided."""
    width = WORD * form.words
    made = []
    for place in range(width - 1, -1, -1):
        letter = next(
            (name for name, field in form.fields.items() if field.shift <= place < field.shift + field.width), "x"
        )
        made.append(str(form.opcode >> place & 1) if form.mask >> place & 1 else letter)
    text = "".join(made)
    return f"{text[:WORD]} {text[WORD:]}".strip()


def _ordered(flags: frozenset[str]) -> str:
    known = ("N", "Z", "C", "V", "TC", "OVC")
    return " ".join([name for name in known if name in flags] + sorted(flags - set(known)))


def _registers(mask: int, form: Form, of_field: bool, of_location: bool) -> str:
    """Those that are fixed, and those of fields; all forms without a location count as one with an early one."""
    fixed = [name for bit, name in _NAMES.items() if mask & bit]
    return ", ".join(fixed + ["n"] * of_field + ["L"] * (of_location and "L" in form.fields))


def _early(form: Form, when: Phases) -> str:
    return _registers(when.early, form, when.early_reg, when.location_early)


def _late(form: Form, when: Phases) -> str:
    return _registers(when.late, form, when.late_reg, when.location_late)
