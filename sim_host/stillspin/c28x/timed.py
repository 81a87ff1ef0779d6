"""What an image's run on the virtual board took: of interrupts, functions, waits, and how much of the code ran."""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from stillspin.c28x.disassembler import disassemble
from stillspin.core_code import Spent
from stillspin.flash import memories
from stillspin.flash.debug_lines import Lines, Source
from stillspin.flash.program import Program

_BARS = 8
_BAR = 24
_UNNAMED = "(no name)"
NO_SECTIONS: Mapping[int, str] = {}


@dataclass(frozen=True)
class Function:
    """A stretch of code from one name to the next, or to the end of its section."""

    name: str
    first: int
    end: int
    spent: Spent
    ran: int
    """Words of instructions that were executed; unknown of code that was copied to where it ran."""
    copied: bool = False

    @property
    def cycles(self) -> int:
        """With all waits."""
        return self.spent[0]


def added(some: Iterable[Spent]) -> Spent:
    """The sum of cycles and waits."""
    cycles, registers, data, fetches = 0, 0, 0, 0
    for one in some:
        cycles, registers, data, fetches = cycles + one[0], registers + one[1], data + one[2], fetches + one[3]
    return cycles, registers, data, fetches


def functions(
    program: Program, names: Mapping[int, str], spent: Mapping[int, Spent], sections: Mapping[int, str] = NO_SECTIONS
) -> list[Function]:
    """Those that the program has, in the order of their cycles; what runs elsewhere than it is loaded goes by its name.

    Args:
        program: its words.
        names: of places in its code, by address.
        spent: cycles and waits by the address of the instruction.
        sections: names of sections by where they begin, for code without a name of its own.
    """
    starts = sorted({*names, *sections, *(block.address for block in program.blocks)})
    made = []
    for first, following in zip(starts, [*starts[1:], 1 << 22], strict=True):
        name = names.get(first) or sections.get(first, _UNNAMED)
        block = next((block for block in program.blocks if block.address <= first < block.end), None)
        if block is None:
            end = min(following, (memories.stretch(first) or range(0)).stop)
            there = [address for address in spent if first <= address < end and program.word(address) is None]
            if there:
                took = added(spent[address] for address in there)
                made.append(Function(name, first, max(there) + 1, took, 0, copied=True))
            continue
        end = min(following, block.end)
        there = [address for address in spent if first <= address < end]
        ran = sum(_length(program, address) for address in there)
        if first in names or there:
            took = added(spent[address] for address in there)
            made.append(Function(name, first, end, took, ran))
    return sorted(made, key=lambda function: -function.cycles)


def _length(program: Program, address: int) -> int:
    words = [word for word in (program.word(address), program.word(address + 1)) if word is not None]
    return disassemble(words, address).words


def by_line(lines: Lines, spent: Mapping[int, Spent]) -> list[tuple[Source, Spent]]:
    """What each source line took, the longest first; code without a line is not in it."""
    found: dict[Source, list[Spent]] = {}
    for address, count in spent.items():
        source = lines.at(address)
        if source is not None:
            found.setdefault(source, []).append(count)
    return sorted(((source, added(counts)) for source, counts in found.items()), key=lambda row: -row[1][0])


def outside(spent: Mapping[int, Spent]) -> Spent:
    """What was spent on addresses that no code can be at: each traps."""
    return added(count for address, count in spent.items() if memories.stretch(address) is None)


def elsewhere(rows: Iterable[Function], spent: Mapping[int, Spent]) -> Spent:
    """What code took that is in none of the rows: copied without a name, or not the program's at all."""
    inside = (count for address, count in spent.items() if memories.stretch(address) is not None)
    everything, known = added(inside), added(row.spent for row in rows)
    cycles, registers, data, fetches = (of_all - of_rows for of_all, of_rows in zip(everything, known, strict=True))
    return cycles, registers, data, fetches


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
