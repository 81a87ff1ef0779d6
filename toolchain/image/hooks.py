"""Which functions are reached through a table, by the words of the table of indirect calls.

`@name` is every function whose address stands in the table of that name; `@name.member`, of a table that the edition
is composed of, every function that is this member of a row. So a feature's functions are named by its own rows alone.
"""

import re
from collections.abc import Iterable, Iterator
from functools import cache

import compose
from checks.calls import DEFINITION, code
from edition_tables import TABLES, Table

from image.elf import ObjectFile, Section

TABLE = re.compile(r"\s\**(\w+)\[\w*\]\s*=\s*\{")
POINTER = 4  # octets of the Cortex-M3
SIZES = {"bool": 2, "uint16_t": 2, "packed_text_t": 2, "int16_t": 2, "uint32_t": 4, "int32_t": 4}


def reached(objects: list[ObjectFile], name: str) -> set[str] | None:
    """The functions behind a table, or behind one member of its rows; None where there is no such table."""
    functions = {symbol.name for obj in objects for symbol in obj.symbols if symbol.is_function}
    sections = list(_sections(objects, name))
    if sections:
        return {called for section in sections for _, _, called in section.relocations} & functions
    table, _, member = name.rpartition(".")
    kind = next((t for key, t in TABLES.items() if t.prefix + key == table), None)
    place = members(kind).get(member) if kind else None
    if place is None:
        return set() if in_other_editions(objects, name) else None
    offset, size = place
    rows = {row for section in _sections(objects, table) for _, _, row in section.relocations}
    found = {
        called
        for row in rows
        for section in _sections(objects, row)
        for at, _, called in section.relocations
        if at % size == offset
    }
    return found & functions


def _sections(objects: Iterable[ObjectFile], name: str) -> Iterator[Section]:
    return (section for obj in objects for section in obj.sections if section.name == f".rodata.{name}")


@cache
def members(table: Table) -> dict[str, tuple[int, int]]:
    """Where the members of a row are, and how long a row is, in octets."""
    kind = table.type.removeprefix("const ")
    struct = re.search(rf"typedef struct \{{([^{{}}]*)\}} {kind};", code(compose.ROOT / table.header))
    places, end = {}, 0
    for line in struct[1].split(";") if struct else ():
        pointer = re.search(r"\(\*(\w+)\)\(|\*\s*(\w+)$", line.strip())
        if member := pointer or re.fullmatch(r"(\w+) (\w+)", line.strip()):
            size = POINTER if pointer else SIZES[member[1]]
            at = -(-end // size) * size
            places[(pointer and pointer[1]) or member[2]] = at
            end = at + size
    length = -(-end // POINTER) * POINTER
    return {name: (at, length) for name, at in places.items()}


def in_other_editions(objects: Iterable[ObjectFile], name: str) -> bool:
    """Whether a feature of which nothing is linked has a function or a table of this name."""
    linked = tuple(obj.path.as_posix().rpartition(".dir/")[2] for obj in objects)
    return any(
        name in _names(feature.name)
        for feature in compose.all_features()
        if not any(path.startswith(f"{feature.name}/") for path in linked)
    )


@cache
def _names(feature: str) -> set[str]:
    """What its sources define."""
    folder = compose.ROOT / "firmware" / feature
    own = [*folder.rglob("*.c"), *(compose.ROOT / source for source in compose.feature_of(feature, folder).replaced)]
    text = "\n".join(code(path) for path in sorted(own))
    return {name for _, name in DEFINITION.findall(text)} | set(TABLE.findall(text))
