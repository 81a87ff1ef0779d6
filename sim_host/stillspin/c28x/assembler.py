"""From text to words: one instruction, as TI writes it. Upper and lower case are the same."""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cache
from typing import NamedTuple

from stillspin.c28x.expression import evaluated
from stillspin.c28x.operands import MODES, OPERANDS, WORDS, Evaluate, location_code, within
from stillspin.c28x.table import PROGRAM, WORD, Field, Form, forms
from stillspin.errors import InputError

FAR = (PROGRAM + 1) // 2


class _Spelling(NamedTuple):
    form: Form
    pattern: re.Pattern[str]
    words: tuple[str, ...]


def _spelling(form: Form, syntax: str) -> tuple[str, _Spelling]:
    mnemonic, _, operands = syntax.partition(" ")
    operands = operands.replace(" ", "")
    parts, at = [], 0
    for match in WORDS.finditer(operands):
        parts += [re.escape(operands[at : match.start()].upper()), OPERANDS[match[0]].pattern]
        at = match.end()
    parts.append(re.escape(operands[at:].upper()))
    return mnemonic, _Spelling(form, re.compile("".join(parts)), tuple(WORDS.findall(operands)))


@cache
def _spellings() -> dict[str, list[_Spelling]]:
    """By mnemonic, short forms first, of these the ones that load a register and do not store one."""
    found: dict[str, list[_Spelling]] = defaultdict(list)
    for form in sorted(forms(), key=lambda form: (form.words, " loc" in form.syntax, -form.fixed_bits)):
        for syntax in filter(None, (form.syntax, form.also)):
            mnemonic, spelling = _spelling(form, syntax)
            found[mnemonic].append(spelling)
    return found


def _modes(text: str, evaluate: Evaluate) -> int:
    if text.startswith("#"):
        return within(evaluate(text[1:]), 0, 0xFF)
    names = re.split("[,|]", text)
    if not set(names) <= set(MODES):
        raise ValueError(f"'{text}' are no status bits")
    return sum(1 << MODES.index(name) for name in names)


def _value(word: str, text: str, width: Field, address: int, evaluate: Evaluate) -> int:
    """What goes into the field of an operand."""
    operand = OPERANDS[word]
    if operand.names:
        if text not in operand.names:
            raise ValueError(f"'{text}' is none of {', '.join(operand.names)}")
        return operand.names.index(text)
    if word == "Mode":
        return _modes(text, evaluate)
    if operand.bits:
        code = location_code(text, operand.bits, evaluate)
        if word.startswith("mem") and 0xA0 <= code <= 0xAD:
            raise ValueError(f"'{text}' is a register: only memory will do")
        return code
    value = evaluate(text)
    if operand.relative:
        value = (value - address + FAR & PROGRAM) - FAR  # across the end of the program memory as well
    most = width.most + operand.bias if operand.most is None else operand.most
    return within(value, operand.least, most) - operand.bias & width.most


def _words(form: Form, values: dict[str, int]) -> list[int]:
    bits = form.opcode
    for letter, value in values.items():
        bits |= value << form.fields[letter].shift
    return [bits >> WORD, bits & 0xFFFF] if form.words == 2 else [bits]


_OTHER_SPELLINGS = tuple(
    (re.compile(pattern), instead)
    for pattern, instead in (
        (r"((?:ADD|SUB|MOV|AND|OR|XOR) ACC,#[^<]+)", r"\1<<#0"),
        (r"((?:ADD|SUB|MOV|AND|OR|XOR) ACC,[^<]+<<)([^#T].*)", r"\1#\2"),
        (r"(MOVH? [^,]+,ACC<<)([^#].*)", r"\1#\2"),
        (r"((?:LSL|LSR|ASR|SFR|LSL64|LSR64|ASR64) [^,]+,)([^#T].*)", r"\1#\2"),
        (r"SPM #(.+)", r"SPM \1"),
        (r"FFCRET (.+)", r"LB \1"),
        (r"INTR EMU", r"INTR EMUINT"),
        (r"SUB ([^,]+),#(.+)", r"ADD \1,#-(\2)"),  # there is no such code of its own
    )
)
"""What the table has no spelling of, as TI's compiler writes it: a shift of 0 left out, `#` left out or not."""


def assemble_line(text: str, address: int = 0, evaluate: Evaluate | None = None) -> list[int]:
    """The words of one instruction.

    Raises:
        InputError: it is no instruction, or an operand is out of range.
    """
    mnemonic, *rest = text.strip().upper().split(None, 1)
    operands = re.sub(r"\s", "", "".join(rest))
    value_of = evaluate or evaluated
    reasons = []
    for spelling in _spellings().get(mnemonic, []):
        match = spelling.pattern.fullmatch(operands)
        if match is None:
            continue
        try:
            values = {
                (letter := OPERANDS[word].letter): _value(word, got, spelling.form.fields[letter], address, value_of)
                for word, got in zip(spelling.words, match.groups(), strict=True)
            }
        except ValueError as error:
            reasons.append(str(error))
            continue
        return _words(spelling.form, values)
    for pattern, instead in _OTHER_SPELLINGS:
        if match := pattern.fullmatch(f"{mnemonic} {operands}"):
            return assemble_line(match.expand(instead), address, evaluate)
    raise InputError(f"'{text.strip()}' is no instruction" + (f": {reasons[-1]}" if reasons else ""))
