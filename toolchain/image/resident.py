"""What stays in the flash when a drive is updated may refer to nothing that an update moves.

Of the objects that a linker command file puts into the sections that stay, every relocation has to lead into these
again, or to what TI's library brings for arithmetic and copying; and none of them may have globals, which have no fixed
place either. So they come out the same word for word whatever else changes, where what is in them and its order are the
same: that is compared between images.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatch
from hashlib import sha256

from image.command_file import CommandFile
from image.elf import ObjectFile, Section
from image.sizes import RUN_TIME_LIBRARY, input_section, section_of

ARITHMETIC = re.compile(r"__aeabi_\w+|mem(cpy|set|move|cmp|clr)\w*")


def _place(file: CommandFile, obj: ObjectFile, section: Section) -> str | None:
    """Where it goes in the image; None for what is not in memory."""
    name = input_section(section)
    return file.section_of(obj.archive, obj.path.name, name) if name else None


def _own(file: CommandFile, obj: ObjectFile, kept: Collection[str]) -> Iterator[str]:
    """The names in the object of what is kept: symbols, and the sections themselves."""
    inside = {k for k, section in enumerate(obj.sections) if _place(file, obj, section) in kept}
    yield from (obj.sections[k].name for k in inside)
    yield from (symbol.name for symbol in obj.symbols if symbol.section in inside)


def unresident(objects: Iterable[ObjectFile], file: CommandFile, kept: Collection[str]) -> list[str]:
    """What of the sections `kept` depends on anything outside of them, in words."""
    objects = list(objects)
    public = {name for obj in objects for name in _own(file, obj, kept) if name in obj.defined}
    complaints = []
    for obj in objects:
        own = set(_own(file, obj, kept))
        wanted = {
            name for section in obj.sections if _place(file, obj, section) in kept for _, _, name in section.relocations
        }
        moved = sorted(n for n in wanted - own - public if not ARITHMETIC.fullmatch(n))
        complaints += [f"{obj.path.name} is resident and refers to {name}, which an update moves" for name in moved]
    return complaints


def kept(objects: Iterable[ObjectFile], file: CommandFile, sections: Collection[str]) -> list[str]:
    """What the image has in `sections`, in the order of the linker command file: names, and what the words come from.

    An input of the command file that no object answers to is there without words.
    """
    objects = list(objects)
    placements = [placement for placement in file.placements if placement.section in sections]
    lines = []
    for section, (archive, member, name) in ((p.section, each) for p in placements for each in p.inputs):
        found = [
            (obj, own)
            for obj in objects
            if obj.archive == archive and fnmatch(obj.path.name, member)
            for own in obj.sections
            if section_of(own) == name and _place(file, obj, own) == section
        ]
        lines += [f"{archive}<{obj.path.name}>({own.name}) {_digest(own)}" for obj, own in found]
        if not found and name == ".text" and archive != RUN_TIME_LIBRARY:
            lines.append(f"{archive}<{member}>({name}) is not there")
    return lines


def _digest(section: Section) -> str:
    words = repr((section.content, section.size, sorted(section.relocations)))
    return sha256(words.encode()).hexdigest()[:16]


def changed(images: Mapping[str, Sequence[str]]) -> list[str]:
    """What of the resident part is not in all images as it is in the first, in words."""
    (first, expected), *others = images.items()
    complaints = [f"{line}, and is to be resident" for line in expected if line.endswith(" is not there")]
    for name, lines in others:
        here, there = [line for line in lines if line not in expected], [line for line in expected if line not in lines]
        complaints += [
            f"the resident part of {name} has {line.rpartition(' ')[0]} beside that of {first}" for line in here
        ]
        complaints += [f"the resident part of {name} has not {line.rpartition(' ')[0]} as in {first}" for line in there]
        if not here and not there and list(lines) != list(expected):
            complaints.append(f"the resident part of {name} has another order than that of {first}")
    return complaints
