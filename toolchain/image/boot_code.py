"""Sizes of boot.asm's sections, in words, and the symbols it makes and wants.

It knows the instructions that are used there and no others, so a new one has to be looked up in the instruction set
(SPRU430) and added here.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

# By mnemonic and, where it matters, operands; the first that fits.
_WORDS = (
    (r"LB\b", 2),
    (r"B\b", 2),
    (r"BANZ\b", 2),
    (r"(SETC|CLRC|EALLOW|EDIS|NOP)\b", 1),
    (r"MOVZ\s+DP,", 1),
    (r"MOVL\s+XAR\d,\s*#", 2),
    (r"MOV\s+\S+,\s*#0$", 1),
    (r"MOV\s+\S+,\s*#", 2),
    (r"MOV\s+AL,", 1),
    (r"CMP\s+AL,\s*#", 2),
)


@dataclass
class BootCode:
    """Words by section, names defined, names wanted."""

    words: dict[str, int] = field(default_factory=dict)
    defined: set[str] = field(default_factory=set)
    wanted: set[str] = field(default_factory=set)


def instruction_words(text: str) -> int:
    """Length of one instruction."""
    for pattern, words in _WORDS:
        if re.match(pattern, text):
            return words
    raise ValueError(f"unknown instruction: {text}")


def read_boot_code(path: Path) -> BootCode:
    """Parses the assembly."""
    code, section = BootCode(), ""
    for raw in path.read_text(encoding="utf-8").splitlines():
        line = raw.partition(";")[0].rstrip()
        if not line or re.match(r"\w+:$", line) or ".set" in line:
            continue
        text = line.strip()
        directive = re.match(r"\.(sect|def|ref)\s+\"?(\w+)", text)
        if directive is None:
            code.words[section] = code.words.get(section, 0) + instruction_words(text)
        elif directive[1] == "sect":
            section = directive[2]
        else:
            (code.defined if directive[1] == "def" else code.wanted).add(directive[2].removeprefix("_"))
    return code
