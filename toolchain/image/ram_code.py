"""What runs from RAM: what the linker command file lists by name, and what is marked in the drivers' sources.

The list (toolchain/c28x/f2808_flash.cmd) is for speed. It names functions, which a compiler may as well put into their
callers, and objects of the resident part, which the linker has no functions of. Marked is what is in every image, by
whichever object: drivers that are compiled otherwise without a feature, and what changes the flash's own timing, which
may call nothing that lies there. No compiler may put it into its caller.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from image.command_file import CommandFile
from image.elf import ObjectFile
from image.sizes import words_of

SECTION = "ramfuncs"
FIXED = ("ramfixed", "ramfixedh0")  # of the resident part, which runs from the same places in every image
SECTIONS = (SECTION, *FIXED)
MARKED = re.compile(r"^TARGET_RAM_CODE [\w ]+?\**(\w+)\(", re.MULTILINE)
LIBRARY = re.compile(r"CMakeFiles/(stillspin_\w+)\.dir/")
ON_THE_FLASH = ("set_flash_timing",)


def marked(drivers: Path) -> dict[str, set[str]]:
    """By file of the drivers, the functions that are marked to run from RAM."""
    return {path.name: set(MARKED.findall(path.read_text(encoding="utf-8"))) for path in sorted(drivers.glob("*.c"))}


def archive_of(path: Path) -> str:
    """The library that an object of the build goes into."""
    library = LIBRARY.search(path.as_posix())
    return f"lib{library[1]}.a" if library else ""


def runs_from_ram(file: CommandFile, archive: str, member: str, section: str) -> bool:
    """Whether the linker puts an object's section (`.text.NAME`) into RAM."""
    name = f".text:_{section[6:]}" if section.startswith(".text.") else section
    return file.section_of(archive, member, name) in SECTIONS


def half_words(obj: ObjectFile, file: CommandFile) -> int:
    """Of an object of the build what runs from RAM."""
    archive = archive_of(obj.path)
    code = (each for each in obj.sections if each.name.startswith((".text", SECTION)))
    return sum(words_of(each) for each in code if runs_from_ram(file, archive, obj.path.name, each.name))


def left_in_flash(objects: Iterable[ObjectFile], names: Mapping[str, set[str]]) -> list[str]:
    """What is marked and does not run from RAM alone, in words; `names` by file, whose object is FILE.obj."""
    complaints = []
    for obj in objects:
        here = {k for k, section in enumerate(obj.sections) if section.name == SECTION}
        inside = {symbol.name for symbol in obj.symbols if symbol.section in here}
        if inside & set(ON_THE_FLASH):
            calls = {name for s in obj.sections if s.name == SECTION for _, _, name in s.relocations}
            outside = sorted(calls - inside - {SECTION})
            complaints += [f"{obj.path.name} changes the flash's timing and refers to {name}" for name in outside]
        missing = sorted(names.get(obj.path.name.removesuffix(".obj"), set()) - inside)
        complaints += [f"{name} is to run from RAM and is not in {SECTION}" for name in missing]
    return complaints
