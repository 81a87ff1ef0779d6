"""The last instructions that an image executed, with what each of them changed."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from stillspin.c28x.disassembler import disassemble
from stillspin.core_board import NativeBoard
from stillspin.flash.names import Names
from stillspin.image import runaway

_SPOKEN_OF = frozenset({"PC"})
"""Registers that every instruction changes."""
_WORDS = 3
"""Of an instruction and what it repeats."""


def lines(board: NativeBoard, names: Names) -> Iterator[str]:
    """One for each, oldest first: cycle, address, instruction, registers as they are behind it.

    The code is what is in memory now.
    """
    rows = [*board.traced(), (board.code()["cycles"], board.registers())]
    place = ""
    for (cycles, before), (following, after) in pairwise(rows):
        address = before["PC"]
        words = board.words(address, _WORDS)
        here = where(names, address)
        if here != place:
            place = here
            yield f"{place}:"
        text = _text(words, address)
        if runaway.is_illegal(words):
            yield f"{cycles:>12}  0x{address:06X}  {text:<34}      is illegal and traps: the trace ends"
            return
        changed = ", ".join(
            f"{name} {value:X}" for name, value in after.items() if name not in _SPOKEN_OF and value != before[name]
        )
        yield f"{cycles:>12}  0x{address:06X}  {text:<34} {following - cycles:>3}  {changed}".rstrip()


def _text(words: list[int], address: int) -> str:
    """The instruction at the first of these words; with what it repeats, if it is RPT: the two are executed as one."""
    line = disassemble(words, address)
    if not line.text.startswith("RPT "):
        return line.text
    return f"{line.text} || {disassemble(words[line.words :], address + line.words).text}"


def where(names: Names, address: int) -> str:
    """The source line, or the function where there are none."""
    source = names.lines.at(address)
    return str(source) if source else names.function(address).partition("+")[0]
