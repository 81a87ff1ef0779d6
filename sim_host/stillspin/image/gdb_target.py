"""The C28x as GDB's protocol sees it: registers, memory, and the description in XML.

An address counts words of 16 bits, and a unit of memory is such a word: four hexadecimal digits, the low octet first,
as registers are.
"""

from __future__ import annotations

from stillspin.core_board import NativeBoard
from stillspin.flash import memories

REGISTERS = {
    **{"ACC": 32, "P": 32, "XT": 32},
    **{f"XAR{number}": 32 for number in range(8)},
    **{"PC": 32, "RPC": 32},
    **dict.fromkeys(("SP", "DP", "ST0", "ST1", "IFR", "IER", "DBGIER"), 16),
}
"""Bits by name, in the order of `g`."""
NAMES = tuple(REGISTERS)
UNIT = 4
"""Digits of a word."""
_SPACE = 1 << 22
_CODE = {"PC", "RPC"}


def description() -> str:
    """target.xml."""
    kinds = {name: "code_ptr" if name in _CODE else "data_ptr" if name == "SP" else "int" for name in NAMES}
    rows = "".join(
        f'<reg name="{name.lower()}" bitsize="{bits}" type="{kinds[name]}" regnum="{number}"/>\n'
        for number, (name, bits) in enumerate(REGISTERS.items())
    )
    return (
        '<?xml version="1.0"?>\n<!DOCTYPE target SYSTEM "gdb-target.dtd">\n<target version="1.0">\n'
        f'<feature name="org.stillspin.c28x.core">\n{rows}</feature>\n</target>\n'
    )


def digits(value: int, bits: int) -> str:
    """A value, the low octet first."""
    return value.to_bytes(bits // 8, "little").hex()


def value_of(text: str) -> int:
    """The same back. ValueError: it is none."""
    return int.from_bytes(bytes.fromhex(text), "little")


def registers(board: NativeBoard) -> str:
    """All of them."""
    there = board.registers()
    return "".join(digits(there[name], bits) for name, bits in REGISTERS.items())


def set_registers(board: NativeBoard, text: str) -> None:
    """All of them. ValueError: not as many."""
    if len(text) != sum(REGISTERS.values()) // 4:
        raise ValueError("not the digits of all registers")
    at = 0
    for name, bits in REGISTERS.items():
        set_register(board, name, text[at : at + bits // 4])
        at += bits // 4


def set_register(board: NativeBoard, name: str, text: str) -> None:
    """One of them, where that changes it: the program counter's pipeline begins anew. ValueError: no such value."""
    value = value_of(text)
    if len(text) != REGISTERS[name] // 4:
        raise ValueError(f"not the digits of {name}")
    if board.registers()[name] != value:
        board.set_register(name, value)


def memory(board: NativeBoard, address: int, count: int) -> str:
    """Words from an address on. ValueError: beyond the end."""
    if not 0 <= address <= address + count <= _SPACE:
        raise ValueError("no such address")
    return "".join(digits(word, 16) for word in board.words(address, count))


def is_there(address: int) -> bool:
    """Whether there is a word to watch: of a memory, or a register."""
    return memories.at(address) is not None


def set_memory(board: NativeBoard, address: int, text: str) -> None:
    """The same back, into RAM or flash. ValueError: there is none of them, or no whole words."""
    if len(text) % UNIT:
        raise ValueError("not whole words")
    board.put([(address, [value_of(text[at : at + UNIT]) for at in range(0, len(text), UNIT)])])
