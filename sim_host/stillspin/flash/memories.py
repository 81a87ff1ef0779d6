"""The memories of the F2808 as a linked file fills them (data sheet, memory map)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from stillspin.flash import layout

_FOLD = 0x3F0000
"""L0, L1 and H0 are there twice: again so much higher, as the same words."""


@dataclass(frozen=True)
class Memory:
    """A stretch of addresses, in words."""

    name: str
    words: range
    loaded: bool = True
    """Whether a probe can put words there."""
    group: str = ""
    """What it is a part of."""
    twice: bool = False


MEMORIES = (
    *(
        Memory(name, range(*words), group="RAM", twice=words[0] >= 0x8000)
        for name, words in zip(("M0", "M1", "L0", "L1", "H0"), layout.RAM, strict=True)
    ),
    Memory("OTP", range(0x3D7800, 0x3D7C00)),
    *(Memory(f"sector {sector.name}", sector.words, group="flash") for sector in layout.SECTORS),
    Memory("sector A", layout.SECTOR_A, group="flash"),
    Memory("registers", range(0x0800, 0x0E00), loaded=False),
    Memory("registers", range(0x6000, 0x8000), loaded=False),
    Memory("boot ROM", layout.BOOT_ROM, loaded=False),
)
NOWHERE = "nowhere"
_STRETCHES = (
    *(range(0x0800), range(0x8000, 0xC000), range(0x3D7800, 0x3D7C00), layout.FLASH, range(0x3F8000, 0x3FC000)),
    layout.BOOT_ROM,
)
"""Where code may be without a gap."""


def at(address: int) -> Memory | None:
    """The one that an address lies in."""
    low = address - _FOLD
    for memory in MEMORIES:
        if address in memory.words or (memory.twice and low in memory.words):
            return memory
    return None


def is_ram(address: int) -> bool:
    """Whether the program can write there, and no register is."""
    memory = at(address)
    return memory is not None and memory.group == "RAM"


def name(address: int) -> str:
    """For people."""
    memory = at(address)
    if memory is None:
        return NOWHERE
    return memory.name if address in memory.words else f"{memory.name} high"


def stretch(address: int) -> range | None:
    """The addresses around one without a gap that code may be at; None where there can be none."""
    return next((words for words in _STRETCHES if address in words), None)


@dataclass(frozen=True)
class Extent:
    """Words from an address on; `loaded` where a file has content for them."""

    address: int
    count: int
    loaded: bool


class Filled:
    """How much of each memory some extents take; a word that several of them have counts once."""

    def __init__(self, extents: Iterable[Extent]) -> None:
        """Of these."""
        self.outside = 0
        """Words that no memory takes."""
        self._parts: dict[Memory, list[tuple[int, int]]] = {memory: [] for memory in MEMORIES}
        for extent in extents:
            taken = 0
            for memory, first, end in _parts(extent):
                self._parts[memory].append((first, end))
                taken += end - first
            self.outside += extent.count - taken

    def of(self, memory: Memory) -> int:
        """Words."""
        count = reached = 0
        for first, end in sorted(self._parts[memory]):
            count += max(end - max(first, reached), 0)
            reached = max(reached, end)
        return count

    def rows(self) -> Iterator[tuple[str, int, int]]:
        """Name, words taken and words there of each memory that is not empty, and of all of its kind."""
        for group in ("RAM", "", "flash"):
            there = [memory for memory in MEMORIES if memory.loaded and memory.group == group]
            used = [(memory, self.of(memory)) for memory in there]
            yield from ((memory.name, count, len(memory.words)) for memory, count in used if count)
            if group and any(count for _, count in used):
                yield group, sum(count for _, count in used), sum(len(memory.words) for memory in there)


def shared(owners: Iterable[tuple[str, Iterable[Extent]]]) -> Iterator[tuple[str, str, int, int]]:
    """Two owners of words and the stretch that both have, first and end by its lower addresses: each pair once.

    Owners of one name are one: ELF tells what is copied twice.
    """
    taken = sorted(
        (first, end, number, name)
        for number, (name, extents) in enumerate(owners)
        for extent in extents
        for _, first, end in _parts(extent)
    )
    for at, (_, end, number, name) in enumerate(taken):
        for other_first, other_end, other_number, other in taken[at + 1 :]:
            if other_first >= end:
                break
            if other_number != number and other != name:
                yield name, other, other_first, min(end, other_end)


def _parts(extent: Extent) -> Iterator[tuple[Memory, int, int]]:
    """Of an extent what lies in each memory that takes it, by its lower addresses."""
    for memory in MEMORIES:
        if extent.loaded and not memory.loaded:
            continue
        for fold in (0, _FOLD) if memory.twice else (0,):
            first = max(extent.address - fold, memory.words.start)
            end = min(extent.address + extent.count - fold, memory.words.stop)
            if first < end:
                yield memory, first, end
