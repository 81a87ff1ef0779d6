"""What a user has to know of a linked file before it goes anywhere near a chip."""

from __future__ import annotations

from pathlib import Path

from stillspin.counted import counted
from stillspin.flash import layout, memories, sections
from stillspin.flash.program import Program

_OF_THE_START = (".cinit", ".pinit", ".init_array")


def of(file: Path, program: Program) -> list[str]:
    """Passwords that lock the chip, initial values and words in RAM that only a debugger would load."""
    return [*_passwords(program), *_initial_values(file, program), *_in_ram(file, program)]


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
    """Of a program that begins in the flash; one in RAM has them (`sections.with_initial_values`)."""
    lost = sections.not_loaded(file, program, _OF_THE_START)
    if not lost or program.word(layout.BOOT_ENTRY) is None:
        return []
    return [
        f"{', '.join(lost)}: initial values of variables that a debugger would load; from the flash they are not set: "
        "link with --rom_model"
    ]


def _in_ram(file: Path, program: Program) -> list[str]:
    """Of a program that begins in the flash, what it has loaded into RAM: of it nothing is there after power-on."""
    if program.word(layout.BOOT_ENTRY) is None:
        return []
    lost = [part for part in sections.read(file, program) if part.load is not None and memories.is_ram(part.load)]
    if not lost:
        return []
    words = counted(sum(part.words for part in lost), "word")
    return [
        f"{', '.join(part.name for part in lost)}: {words} in RAM that a debugger loads, and this board has; in a chip "
        "that starts from its flash they are not there: give them a load address in the flash and copy them (.data: "
        "link with --rom_model)"
    ]
