"""What is marked to run from RAM is really there: a compiler may put a small function into its caller, in flash.

What changes the flash's own timing may call nothing that lies in flash, either.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from image.elf import ObjectFile

SECTION = "ramfuncs"
MARKED = re.compile(r"^TARGET_RAM_CODE [\w ]+?\**(\w+)\(", re.MULTILINE)
ON_THE_FLASH = ("set_flash_timing",)


def marked(drivers: Path) -> dict[str, set[str]]:
    """By file of the drivers, the functions that are marked to run from RAM."""
    return {path.name: set(MARKED.findall(path.read_text(encoding="utf-8"))) for path in sorted(drivers.glob("*.c"))}


def left_in_flash(objects: Iterable[ObjectFile], names: Mapping[str, set[str]]) -> list[str]:
    """What of an image does not run from RAM alone, in words; `names` by file, whose object is FILE.obj."""
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
