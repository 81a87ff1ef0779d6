"""The tables of toolchain/f2808: registers, fields, vectors, values, pins, memory of the TMS320F2808."""

import csv
from dataclasses import dataclass
from pathlib import Path

FOLDER = "toolchain/f2808"


@dataclass(frozen=True)
class Register:
    """A register and its copies: `count` of them, numbered from `first`, `step` words apart."""

    block: str
    name: str
    address: int
    first: int
    count: int
    step: int
    width: int
    access: str  # of free, eallow, read, flash; "32" when it may only be accessed as a whole
    known_from: str


@dataclass(frozen=True)
class Field:
    """Bits of a register."""

    block: str
    register: str
    name: str
    lsb: int
    bits: int
    known_from: str

    @property
    def mask(self) -> int:
        """The field's bits in their place."""
        return ((1 << self.bits) - 1) << self.lsb


def read(root: Path, table: str) -> list[dict[str, str]]:
    """The rows of one table."""
    with (root / FOLDER / f"{table}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def read_registers(root: Path) -> list[Register]:
    """Every register."""
    return [
        Register(
            row["block"],
            row["register"],
            int(row["address"], 16),
            int(row["first"] or 0),
            int(row["count"]),
            int(row["step"] or "0", 16),
            int(row["width"]),
            row["access"],
            row["known_from"],
        )
        for row in read(root, "registers")
        if not row["field"]
    ]


def read_fields(root: Path) -> list[Field]:
    """Every field."""
    return [
        Field(row["block"], row["register"], row["field"], int(row["lsb"]), int(row["bits"]), row["known_from"])
        for row in read(root, "registers")
        if row["field"]
    ]
