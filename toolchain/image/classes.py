"""Words of the C28x for objects of Thumb-2, by the classes of their instructions.

A second estimate beside that by half words: what is dear on the one is not always dear on the other. The words of each
class: toolchain/f2808/measured_costs.toml.
"""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

OBJDUMP = "arm-none-eabi-objdump"
_CONDITION = "(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|hs|lo)?"
_CLASSES = (
    ("conditional", "it[te]*"),
    ("branch", rf"cbn?z|b{_CONDITION}|tb[bh]"),
    ("call", rf"blx?{_CONDITION}"),
    ("multiple", rf"(push|pop|ldm\w*|stm\w*|ldrd|strd){_CONDITION}"),
    ("long_product", rf"[su]mull{_CONDITION}"),
    ("shift", rf"(lsl|lsr|asr|ror|rrx)s?{_CONDITION}"),
    ("compare", rf"(cmp|cmn|tst|teq){_CONDITION}"),
    ("move", rf"(mov[wt]?|mvn|[su]xt[hb])s?{_CONDITION}"),
    ("alu", rf"(add|sub|rsb|and|orr|eor|bic|orn|neg|adr)w?s?{_CONDITION}"),
    ("nothing", "nop"),
)
_ACCESS = re.compile(rf"(ldr|str)s?([bh]?)t?{_CONDITION}")
_PLACE = re.compile(r"\[(\w+)(?:, (#-?\d+|\w+))?")
_NEAR = 16  # octets
_INSTRUCTION = re.compile(r"\s+[0-9a-f]+:\t([a-z]\S*)\s*(.*)")
_FUNCTION = re.compile(r"[0-9a-f]+ <(?!\$)")
_FILE = re.compile(r"(\S+):\s+file format")


def _class_of_access(kind: str, width: str, operands: str) -> str:
    word = "load" if kind == "ldr" else "store"
    bits = "16" if width else "32"
    place = _PLACE.search(operands)
    if place is None:
        raise ValueError(f"not understood: {kind} {operands}")
    base, offset = place.groups()
    if base == "pc":
        return "literal"
    if base == "sp":
        return f"load_stack_{bits}" if word == "load" else "store_stack"
    if offset is not None and not offset.startswith("#"):
        return f"{word}_indexed_{bits}"
    near = 0 <= int((offset or "#0")[1:]) < _NEAR
    return f"{word}_{'near' if near else 'far'}_{bits}"


def class_of(mnemonic: str, operands: str) -> str:
    """An instruction as the disassembler writes it."""
    name = re.sub(r"\.[nw]$", "", mnemonic)
    if re.fullmatch(rf"bx{_CONDITION}", name):
        return "return" if operands.startswith("lr") else "branch"
    if access := _ACCESS.fullmatch(name):
        return _class_of_access(access[1], access[2], operands)
    return next((found for found, pattern in _CLASSES if re.fullmatch(pattern, name)), "other")


def counted(listing: str) -> dict[str, Counter[str]]:
    """By file, how many instructions of each class a listing has, and how many functions."""
    found: dict[str, Counter[str]] = {}
    own: Counter[str] = Counter()
    for line in listing.splitlines():
        if file := _FILE.match(line):
            own = found.setdefault(file[1], Counter())
        elif _FUNCTION.match(line):
            own["function"] += 1
        elif instruction := _INSTRUCTION.match(line):
            own[class_of(*instruction.groups())] += 1
    return found


def words(counts: Mapping[str, int], classes: Mapping[str, float]) -> float:
    """What they are expected to take."""
    return classes["for_size"] * sum(count * classes.get(name, 0) for name, count in counts.items())


def disassembled(objects: Iterable[Path]) -> str:
    """The listing of objects. OSError or CalledProcessError without the Cortex-M3's tools."""
    command = [OBJDUMP, "-d", "--no-show-raw-insn", *map(str, objects)]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
