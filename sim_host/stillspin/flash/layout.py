"""Where things are on the F2808, in words: hal/hal_flash.h and hal/hal_image.h say the same."""

from __future__ import annotations

from dataclasses import dataclass

RAM = ((0x0000, 0x0400), (0x0400, 0x0800), (0x8000, 0x9000), (0x9000, 0xA000), (0xA000, 0xC000))
"""M0, M1, L0, L1, H0 by their low addresses: first word, end."""
FLASH = range(0x3E8000, 0x3F8000)
UPDATE = range(0x3E8000, 0x3F4000)
"""Sectors D, C, B: what an update erases and writes."""
SECTOR_A = range(0x3F4000, 0x3F8000)
CSM_RESERVED = range(0x3F7F80, 0x3F7FF6)
BOOT_ENTRY = 0x3F7FF6
RAM_ENTRY = 0x000000
"""Where the boot ROM jumps to when its pins say RAM."""
PASSWORDS = range(0x3F7FF8, 0x3F8000)
BOOT_ROM = range(0x3FF000, 0x400000)
SECTOR_WORDS = 0x4000
ERASED = 0xFFFF

IDENTITY = 0x3E8020
IDENTITY_WORDS = 22
SUM_END = IDENTITY + 10
"""Where the image ends that the check sum covers; two words, as the sum."""
SUM = IDENTITY + 12
SUM_WORDS = 4
MARK = 0x5AA5
IDENTITY_FORMAT = 1
CHANGED, DEMONSTRATION = 1, 2
"""Bits of the identity's member `changed`."""

PART = 0x003C
PART_NAME = "TMS320F2808"

KERNEL_RAM = range(0x3FA000, 0x3FC000)
"""H0 by its high address: all that is loaded lies there, so that it can be read back and compared."""
KERNEL_MARK = 0x464B
KERNEL_DEMONSTRATION = 0x464D
"""In the mark's place where the kernel is no program: no host of before loads that."""


@dataclass(frozen=True)
class Sector:
    """One of the sectors that an update writes; `number` is the kernel's."""

    name: str
    number: int
    words: range


SECTORS = (
    Sector("D", 3, range(0x3E8000, 0x3EC000)),
    Sector("C", 2, range(0x3EC000, 0x3F0000)),
    Sector("B", 1, range(0x3F0000, 0x3F4000)),
)


def contains(outer: range, address: int, count: int) -> bool:
    """Whether `count` words from `address` on lie in `outer`."""
    return outer.start <= address and address + count <= outer.stop
