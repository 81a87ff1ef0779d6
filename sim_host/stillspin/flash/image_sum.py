"""The check sum that an image carries in its identity, by which the drive tests its flash (hal/hal_image.h)."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

from stillspin.errors import InputError
from stillspin.flash import coff, layout
from stillspin.flash.layout import contains
from stillspin.flash.program import Block, Program

_WORDS = 4
_NONE = 0xFFFFFFFF


def crc_of(words: Iterable[int]) -> int:
    """CRC-32 over words, low octet first, as kernel and drive make it."""
    some = tuple(words)
    return zlib.crc32(struct.pack(f"<{len(some)}H", *some))


def _pair(program: Program, address: int) -> int:
    low, high = program.word(address), program.word(address + 1)
    return _NONE if low is None or high is None else high << 16 | low


def computed(program: Program, end: int) -> int:
    """The sum of what the flash holds once the program is in it, its own place erased."""
    words = [layout.ERASED] * (end - layout.FLASH.start)
    for block in program.blocks:
        if layout.FLASH.start <= block.address < end:
            kept = block.words[: end - block.address]
            at = block.address - layout.FLASH.start
            words[at : at + len(kept)] = kept
    at = layout.SUM - layout.FLASH.start
    words[at : at + 2] = (layout.ERASED, layout.ERASED)
    return crc_of(words)


def check(program: Program, name: str) -> bool:
    """Whether an image has a sum; one without passes.

    Raises:
        InputError: it is not the image's; `name` is the file's.
    """
    end = _pair(program, layout.SUM_END)
    if end == _NONE:
        return False
    if not layout.SUM + 2 <= end <= layout.CSM_RESERVED.start:
        raise InputError(f"{name}: its check sum ends at 0x{end:06X}, outside of the image; the file is damaged")
    wanted, found = _pair(program, layout.SUM), computed(program, end)
    if wanted != found:
        raise InputError(
            f"{name}: its words have the check sum 0x{found:08X}, it says 0x{wanted:08X}; the file is damaged: build "
            "or copy it again"
        )
    return True


def stamp(data: bytes, name: str) -> tuple[bytes, int, int]:
    """A linked COFF file with its check sum; the address behind the last word that it covers; the sum.

    Raises:
        InputError: it is no image of the drive.
    """
    program = coff.read(data, name)
    used = [min(block.end, layout.CSM_RESERVED.start) for block in program.blocks if _is_covered(block)]
    if program.word(layout.IDENTITY) != layout.MARK or program.word(layout.SUM_END + _WORDS - 1) is None:
        raise InputError(f"{name}: has no identity with room for a check sum at 0x{layout.IDENTITY:06X}")
    end = max(used)
    data = coff.patched(data, name, layout.SUM_END, (end & 0xFFFF, end >> 16))
    crc = computed(coff.read(data, name), end)
    return coff.patched(data, name, layout.SUM, (crc & 0xFFFF, crc >> 16)), end, crc


def _is_covered(block: Block) -> bool:
    return contains(layout.FLASH, block.address, len(block.words)) and block.address < layout.CSM_RESERVED.start
