"""What an image's run on the virtual board took: of interrupts, functions, waits, and how much of the code ran."""

from __future__ import annotations

import bisect
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from stillspin.c28x.disassembler import disassemble
from stillspin.flash.program import Program

_BARS = 8
_BAR = 24
_CHANNELS = 8
_PIE_FIRST = 32
_UNNAMED = "(no name)"


@dataclass(frozen=True)
class Function:
    """A stretch of code from one name to the next, or to the end of its block."""

    name: str
    first: int
    end: int
    cycles: int
    ran: int
    """Words of instructions that were executed."""


def vector_name(number: int) -> str:
    """As TI numbers them: INTx.y of the PIE, or the CPU's own."""
    if number >= _PIE_FIRST:
        group, channel = divmod(number - _PIE_FIRST, _CHANNELS)
        return f"INT{group + 1}.{channel + 1}"
    return {18: "NMI", 19: "ILLEGAL"}.get(number, f"INT{number}" if number < 15 else f"vector {number}")


def functions(program: Program, names: Mapping[int, str], spent: Mapping[int, int]) -> list[Function]:
    """Those that the program has, in the order of their cycles.

    Args:
        program: its words.
        names: of places in its code, by address.
        spent: cycles by the address of the instruction.
    """
    starts = sorted({*names, *(block.address for block in program.blocks)})
    made = []
    for first, following in zip(starts, [*starts[1:], 1 << 22], strict=True):
        block = next((block for block in program.blocks if block.address <= first < block.end), None)
        if block is None:
            continue
        end = min(following, block.end)
        there = [address for address in spent if first <= address < end]
        ran = sum(_length(program, address) for address in there)
        cycles = sum(spent[address] for address in there)
        if first in names or cycles:
            made.append(Function(names.get(first, _UNNAMED), first, end, cycles, ran))
    return sorted(made, key=lambda function: -function.cycles)


def _length(program: Program, address: int) -> int:
    words = [word for word in (program.word(address), program.word(address + 1)) if word is not None]
    return disassemble(words, address).words


def elsewhere(program: Program, spent: Mapping[int, int]) -> int:
    """Cycles of code that is not where the program has it: copied to RAM, most of all."""
    return sum(cycles for address, cycles in spent.items() if program.word(address) is None)


def histogram(cycles: Sequence[int]) -> Iterator[str]:
    """Lines of bars, each of the same width in cycles."""
    least, most = min(cycles), max(cycles)
    width = max(-(-(most - least + 1) // _BARS), 1)
    edges = list(range(least, most + 1, width))
    counts = [0] * len(edges)
    for value in cycles:
        counts[bisect.bisect_right(edges, value) - 1] += 1
    for edge, count in zip(edges, counts, strict=True):
        if count:
            bar = "#" * max(1, round(_BAR * count / max(counts)))
            last = min(edge + width - 1, most)
            label = f"{edge}" if edge == last else f"{edge} to {last}"
            yield f"    {label:>16}  {count:>8}  {bar}"
