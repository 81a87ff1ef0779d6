#!/usr/bin/env python3
r"""The table of the C28x's instructions beside other descriptions of them, row by row.

Usage: .venv/bin/python toolchain/c28x_compare.py DESCRIPTION... [--missing]

A DESCRIPTION is a source file of another disassembler, assembler or decoder, which is no part of this project. Read are
its lines in three shapes, whatever else is in it:

    constexpr uint32_t ABS_ACC = 0xFF56;                            a value; #define, too
    mnem("subcul", 4, "\x56\x17\x00\x00", "\xff\xff\xff\x00")       octets, value and mask
    case 2: //0101 0110 0100 0010 0000 0000 LLLL LLLL QMPYXUL       the bits, 0 and 1 those that are fixed

Compared are mnemonic, number of words, value and, where it is said, mask; operands are written too differently. Of
every row that the table has not so, the place, both encodings and what was decided are printed; the decisions are in
toolchain/c28x/decided.csv. Then how many forms of the table stand in how many of the descriptions; --missing lists
those that stand in none. Exit status 0 when all differences are decided, 1 when one is not, 2 for a file without rows.
"""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Iterator, Sequence
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from stillspin.c28x.table import WORD, Form, forms

DECIDED = Path(__file__).resolve().parent / "c28x/decided.csv"
_VALUE = re.compile(r"^\s*(?:#define|constexpr\s+\w+|(?:static\s+)?const\s+\w+)\s+([A-Z]\w*)\s*=?\s*0x([0-9A-Fa-f]+)")
_OCTETS = re.compile(r'"([a-z]\w*)[^"]*",\s*[24],\s*"((?:\\x[0-9a-f]{2})+)",\s*"((?:\\x[0-9a-f]{2})+)"', re.IGNORECASE)
_GROUP = r"[01A-Za-z.]{4}"
_BITS = re.compile(
    rf"\b([01]{{4}}(?:\s{_GROUP}){{7}}|[01]{{4}}(?:\s{_GROUP}){{3}})[\s,:]+(?:\d+bit\s+)?([A-Z][A-Z0-9]*)"
)


class Row(NamedTuple):
    """An instruction as a description has it: its encoding in two words, where it has one in the upper."""

    place: str
    mnemonic: str
    words: int
    value: int
    mask: int | None
    """None where the description does not say it."""

    @property
    def key(self) -> tuple[str, str, str]:
        """By which it is decided on."""
        return self.mnemonic, self._hex(self.value), "" if self.mask is None else self._hex(self.mask)

    @property
    def text(self) -> str:
        """For people."""
        mnemonic, value, mask = self.key
        return f"{self.place}: {mnemonic} {value}" + (f", mask {mask}" if mask else "")

    def _hex(self, bits: int) -> str:
        return f"{bits >> WORD * (2 - self.words):0{4 * self.words}X}"


class Kind(IntEnum):
    """How a row stands to a form of the table."""

    SAME = 0
    PART = 1
    """Has fixed what is a field in the table."""
    WIDER = 2
    """Has a field of what is fixed in the table."""
    CROSSED = 3


Decisions = dict[tuple[str, str, str], str]


def _upper(bits: int, words: int) -> int:
    return bits << WORD * (2 - words)


def _mnemonics(form: Form) -> set[str]:
    return {text.split()[0] for text in (form.syntax, form.also) if text}


def rows(text: str, name: str, known: set[str]) -> Iterator[Row]:
    """Of a description; only of instructions that are known.

    Args:
        text: of the file.
        name: of the file.
        known: mnemonics.
    """
    for number, line in enumerate(text.splitlines(), start=1):
        row = _row(line, f"{name}:{number}")
        if row and row.mnemonic in known:
            yield row


def _row(line: str, place: str) -> Row | None:
    if found := _VALUE.search(line):
        value = int(found[2], 16)
        words = 2 if value >> WORD else 1
        return Row(place, found[1].split("_")[0], words, _upper(value, words), None)
    if found := _OCTETS.search(line):
        value, mask = (re.sub(r"\\x", "", found[k]) for k in (2, 3))
        words = len(value) // 4
        return Row(place, found[1].upper(), words, *(_upper(int(bits, 16), words) for bits in (value, mask)))
    if found := _BITS.search(line):
        bits = re.sub(r"\s", "", found[1])
        words = len(bits) // WORD
        value, mask = re.sub("[^1]", "0", bits), re.sub("[^1]", "0", bits.replace("0", "1"))
        return Row(place, found[2], words, *(_upper(int(each, 2), words) for each in (value, mask)))
    return None


