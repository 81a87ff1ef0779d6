"""Initial values of variables in COFF that is linked with --ram_model: no start-up sets them, who loads the file does.

The section .cinit is one to copy then, and its records are those that the start-up would else read: how many words, the
variable's address, the words; a negative count goes with an address of two words, the lower first; a count of 0 ends.
Source: TI's guides for compiler and linker (SPRU514, SPRU513), and a listing of what they linked.
"""

from __future__ import annotations

import struct

from stillspin.errors import InputError
from stillspin.flash import coff
from stillspin.flash.program import Block

SECTION = ".cinit"
_SIGNED = 0x10000


def read(data: bytes, name: str) -> list[Block]:
    """Those of a file, as blocks to load; `name` is the file's.

    Raises:
        InputError: the table does not come to its end.
    """
    table = coff.words_of(data, SECTION)
    words = struct.unpack(f"<{len(table) // 2}H", table[: len(table) // 2 * 2])
    blocks, at = [], 0
    while at < len(words) and words[at]:
        far = words[at] >> 15
        count = _SIGNED - words[at] if far else words[at]
        first, end = at + 2 + far, at + 2 + far + count
        if end > len(words):
            raise InputError(f"{name}: the initial values in {SECTION} are cut short; link the program again")
        address = words[at + 1] | (words[at + 2] << 16 if far else 0)
        blocks.append(Block(address, words[first:end]))
        at = end
    return blocks
