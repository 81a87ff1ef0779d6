"""What a user has to know of a linked file before it goes anywhere near a chip."""

from __future__ import annotations

from pathlib import Path

from stillspin.flash import layout, sections
from stillspin.flash.program import Program

_OF_THE_START = (".cinit", ".pinit", ".init_array")


def of(file: Path, program: Program) -> list[str]:
    """Passwords that lock the chip, and initial values that only a debugger would load."""
    return [*_passwords(program), *_initial_values(file, program)]


def _passwords(program: Program) -> list[str]:
    words = [program.word(address) for address in layout.PASSWORDS]
    if all(word in (None, layout.ERASED) for word in words):
        return []
    where = f"0x{layout.PASSWORDS.start:06X} to 0x{layout.PASSWORDS.stop - 1:06X}"
    if all(word == 0 for word in words):
        return [f"the passwords at {where} are all 0: in a chip they lock it for ever; leave them 0xFFFF"]
    return [
        f"it has passwords at {where}: a chip that gets them is locked to all who do not know them; leave them 0xFFFF"
    ]


def _initial_values(file: Path, program: Program) -> list[str]:
    lost = sections.not_loaded(file, program, _OF_THE_START)
    if not lost:
        return []
    return [
        f"{', '.join(lost)}: initial values of variables that a debugger would load; from the flash they are not set: "
        "link with --rom_model"
    ]