def kind(row: Row, form: Form) -> Kind | None:
    """How they stand to one another; None: not at all."""
    if row.mnemonic not in _mnemonics(form) or row.words != form.words:
        return None
    opcode, mask = _upper(form.opcode, form.words), _upper(form.mask, form.words)
    if row.mask is None:
        return Kind.SAME if row.value == opcode else None
    if (row.value ^ opcode) & mask & row.mask:
        return None
    if row.value & ~row.mask:
        return Kind.CROSSED
    if row.mask == mask:
        return Kind.SAME
    both = row.mask & mask
    return Kind.PART if both == mask else Kind.WIDER if both == row.mask else Kind.CROSSED


def nearest(row: Row) -> tuple[Kind, Form] | None:
    """The form of the table that a row is, or is next to."""
    found = [(how, number) for number, form in enumerate(forms()) if (how := kind(row, form)) is not None]
    if not found:
        return None
    how, number = min(found)
    return how, forms()[number]


def bits(form: Form) -> str:
    """Its encoding in words: value and mask."""
    width = 4 * form.words
    return f"{form.syntax}: {form.opcode:0{width}X}, mask {form.mask:0{width}X}"


def differences(listed: Sequence[Row]) -> Iterator[tuple[Row, str]]:
    """The rows that the table has not, and what it has in their place."""
    there = covered(listed)
    for row in listed:
        found = nearest(row)
        if found is None:
            same = [bits(form) for form in forms() if not (row.value ^ _upper(form.opcode, form.words)) & _mask(form)]
            yield row, f"the table has {same[0] if same else 'nothing there'}"
        elif found[1] not in there or found[0] not in (Kind.SAME, Kind.PART):
            yield row, f"the table has {bits(found[1])}"


def _mask(form: Form) -> int:
    return _upper(form.mask, form.words)


def covered(listed: Sequence[Row]) -> set[Form]:
    """The forms that rows say as the table does: as they are, or in parts that are all of them."""
    whole: set[Form] = set()
    parts: dict[Form, set[tuple[int, int]]] = {}
    for row in listed:
        there = nearest(row)
        if there and there[0] is Kind.SAME:
            whole.add(there[1])
        elif there and there[0] is Kind.PART and row.mask is not None:
            parts.setdefault(there[1], set()).add((row.value, row.mask))
    for form, pieces in parts.items():
        size = sum(1 << 2 * WORD - mask.bit_count() for _, mask in pieces)
        if size >= 1 << 2 * WORD - _mask(form).bit_count():
            whole.add(form)
    return whole


def decisions(file: Path = DECIDED) -> Decisions:
    """What was decided on differences, by mnemonic, value and mask."""
    with file.open(encoding="utf-8", newline="") as lines:
        return {(r["mnemonic"], r["value"], r["mask"]): r["decision"] for r in csv.DictReader(lines, delimiter=";")}


def compare(files: Sequence[Path], decided: Decisions) -> tuple[int, list[Form]]:
    """Print all of it; gives how many differences nobody has decided on, and the forms that no description has."""
    known = {mnemonic for form in forms() for mnemonic in _mnemonics(form)}
    times = dict.fromkeys(forms(), 0)
    undecided = 0
    for file in files:
        listed = list(rows(file.read_text(encoding="utf-8", errors="replace"), file.name, known))
        if not listed:
            raise ValueError(f"{file}: has no row in one of the three shapes")
        for row, words in differences(listed):
            undecided += row.key not in decided
            print(f"{row.text}; {words}. {decided.get(row.key, 'NOT DECIDED')}")
        there = covered(listed)
        print(f"{file.name}: rows: {len(listed)}; forms of the table in it as they are: {len(there)} of {len(times)}")
        for form in there:
            times[form] += 1
    for count in range(len(files), -1, -1):
        print(f"forms that stand in {count} of {len(files)}: {sum(n == count for n in times.values())}")
    return undecided, [form for form, count in times.items() if not count]


def main(arguments: Sequence[str]) -> int:
    """Gives the exit status."""
    files = [Path(text) for text in arguments if text != "--missing"]
    if not files:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        undecided, missing = compare(files, decisions())
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 2
    if "--missing" in arguments:
        print(*(f"in none: {bits(form)}" for form in missing), sep="\n")
    if undecided:
        print(f"differences that are not decided (toolchain/c28x/decided.csv): {undecided}")
    return 1 if undecided else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
