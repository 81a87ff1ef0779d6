#!/usr/bin/env python3
"""A listing of TI's disassembler for the C28x: held against this project's assembler, and made an image of.

Usage: .venv/bin/python toolchain/c28x_listing.py LISTING [--out FILE]

LISTING is what dis2000 writes of a linked file; such listings of programs for this chip are published, and they are
no part of this project. Each instruction is assembled as TI writes it, and has to come to the words beside it; one
that does not is printed. (A move between registers may be either of two codes, of which the text does not tell
which.) FILE is the program as an executable with its names, which the commands for images take; what TI's command
files never load (.reset) is left out. Exit status 0 when all agree, 1 when one does not, 2 for a file without
instructions.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from stillspin.c28x import linked
from stillspin.c28x.assembler import assemble_line
from stillspin.c28x.disassembler import disassemble
from stillspin.c28x.program import Program
from stillspin.errors import InputError

NEVER_LOADED = ".reset"
ENTRIES = ("code_start", "codestart", "_c_int00")
_SECTION = re.compile(r'\s*\.sect\s+"(.+)"\s*')
_LABEL = re.compile(r"([0-9a-f]+):\s+(\S+):\s*")
_ROW = re.compile(r"([0-9a-f]{8})\s+([0-9a-f]{4})(?:\s+(?:\|\|)?\s*(.*?))?\s*")
_REGISTER = re.compile(r"@(X?AR\d|ACC|XT|P|[APT][LH]?|SP)\b")
_OF_A_FUNCTION = re.compile(r"L\d+|\$C\$.*")
"""Labels that are no names."""


class Row(NamedTuple):
    """An instruction as it is listed; data has no text."""

    address: int
    words: list[int]
    text: str

    @property
    def assembled(self) -> str:
        """Why the assembler does not come to its words; empty where it does."""
        if not self.text:
            return ""
        try:
            words = assemble_line(self.text)  # branches say how far, as from address 0
        except InputError as error:
            return str(error)
        if words == self.words or self._is_of_registers:
            return ""
        return "is " + " ".join(f"{word:04x}" for word in words) + " here"

    @property
    def _is_of_registers(self) -> bool:
        """Whether it moves one register to another: there are two codes for that, which are written alike without @."""
        here = disassemble(self.words).text
        return _REGISTER.sub(r"\1", here).replace(" ", "") == self.text.upper().replace(" ", "")


def read(text: str) -> tuple[list[Row], dict[str, int]]:
    """Rows and names of a listing."""
    rows: list[Row] = []
    names: dict[str, int] = {}
    for line in _of_loaded(text):
        if match := _LABEL.fullmatch(line):
            if not _OF_A_FUNCTION.fullmatch(match[2]):
                names.setdefault(match[2], int(match[1], 16))
        elif match := _ROW.fullmatch(line):
            address, word, said = int(match[1], 16), int(match[2], 16), match[3] or ""
            if said or not rows:
                rows.append(Row(address, [word], "" if said.startswith(".") else said))
            else:
                rows[-1].words.append(word)
    return rows, names


def _of_loaded(text: str) -> Iterator[str]:
    section = ""
    for line in text.splitlines():
        match = _SECTION.fullmatch(line)
        section = match[1] if match else section
        if section != NEVER_LOADED:
            yield line


def program(rows: list[Row], names: dict[str, int]) -> Program:
    """As an assembler would have made it."""
    words = {row.address + k: word for row in rows for k, word in enumerate(row.words)}
    return Program(words=words, labels=names)


def main(arguments: list[str]) -> int:
    """Compare, and write the image."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("listing", type=Path)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args(arguments)
    try:
        rows, names = read(given.listing.read_text(encoding="latin-1"))
    except OSError as error:
        print(f"{given.listing}: cannot be read ({error.strerror})", file=sys.stderr)
        return 2
    instructions = [row for row in rows if row.text]
    if not instructions:
        print(f"{given.listing}: has no instructions of dis2000", file=sys.stderr)
        return 2
    wrong = [(row, why) for row in instructions if (why := row.assembled)]
    for row, why in wrong:
        print(f"0x{row.address:06X} {' '.join(f'{word:04x}' for word in row.words)} {row.text}: {why}")
    print(f"{len(instructions)} instructions, {len(wrong)} of them differ")
    if given.out:
        entry = next((names[name] for name in ENTRIES if name in names), instructions[0].address)
        given.out.write_bytes(linked.to_elf(program(rows, names), entry))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
