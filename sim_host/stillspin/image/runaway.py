"""A program that has run away: where it first came to what is no instruction, and what that usually means."""

from __future__ import annotations

from stillspin.c28x.disassembler import disassemble
from stillspin.core_board import NativeBoard
from stillspin.flash import layout, memories
from stillspin.flash.names import Names

_TRAPS = frozenset({"ITRAP0", "ITRAP1"})
_EMPTY = 0x0000
_POINTER = "a return address or a pointer to a function was overwritten or never set (has the stack grown into it?)"


def is_illegal(words: list[int]) -> bool:
    """Whether the first of these words traps."""
    line = disassemble(words)
    return line.form is None or line.text in _TRAPS


def cycle(board: NativeBoard) -> int | None:
    """In which it first came to what is no instruction; None: never, as far as is known."""
    rows = board.traced()
    if not rows or (len(rows) > 1 and not is_illegal(board.words(rows[-1][1]["PC"], 2))):
        return None
    return rows[-1][0]


def said(board: NativeBoard, names: Names) -> str:
    """In words, with the place and the call before it; empty where no illegal instruction was executed.

    A trace that was asked for ends with it, and is not told from one that did not come to its end: where the last
    instruction of several looks legal by now, nothing is said.
    """
    when = cycle(board)
    if when is None:
        return ""
    before = board.traced()[-1][1]
    place, last_call = before["PC"], before["RPC"]
    called = f", the last call returns to {names.place(last_call)}" if memories.stretch(last_call) else ""
    return (
        f"the program came to an illegal instruction at {_where(place, names)}, in cycle {when}{called}. "
        f"It trapped there (vector 19). Usually: {_usually(place, board.words(place, 1)[0])}"
    )


def _where(place: int, names: Names) -> str:
    memory = memories.at(place)
    if memory is None:
        return f"0x{place:06X}, where the chip has no memory"
    named = names.place(place) if names.function(place) != f"0x{place:06X}" else f"0x{place:06X}"
    return f"{named}, {memories.name(place)}"


def _usually(place: int, word: int) -> str:
    if place in layout.BOOT_ROM:
        return "a function of the boot ROM was called, whose code the virtual chip has not: link it into flash"
    if memories.stretch(place) is None:
        return _POINTER
    if word == layout.ERASED:
        return f"nothing was loaded there; or {_POINTER}"
    if word == _EMPTY and place in layout.FLASH:
        return "it is ITRAP0, which somebody wrote there, or data"
    if word == _EMPTY:
        return f"code that runs from RAM was not copied there before it was called; or {_POINTER}"
    return "it is data, or code of a C28x with a floating-point unit, which an F2808 has not (--float_support)"
