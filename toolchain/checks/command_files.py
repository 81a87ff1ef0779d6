"""The linker command files against the chip's memory (toolchain/f2808/memory.csv).

Every range lies in memory of the right kind, no two overlap, not even by H0's two addresses; nothing is placed on the
passwords or in the area that belongs to them, and nothing is filled; entry, boot code and stack are where the chip
wants them.
"""

from pathlib import Path

from image.command_file import CommandFile, Range, read_command_file

from checks import Finding
from checks.f2808_tables import read

FLASH, RAM, KERNEL = (f"toolchain/c28x/f2808_{name}.cmd" for name in ("flash", "ram", "kernel"))
FILES = (FLASH, RAM, KERNEL)
UNTOUCHED = ("CSM_RESERVED", "PASSWORDS")
CODE_ENTRY = {FLASH: ("codestart", 0x3F7FF6), RAM: ("codestart", 0x000000), KERNEL: ("identity", 0x3FA000)}
BOOT_CODE = ("codestart", "boot", "appentry")  # of the drive; the boot ROM jumps to the kernel's C start-up
REQUIRED = (*BOOT_CODE, "identity", ".text", ".cinit", ".econst", "ramfuncs", ".stack", ".ebss")
SYMBOLS = {
    "image_ram_code_load",
    "image_ram_code_run",
    "image_ram_code_size",
    "image_globals_start",
    "image_globals_size",
}
_PREFETCH = 8  # words at a block's end that hold no code
_STACK_TOP = 0x10000  # SP has 16 bits


def _blocks(root: Path) -> list[tuple[str, Range]]:
    """The chip's blocks with their kind."""
    rows = read(root, "memory")
    return [(row["kind"], Range(row["block"], int(row["address"], 16), int(row["words"], 16))) for row in rows]


def _joined(blocks: list[tuple[str, Range]], kinds: set[str]) -> list[Range]:
    """Blocks of these kinds, neighbours made one: a range may go across their border."""
    joined: list[Range] = []
    for block in sorted((block for kind, block in blocks if kind in kinds), key=lambda block: block.origin):
        if joined and joined[-1].end == block.origin:
            joined[-1] = Range(joined[-1].name, joined[-1].origin, joined[-1].length + block.length)
        else:
            joined.append(block)
    return joined


def _cells(piece: Range, low: Range | None, high: Range | None) -> Range:
    """The memory itself: H0's low address told by its high one."""
    if low and high and piece.origin < low.end and piece.end > low.origin and high.origin:
        return Range(piece.name, piece.origin - low.origin + high.origin, piece.length)
    return piece


def _overlaps(file: CommandFile, blocks: list[tuple[str, Range]]) -> list[str]:
    named = {block.name: block for _, block in blocks}
    low, high = named.get("H0_LOW"), named.get("H0")
    pieces = []
    for piece in file.ranges.values():
        if low and piece.origin < low.origin < piece.end:  # the part in L0, L1 and the part in H0
            pieces.append(Range(piece.name, piece.origin, low.origin - piece.origin))
            pieces.append(_cells(Range(piece.name, low.origin, piece.end - low.origin), low, high))
        else:
            pieces.append(_cells(piece, low, high))
    pieces.sort(key=lambda piece: piece.origin)
    pairs = [(a, b) for k, a in enumerate(pieces) for b in pieces[k + 1 :]]
    return [f"{a.name} and {b.name} share memory" for a, b in pairs if a.end > b.origin and a.origin < b.end]


def _misplaced(file: CommandFile, blocks: list[tuple[str, Range]]) -> list[str]:
    kinds = {"ram", "flash", "mirror", "zero", "passwords"}
    stacks = {placement.run for placement in file.placements if placement.section == ".stack"}
    complaints = []
    for piece in file.ranges.values():
        # What the boot ROM uses while it loads may hold nothing that is loaded.
        usable = _joined(blocks, kinds | {"reserved"} if piece.name in stacks else kinds)
        if not any(block.origin <= piece.origin and piece.end <= block.end for block in usable):
            complaints.append(f"{piece.name} lies outside of memory that may be used")
    return complaints


def _passwords(file: CommandFile) -> list[str]:
    complaints = [f"{p.section} is placed on {name}" for p in file.placements for name in p.ranges if name in UNTOUCHED]
    if "fill" in file.text:
        complaints.append("a fill may reach the passwords")
    kept = [piece for name, piece in file.ranges.items() if name in UNTOUCHED]
    for name, piece in file.ranges.items():
        if name not in UNTOUCHED and any(piece.end > k.origin and piece.origin < k.end for k in kept):
            complaints.append(f"{name} reaches into the passwords' area")
    return complaints


def _entry(path: str, file: CommandFile) -> list[str]:
    complaints = []
    placed = {placement.section: placement for placement in file.placements}
    required = [name for name in REQUIRED if path != KERNEL or name not in BOOT_CODE]
    complaints += [f"section {name} has no place" for name in required if name not in placed]
    complaints += [f"symbol {name} is not made" for name in sorted(SYMBOLS - file.symbols) if path != KERNEL]
    unknown = [p.section for p in file.placements if not set(p.ranges) <= set(file.ranges)]
    complaints += [f"{section} is placed on a range that does not exist" for section in unknown]
    if unknown or any(name not in placed for name in required):
        return complaints
    section, origin = CODE_ENTRY[path]
    if file.ranges[placed[section].load].origin != origin:
        complaints.append(f"{section} is not at 0x{origin:06X}, where it is looked for")
    stack = file.ranges[placed[".stack"].run]
    if stack.end > _STACK_TOP or file.stack_words > stack.length:
        complaints.append("the stack does not fit its range or lies above what SP reaches")
    return complaints


def _prefetch(file: CommandFile, blocks: list[tuple[str, Range]]) -> list[str]:
    ends = {block.end for block in _joined(blocks, {"ram", "flash"})}
    code = {
        name
        for p in file.placements
        if p.section in (".text", "ramfuncs", "ramfixed", "ramfixedh0", "boot", "quotients", "resident")
        for name in (p.run, p.spill)
    }
    return [
        f"{name} has code in the last {_PREFETCH} words of a block"
        for name in sorted(code & set(file.ranges))
        if any(end - _PREFETCH < file.ranges[name].end <= end for end in ends)
    ]


def check_file(root: Path, path: str) -> list[Finding]:
    """Findings for one linker command file."""
    file, blocks = read_command_file(root / path), _blocks(root)
    complaints = [
        *_misplaced(file, blocks),
        *_overlaps(file, blocks),
        *_passwords(file),
        *_entry(path, file),
        *_prefetch(file, blocks),
    ]
    return [Finding(path, 0, complaint) for complaint in complaints]


def check(root: Path) -> list[Finding]:
    """Findings for all files."""
    return [finding for path in FILES for finding in check_file(root, path)]
