"""What a program used in vain: by name, how often, and from where first.

The virtual chip has it not, or as a chip would lets it not through: protected registers, peripherals without a clock.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from stillspin import resources
from stillspin.core_board import NativeBoard
from stillspin.core_code import Use
from stillspin.counted import counted
from stillspin.flash import memories
from stillspin.flash.names import Names
from stillspin.image import peripherals, runaway

_NAMED = 4
"""So many registers of a peripheral are listed."""
_ROM = "boot ROM"
_REGISTERS = "registers"


@dataclass
class _Used:
    """Of one part of the chip, in the order in which its addresses were first used."""

    uses: list[tuple[int, Use]]

    @property
    def first(self) -> tuple[int, Use]:
        return self.uses[0]

    def counts(self) -> str:
        reads, writes = (sum(use[k] for _, use in self.uses) for k in (0, 1))
        return " and ".join(
            f"{did} {counted(times, 'time')}" for did, times in (("read", reads), ("written", writes)) if times
        )


def said(board: NativeBoard, names: Names) -> list[str]:
    """In words, part by part in the order of their first use; empty where all is modelled."""
    parts: dict[str, _Used] = {}
    for address, use in sorted(board.unmodelled().items(), key=lambda row: row[1][3]):
        parts.setdefault(_part(address), _Used([])).uses.append((address, use))
    ran_away = runaway.cycle(board)
    said_of_parts = [_words(part, used, names, ran_away) for part, used in parts.items()]
    return [*said_of_parts, *_not_let_through(board, names, ran_away)]


def _not_let_through(board: NativeBoard, names: Names, ran_away: int | None) -> Iterator[str]:
    ways = (
        (board.unallowed(), "protected registers were written with EALLOW clear"),
        (board.unclocked(), "a peripheral whose clock is off (PCLKCR0, PCLKCR1) was accessed"),
    )
    for uses, what in ways:
        if uses:
            first = min(uses.items(), key=lambda row: row[1][3])
            times = counted(sum(writes for _, writes, *_ in uses.values()), "time")
            yield f"{what} {times}, {_first(first, names, ran_away)}. It has no effect, as on a chip"


def _first(use: tuple[int, Use], names: Names, ran_away: int | None) -> str:
    address, (_, _, place, cycle) = use
    behind = ran_away is not None and cycle > ran_away
    return f"first {_register(address)} at {names.place(place)}" + (
        ", behind the illegal instruction" if behind else ""
    )


def _part(address: int) -> str:
    if there := peripherals.missing(address):
        return there.name
    memory = memories.at(address)
    return memory.name if memory else ""


def _words(part: str, used: _Used, names: Names, ran_away: int | None) -> str:
    where = _first(used.first, names, ran_away)
    if part == _ROM:
        return (
            f"the boot ROM was {used.counts()}, {where}. Its words (sine, root, inverse of TI's IQ library) are "
            "no part of the virtual chip and read as 0: what is made of them is wrong. Give them with --rom FILE, or"
            f" link IQmathTables into flash ({resources.page('c28x')})"
        )
    ending = f"was {used.counts()}, {where}. Reads give 0, writes are lost"
    if not part:
        return f"the chip has no memory at {_listed(address for address, _ in used.uses)}; it {ending}"
    if part == _REGISTERS:
        return f"no register is known at {_listed(address for address, _ in used.uses)}; it {ending}"
    page = resources.page("chip")
    return f"{part} is not modelled ({_listed(address for address, _ in used.uses)}); it {ending} ({page})"


def _register(address: int) -> str:
    there = peripherals.missing(address)
    return there.register(address) if there else f"0x{address:06X}"


def _listed(addresses: Iterable[int]) -> str:
    all_of_them = list(dict.fromkeys(_register(address) for address in addresses))
    rest = len(all_of_them) - _NAMED
    return ", ".join(all_of_them[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")
