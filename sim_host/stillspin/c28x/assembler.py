"""From text to words: one instruction, or a program with labels.

A program is instructions as TI writes them, `;` before a remark, `label:` before what it names, and directives:

    .org 0x1000         where what follows is
    .set COUNT, 8       a name for a value
    .word 1, COUNT+1    words as they are; .long the same with 32 bits, the lower half first

`||` before the instruction that RPT repeats is read over.
"""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

from stillspin.c28x.operands import MODES, OPERANDS, WORDS, Evaluate, location_code, within
from stillspin.c28x.table import PROGRAM, WORD, Field, Form, forms
from stillspin.errors import InputError

FAR = (PROGRAM + 1) // 2

_TERM = re.compile(r"([+-]?)(0X[0-9A-F]+|\d+|[A-Z_.$][\w.$]*)", re.ASCII)


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
    names = text.split(",")
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


def assemble_line(text: str, address: int = 0, evaluate: Evaluate | None = None) -> list[int]:
    """The words of one instruction.

    Raises:
        InputError: it is no instruction, or an operand is out of range.
    """
    mnemonic, _, rest = text.strip().upper().partition(" ")
    operands = re.sub(r"\s", "", rest)
    value_of = evaluate or _number
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
    raise InputError(f"'{text.strip()}' is no instruction" + (f": {reasons[-1]}" if reasons else ""))


def _number(text: str) -> int:
    return _sum(text, {})


def _sum(text: str, symbols: dict[str, int]) -> int:
    value, at = 0, 0
    while at < len(text):
        match = _TERM.match(text, at)
        if match is None or (at > 0 and not match[1]):
            raise ValueError(f"'{text}' is no value")
        at = match.end()
        term = int(match[2], 0) if match[2][0].isdigit() else symbols.get(match[2])
        if term is None:
            raise ValueError(f"'{match[2]}' has no value")
        value += -term if match[1] == "-" else term
    if not text:
        raise ValueError("a value is missing")
    return value


@dataclass
class Program:
    """Words by address, and the values of the names."""

    words: dict[int, int] = field(default_factory=dict)
    symbols: dict[str, int] = field(default_factory=dict)


class _Pass:
    def __init__(self, symbols: dict[str, int], final: bool) -> None:
        self.program = Program(symbols=dict(symbols))
        self.final = final
        self.at = 0

    def evaluate(self, text: str) -> int:
        try:
            return _sum(text, self.program.symbols)
        except ValueError:
            if self.final or not re.search("[A-Z_.$]", text):
                raise
            return self.at  # a name that comes later: near enough for the choice of a form

    def put(self, words: list[int]) -> None:
        for word in words:
            if self.final and self.at in self.program.words:
                raise InputError(f"two words are at {self.at:#x}")
            self.program.words[self.at] = word & 0xFFFF
            self.at += 1

    def directive(self, name: str, arguments: list[str]) -> None:
        if name == ".SET":
            self.program.symbols[arguments[0]] = self.evaluate(arguments[1])
        elif name == ".ORG":
            self.at = self.evaluate(arguments[0])
        elif name == ".WORD":
            self.put([self.evaluate(text) for text in arguments])
        elif name == ".LONG":
            for text in arguments:
                value = self.evaluate(text)
                self.put([value & 0xFFFF, value >> WORD])
        else:
            raise InputError(f"'{name}' is no directive")

    def line(self, text: str) -> None:
        text = text.partition(";")[0].strip().upper()
        while match := re.match(r"([A-Z_$][\w$]*):\s*", text):
            self.program.symbols[match[1]] = self.at
            text = text[match.end() :]
        text = text.removeprefix("||").strip()
        if text.startswith("."):
            name, _, rest = text.partition(" ")
            self.directive(name, re.sub(r"\s", "", rest).split(","))
        elif text:
            self.put(assemble_line(text, self.at, self.evaluate))


def assemble(source: str) -> Program:
    """A program.

    Raises:
        InputError: a line is no instruction; it is named.
    """
    symbols: dict[str, int] = {}
    for final in (False, True):
        run = _Pass(symbols, final)
        for number, line in enumerate(source.splitlines(), start=1):
            try:
                run.line(line)
            except (InputError, ValueError, IndexError) as error:
                raise InputError(f"line {number}: {error}") from error
        symbols = run.program.symbols
    return run.program
