"""How operands are written: locations, conditions, status bits, constants."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

CONDITIONS = (
    *("NEQ", "EQ", "GT", "GEQ", "LT", "LEQ", "HI", "HIS", "LO", "LOS", "NOV", "OV", "NTC", "TC", "NBIO", "UNC"),
)
MODES = ("SXM", "OVM", "TC", "C", "INTM", "DBGM", "PAGE0", "VMAP")
"""The status bits of SETC and CLRC, from the lowest bit of their constant."""
INTERRUPTS = (*(f"INT{n}" for n in range(1, 15)), "DLOGINT", "RTOSINT")
PRODUCT_SHIFTS = ("+1", "0", "-1", "-2", "-3", "-4", "-5", "-6")
"""By the value of PM."""

_INDIRECT = {
    **{f"*XAR{n}++": 0x80 + n for n in range(8)},
    **{f"*--XAR{n}": 0x88 + n for n in range(8)},
    **{f"*+XAR{n}[AR0]": 0x90 + n for n in range(8)},
    **{f"*+XAR{n}[AR1]": 0x98 + n for n in range(8)},
    **{f"*,ARP{n}": 0xB0 + n for n in range(8)},
    **{"*BR0++": 0xAE, "*BR0--": 0xAF, "*": 0xB8, "*++": 0xB9, "*--": 0xBA, "*0++": 0xBB, "*0--": 0xBC},
    **{"*SP++": 0xBD, "*--SP": 0xBE, "*AR6%++": 0xBF},
    **{f"*+XAR{n}[{k}]": 0xC0 + 8 * k + n for n in range(8) for k in range(8)},
}
_WORDS = {
    **{f"@AR{n}": 0xA0 + n for n in range(8)},
    **{"@AH": 0xA8, "@AL": 0xA9, "@PH": 0xAA, "@PL": 0xAB, "@TH": 0xAC, "@SP": 0xAD},
}
_LONGS = {**{f"@XAR{n}": 0xA0 + n for n in range(8)}, "@ACC": 0xA9, "@P": 0xAB, "@XT": 0xAC}
_REGISTERS = {16: _WORDS, 32: _LONGS}
_NAMES = {bits: {code: text for text, code in {**_INDIRECT, **there}.items()} for bits, there in _REGISTERS.items()}
_OTHER = {
    **{"@T": "@TH", "T": "@TH"},
    **{f"*XAR{n}": f"*+XAR{n}[0]" for n in range(8)},
    **{f"*ARP{n}": f"*,ARP{n}" for n in range(8)},
}
"""How else TI writes a location, its disassembler among them."""

Evaluate = Callable[[str], int]
"""The value of an expression. ValueError: it is none."""


def location_text(code: int, bits: int) -> str | None:
    """How the location of 16 or 32 bits with this code is written, None for a register of the other width."""
    if code < 0x40:
        return f"@{code}"
    if code < 0x80:
        return f"*-SP[{code - 0x40}]"
    return _NAMES[bits].get(code)


def location_code(text: str, bits: int, evaluate: Evaluate) -> int:
    """The code of a location.

    Raises:
        ValueError: it is no location of that many bits.
    """
    text = _OTHER.get(text, text)
    there = _REGISTERS[bits]
    for known in (text, f"@{text}"):
        if known in there:
            return there[known]
    if text in _INDIRECT:
        return _INDIRECT[text]
    if match := re.fullmatch(r"\*-SP\[(.+)\]", text):
        return 0x40 + within(evaluate(match[1]), 0, 63)
    if match := re.fullmatch(r"\*\+XAR([0-7])\[(.+)\]", text):
        return 0xC0 + 8 * within(evaluate(match[2]), 0, 7) + int(match[1])
    if re.fullmatch(r"@[^@*#<]+", text) and text not in (*_WORDS, *_LONGS):
        return evaluate(text[1:]) & 0x3F  # the page is in DP
    raise ValueError(f"'{text}' is no location of {bits} bits")


def within(value: int, least: int, most: int) -> int:
    """The value.

    Raises:
        ValueError: it is out of range.
    """
    if not least <= value <= most:
        raise ValueError(f"{value} is not within {least} to {most}")
    return value


class Operand(NamedTuple):
    """What stands for an operand in the syntax of a form."""

    letter: str
    pattern: str
    """What it looks like; the group is what is given to the functions of the assembler and the disassembler."""
    least: int = 0
    most: int | None = None
    """Of a number; None: what the field holds."""
    names: tuple[str, ...] = ()
    """Of one of several words, by the value of the field."""
    bits: int = 0
    """Of a location."""
    relative: bool = False
    """To the address of the instruction."""
    bias: int = 0
    """The field has the value less this."""


_AUXILIARY = tuple(f"AR{n}" for n in range(8))
_NUMBER = r"#([^,]+)"
_ADDRESS = r"#?([^,*#]+)"
_LOCATION = r"(\*,ARP[0-7]|[^,#]+?)"

OPERANDS = {
    "#16bitSigned": Operand("C", _NUMBER, -0x8000, 0xFFFF),
    "#8bitSigned": Operand("C", _NUMBER, -0x80, 0x7F),
    "16bitOffset": Operand("C", _ADDRESS, -0x8000, 0x7FFF, relative=True),
    "8bitOffset": Operand("C", _ADDRESS, -0x80, 0x7F, relative=True),
    "*(0:16bit)": Operand("C", r"\*\(0:([^,]+)\)"),
    "*(pma)": Operand("C", r"\*\(([^,:]+)\)"),
    "*(PA)": Operand("C", r"\*\(([^,:]+)\)"),
    "0:pma": Operand("C", r"0:([^,]+)"),
    "#22bit": Operand("C", _NUMBER),
    "#16bit": Operand("C", _NUMBER, -0x8000),
    "#10bit": Operand("C", _NUMBER),
    "#0..15": Operand("S", _NUMBER),
    "#1..15": Operand("S", _NUMBER, 1),
    "#1..16": Operand("S", _NUMBER, 1, bias=1),
    "#2..8": Operand("S", _NUMBER, 2, 8, bias=1),
    "#8bit": Operand("C", _NUMBER),
    "#7bit": Operand("C", _NUMBER),
    "#5bit": Operand("C", _NUMBER),
    "#bit": Operand("B", _NUMBER),
    "22bit": Operand("C", _ADDRESS),
    "loc16": Operand("L", _LOCATION, bits=16),
    "loc32": Operand("L", _LOCATION, bits=32),
    "mem16": Operand("L", _LOCATION, bits=16),
    "mem32": Operand("L", _LOCATION, bits=32),
    "ARPn": Operand("n", r"(ARP[0-7])", names=tuple(f"ARP{n}" for n in range(8))),
    "XARn": Operand("n", r"(XAR[0-7])", names=tuple(f"XAR{n}" for n in range(8))),
    "COND": Operand("K", r"([A-Z]+)", names=CONDITIONS),
    "Mode": Operand("C", r"(.+)"),
    "INTx": Operand("C", r"([A-Z]+\d*)", names=INTERRUPTS),
    "PMn": Operand("C", r"(\+?-?\d)", names=PRODUCT_SHIFTS),
    "pma": Operand("C", _ADDRESS),
    "ARn": Operand("n", r"(AR[0-7])", names=_AUXILIARY),
    "ARm": Operand("m", r"(AR[0-7])", names=_AUXILIARY),
    "AX": Operand("A", r"(A[LH])", names=("AL", "AH")),
}
"""By what the table writes; the longer ones come first."""

WORDS = re.compile("|".join(re.escape(word) for word in OPERANDS))
