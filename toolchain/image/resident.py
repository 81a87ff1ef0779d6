"""What stays in the flash when a drive is updated may refer to nothing that an update moves.

Of the objects that a linker command file puts into one section of the image, every relocation has to lead into that
section again, or to what TI's library brings for arithmetic and copying; and none of them may have globals, which have
no fixed place either. So the section comes out the same word for word whatever else changes.
"""

import re
from collections.abc import Iterable, Iterator

from image.command_file import CommandFile
from image.elf import ObjectFile, Section
from image.sizes import section_of

ARITHMETIC = re.compile(r"__aeabi_\w+|mem(cpy|set|move|cmp|clr)\w*")


def _place(file: CommandFile, obj: ObjectFile, section: Section) -> str | None:
    """Where it goes in the image; None for what is not in memory."""
    name = section_of(section)
    return file.section_of(obj.archive, obj.path.name, name) if name else None


def _own(file: CommandFile, obj: ObjectFile, kept: str) -> Iterator[str]:
    """The names in the object of what is kept: symbols, and the sections themselves."""
    inside = {k for k, section in enumerate(obj.sections) if _place(file, obj, section) == kept}
    yield from (obj.sections[k].name for k in inside)
    yield from (symbol.name for symbol in obj.symbols if symbol.section in inside)


def unresident(objects: Iterable[ObjectFile], file: CommandFile, kept: str) -> list[str]:
    """What of the section `kept` depends on anything outside of it, in words."""
    objects = list(objects)
    public = {name for obj in objects for name in _own(file, obj, kept) if name in obj.defined}
    complaints = []
    for obj in objects:
        own = set(_own(file, obj, kept))
        wanted = {
            name for section in obj.sections if _place(file, obj, section) == kept for _, _, name in section.relocations
        }
        moved = sorted(n for n in wanted - own - public if not ARITHMETIC.fullmatch(n))
        complaints += [f"{obj.path.name} is resident and refers to {name}, which an update moves" for name in moved]
    return complaints
