"""The forms of the fixed-point C28x instructions, as `chip/c28x/instructions.csv` lists them.

Each row is one form: how it is written, its bits, whether RPT repeats it, its cycles, the status bits it may change and
the operation of the core that carries it out. A letter in the bits is a field:

    L  location (loc16, loc32)        A  AL or AH                 n, m  auxiliary registers
    C  constant or address            S  shift                    K     condition
    B  bit number                     x  free, zero as assembled
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from stillspin.resources import directory

WORD = 16
PROGRAM = 0x3FFFFF
"""The highest address of program memory."""


class Field(NamedTuple):
    """A run of bits of an instruction whose words are read as one number."""

    shift: int
    width: int

    @property
    def most(self) -> int:
        """The largest value it holds."""
        return (1 << self.width) - 1


@dataclass(frozen=True, eq=False)
class Form:
    """One form of an instruction. There is one object of each."""

    syntax: str
    opcode: int
    mask: int
    words: int
    fields: dict[str, Field]
    repeatable: bool
    cycles: str
    flags: frozenset[str]
    operation: str
    fixed: dict[str, int]
    also: str

    @property
    def fixed_bits(self) -> int:
        """How narrow the form is: of two that fit, the one with more fixed bits is meant."""
        return self.mask.bit_count() + (WORD if self.words == 1 else 0)

    def get(self, letter: str, bits: int) -> int:
        """The value of a field in an instruction."""
        field = self.fields[letter]
        return bits >> field.shift & field.most


def _field(letter: str, bits: str) -> Field:
    first, last = bits.index(letter), bits.rindex(letter)
    if set(bits[first : last + 1]) != {letter}:
        raise ValueError(f"field {letter} of {bits} is in pieces")
    return Field(len(bits) - 1 - last, last - first + 1)


def _form(row: dict[str, str]) -> Form:
    bits = row["bits"].replace(" ", "")
    if len(bits) not in (WORD, 2 * WORD) or not re.fullmatch("[01xLAnmCSKB]+", bits):
        raise ValueError(f"{row['syntax']}: {row['bits']} are no bits of one or two words")
    pairs = (word.split("=") for word in row["with"].split())
    return Form(
        syntax=row["syntax"],
        opcode=int(re.sub("[^1]", "0", bits), 2),
        mask=int(re.sub("[^1]", "0", bits.replace("0", "1")), 2),
        words=len(bits) // WORD,
        fields={letter: _field(letter, bits) for letter in sorted(set(bits) - set("01x"))},
        repeatable=row["repeat"] == "Y",
        cycles=row["cycles"],
        flags=frozenset(row["flags"].split()),
        operation=row["operation"],
        fixed={name: int(value, 0) for name, value in pairs},
        also=row["also"],
    )


@cache
def forms() -> tuple[Form, ...]:
    """All forms, in the order of the file."""
    text = (directory("chip/c28x") / "instructions.csv").read_text()
    return tuple(_form(row) for row in csv.DictReader(text.splitlines(), delimiter=";"))


@cache
def _by_first_word() -> dict[int, tuple[Form, ...]]:
    """The forms of each upper byte of a first word, the narrowest first."""
    found: dict[int, list[Form]] = {byte: [] for byte in range(256)}
    for form in sorted(forms(), key=lambda form: -form.fixed_bits):
        drop = WORD * (form.words - 1) + 8
        for byte, there in found.items():
            if (byte ^ form.opcode >> drop) & form.mask >> drop == 0:
                there.append(form)
    return {byte: tuple(there) for byte, there in found.items()}


def find(word0: int, word1: int) -> Form | None:
    """The form of an instruction, None for a word that begins none."""
    for form in _by_first_word()[word0 >> 8]:
        bits = word0 << WORD | word1 if form.words == 2 else word0
        if bits & form.mask == form.opcode:
            return form
    return None
