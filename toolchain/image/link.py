"""The stand-in linker.

Takes objects and a linker command file, says what is missing, where everything goes, whether it fits, and how deep the
stack gets; leaves a map. Estimates: see sizes.py.
"""

import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path

from image.boot_code import BootCode, read_boot_code
from image.command_file import CommandFile, read_command_file
from image.elf import ObjectFile, read_object
from image.interrupts import dear_calls
from image.ram_code import FIXED, SECTIONS, left_in_flash, marked
from image.resident import kept, unresident
from image.sizes import RUN_TIME_LIBRARY, RUN_TIME_WORDS, input_section, object_words, section_of
from image.stack import Depth, stack_depth

ROOT = Path(__file__).resolve().parent.parent.parent
DRIVERS = ROOT / "hal" / "f2808"
# What TI's libraries bring: the C start-up, what a compiler calls for arithmetic or copying, and the flash library.
RUN_TIME = re.compile(r"__aeabi_\w+|mem(cpy|set|move|cmp|clr)\w*|c_int00|IER|IFR|Flash2808_\w+|Flash_\w+")
KERNEL = "flash_kernel_main"
RESIDENT = ("resident", *FIXED)  # the sections that stay in sector A
SECTOR_A = "RESIDENT"  # its range, which the drive's image has
FLASH = ("APP_ENTRY", "APP", "RESIDENT")  # what sections may fill, but for boot code and identity
HOT = ("RAM_FIXED", "RAM_FIXED_H0", "RAM_CODE")
NO_CODE = "no code for the C28x: see the map beside this file\n"  # all that the linked file holds
FLASH_LIBRARY_WORDS = 1600  # room for TI's flash library in the kernel; a guess


class Pile:
    """The objects that go into the image."""

    def __init__(self, given: Iterable[Path]) -> None:
        self.objects: list[ObjectFile] = []
        self.boot = BootCode()
        self.archived: list[ObjectFile] = []
        for path in given:
            self._take(path)
        self._resolve()

    def _take(self, path: Path) -> None:
        data = path.read_bytes()
        if data[:4] == b"\x7fELF":
            self.objects.append(read_object(path))
        elif path.suffix in (".lib", ".a"):
            self.archived += [read_object(Path(member), path.name) for member in data.decode().split()]
        else:
            self.boot = read_boot_code(path)

    def _resolve(self) -> None:
        """Takes from the archives what is asked for, until nothing more is."""
        while True:
            missing = self.missing()
            found = [obj for obj in self.archived if obj.defined & missing]
            if not found:
                return
            self.objects += found
            self.archived = [obj for obj in self.archived if obj not in found]

    def missing(self) -> set[str]:
        """Names that are asked for and not there."""
        defined = set(self.boot.defined).union(*(obj.defined for obj in self.objects))
        return set(self.boot.wanted).union(*(obj.wanted for obj in self.objects)) - defined

    def words(self, file: CommandFile | None = None) -> dict[str, int]:
        """Words by section of the objects, or by the image's sections that a linker command file puts them into."""
        total = dict(self.boot.words)
        name_of = input_section if file else section_of
        pieces = [(obj.archive, obj.path.name, object_words(obj, name_of)) for obj in self.objects]
        pieces += [(RUN_TIME_LIBRARY, member, {".text": words}) for member, words in RUN_TIME_WORDS.items()]
        for archive, member, sections in pieces:
            for section, words in sections.items():
                name = file.section_of(archive, member, section) if file else section
                total[name] = total.get(name, 0) + words
        return total


def place(words: dict[str, int], file: CommandFile) -> tuple[dict[str, int], list[str]]:
    """Fill of every range, and what does not fit or has no place."""
    fill = dict.fromkeys(file.ranges, 0)
    placed = {placement.section: placement for placement in file.placements}
    complaints = [f"section {name} has no place" for name in sorted(words) if name not in placed and name != "strings"]
    for placement in file.placements:
        size = words.get(placement.section, 0)
        if placement.section == ".stack":
            size = file.stack_words
        room = max(file.ranges[placement.load].length - fill[placement.load], 0)
        here = min(size, room) if placement.spill else size
        fill[placement.load] += here
        if placement.spill:
            fill[placement.spill] += size - here
        if placement.run != placement.load:
            fill[placement.run] += size
    for name, used in fill.items():
        if used > file.ranges[name].length:
            complaints.append(f"{name} takes {used} words, there are {file.ranges[name].length}")
    return fill, complaints


