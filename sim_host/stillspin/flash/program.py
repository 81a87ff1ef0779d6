"""A program as words at addresses, whatever file it came from."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from stillspin.errors import InputError


@dataclass(frozen=True)
class Block:
    """Words in a row."""

    address: int
    words: tuple[int, ...]

    @property
    def end(self) -> int:
        """The address behind the last word."""
        return self.address + len(self.words)


@dataclass(frozen=True)
class Program:
    """Blocks in order of their addresses, neighbours joined; none overlaps another."""

    blocks: tuple[Block, ...]
    entry: int | None = None
    kind: str = field(default="", compare=False)
    """The file's format, for people."""

    @property
    def size(self) -> int:
        """Words in all."""
        return sum(len(block.words) for block in self.blocks)

    def word(self, address: int) -> int | None:
        """The word at an address, if there is one."""
        for block in self.blocks:
            if block.address <= address < block.end:
                return block.words[address - block.address]
        return None


Part = tuple[str, int, int, int | None]
"""A section: its name, words, where it runs, and where it is loaded if it is."""


def assemble(blocks: Iterable[Block], entry: int | None, kind: str, name: str, parts: Iterable[Part] = ()) -> Program:
    """A program of blocks as a file has them, in any order; `parts` are its sections, to name those that overlap.

    Raises:
        InputError: two say something about one word, or there is none; `name` is the file's.
    """
    joined: list[Block] = []
    for block in sorted((block for block in blocks if block.words), key=lambda block: block.address):
        if joined and joined[-1].end > block.address:
            raise InputError(f"{name}: {_twice(block.address, parts)}")
        if joined and joined[-1].end == block.address:
            joined[-1] = Block(joined[-1].address, joined[-1].words + block.words)
        else:
            joined.append(block)
    if not joined:
        raise InputError(f"{name}: has nothing to load")
    return Program(tuple(joined), entry, kind)


def _twice(address: int, parts: Iterable[Part]) -> str:
    there = [name for name, words, _, load in parts if load is not None and load <= address < load + words]
    if len(there) < 2:
        return f"defines word 0x{address:06X} twice; the file is damaged"
    return (
        f"its sections {' and '.join(there)} are loaded to the same place, 0x{address:06X}: the linker command file "
        "has to give each its own"
    )


@contextmanager
def complete(kind: str, name: str) -> Iterator[None]:
    """While a file of a kind is taken apart, which may end too early.

    Raises:
        InputError: it did.
    """
    try:
        yield
    except struct.error:
        raise InputError(f"{name}: the {kind} file is cut short; copy it again") from None
