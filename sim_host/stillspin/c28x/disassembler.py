"""From words to text. What it writes the assembler turns into the same words again."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from stillspin.c28x.operands import MODES, OPERANDS, WORDS, location_text
from stillspin.c28x.table import PROGRAM, WORD, Form, find


class Line(NamedTuple):
    """One instruction, or one word that is none."""

    text: str
    words: int
    form: Form | None


def _modes(value: int) -> str:
    names = [name for k, name in enumerate(MODES) if value >> k & 1]
    return ",".join(names) if names else "#0"


def _signed(value: int, width: int) -> int:
    return value - (1 << width) if value >> (width - 1) else value


def _operand(word: str, form: Form, bits: int, address: int) -> str:
    """Raises LookupError for what the form cannot have: a register where memory is meant, a shift out of range."""
    operand = OPERANDS[word]
    value = form.get(operand.letter, bits)
    if operand.names:
        return operand.names[value]
    if word == "Mode":
        return _modes(value)
    if operand.bits:
        text = location_text(value, operand.bits)
        if text is None or (word.startswith("mem") and 0xA0 <= value <= 0xAD):
            raise LookupError(text)
        return text
    if operand.relative or word.endswith("Signed"):
        value = _signed(value, form.fields["C"].width)
    if operand.relative:
        value = (address + value) & PROGRAM
    if operand.letter == "S" and value + operand.bias < operand.least:
        raise LookupError(word)
    number = str(value + operand.bias) if operand.letter in "SB" else f"{value:#x}"
    # The pattern of an operand has its number as the only group: what is around it is written as it is.
    around = {"#": "#{}", "*(0:16bit)": "*(0:{})", "*(pma)": "*({})", "*(PA)": "*({})", "0:pma": "0:{}"}
    return around.get(word, around["#"] if word.startswith("#") else "{}").format(number)


def disassemble(words: Sequence[int], address: int = 0) -> Line:
    """The instruction at the beginning of `words`, which is at `address`."""
    form = find(words[0], words[1] if len(words) > 1 else 0)
    nothing = Line(f".word {words[0]:#06x}", 1, None)
    if form is None or len(words) < form.words:
        return nothing
    bits = words[0] << WORD | words[1] if form.words == 2 else words[0]
    mnemonic, _, operands = form.syntax.partition(" ")

    def written(match: re.Match[str]) -> str:
        return _operand(match[0], form, bits, address)

    return _line(form, mnemonic, operands, written) or nothing


def _line(form: Form, mnemonic: str, operands: str, written: Callable[[re.Match[str]], str]) -> Line | None:
    try:
        text = WORDS.sub(written, operands)
    except LookupError:
        return None
    return Line(f"{mnemonic} {text}".rstrip(), form.words, form)