def figures_of(pile: Pile, placed: dict[str, int], file: CommandFile, depth: Depth) -> dict[str, int]:
    """What goals and limits are about (check.py), and the room that there is."""
    words = pile.words()
    scopes = (obj for obj in pile.objects if obj.path.name.startswith("scope."))
    scope = sum(section.size // 2 for obj in scopes for section in obj.sections if section.name == ".bss.ring")
    flash = sum(words.get(n, 0) for n in (".text", ".econst", ".cinit", ".pinit", ".switch", "ramfuncs"))
    in_sector_a = [o for o in pile.objects if file.section_of(o.archive, o.path.name, ".text") in RESIDENT]
    hot = sum(placed.get(name, 0) for name in SECTIONS)
    return {
        "ram_code": hot,
        "scope": scope,
        "globals": words.get(".ebss", 0),
        "strings": words.get("strings", 0),
        "constants": words.get(".econst", 0) - words.get("strings", 0),
        "code": words.get(".text", 0) + words.get("ramfuncs", 0) - hot,
        "flash": flash,
        "resident": sum(placed.get(name, 0) for name in RESIDENT),
        "resident_code": sum(object_words(o).get(".text", 0) for o in in_sector_a),
        "stack": depth.total,
        "library": sum(RUN_TIME_WORDS.values()),  # of the code, and words of the C28x already
        "flash_room": sum(file.ranges[name].length for name in FLASH),
        "ram_code_room": sum(file.ranges[name].length for name in HOT),
    }


def link(arguments: list[str]) -> int:
    """Links; 0 when everything is there. A range that is too small is a limit's business (check.py)."""
    paths = [Path(a) for a in arguments if not a.startswith("-")]
    options = dict(a.partition("=")[::2] for a in arguments if a.startswith("--"))
    file = read_command_file(next(path for path in paths if path.suffix == ".cmd"))
    pile = Pile(path for path in paths if path.suffix != ".cmd")
    missing = sorted(n for n in pile.missing() - file.symbols if not RUN_TIME.fullmatch(n))
    words = pile.words(file)
    if SECTOR_A in file.ranges:
        depth = stack_depth(pile.objects)
        fill, unfit = place(words, file)
        figures = figures_of(pile, words, file, depth)
        rows = [f"| {name} | {value} |" for name, value in figures.items()]
        grown = unresident(pile.objects, file, RESIDENT) + left_in_flash(pile.objects, marked(DRIVERS))
        grown += dear_calls(pile.objects)
    else:  # a program in RAM
        depth = stack_depth(pile.objects, ("main",))
        words[".text"] += FLASH_LIBRARY_WORDS * any(KERNEL in obj.defined for obj in pile.objects)
        fill, unfit = place(words, file)
        rows, grown = [f"| stack | {depth.total} |"], unfit
        if depth.total > file.stack_words:
            grown = [*unfit, f"the stack takes {depth.total} words, there are {file.stack_words}"]
    lines = [
        "| estimated words | |",
        "|---|---|",
        *rows,
        "",
        "| range | used | of |",
        "|---|---|---|",
    ]
    lines += [f"| {name} | {used} | {file.ranges[name].length} |" for name, used in fill.items()]
    code, sectors = pile.words().get(".text", 0), ("APP", SECTOR_A)
    if set(sectors) <= set(fill):
        free = sum(file.ranges[name].length - fill[name] for name in sectors)
        lines += ["", f"the chip is full when code takes {(code + free) / code:.2f} words for a half word of Thumb-2"]
    lines += ["", *(f"does not fit: {complaint}" for complaint in unfit), "", *depth.lines]
    output = Path(options["--output_file"])
    output.with_suffix(".map").write_text("\n".join(lines) + "\n", encoding="utf-8")
    output.write_text(NO_CODE, encoding="utf-8")
    if SECTOR_A in file.ranges:
        objects = [str(obj.path) for obj in pile.objects]
        left = {**figures, "objects": objects, "kept": kept(pile.objects, file, RESIDENT)}
        output.with_suffix(".json").write_text(json.dumps(left), encoding="utf-8")
    for complaint in (*(f"undefined: {name}" for name in missing), *grown, *depth.complaints):
        print(f"link (stand-in): {complaint}", file=sys.stderr)
    return 1 if missing or grown or depth.complaints else 0
