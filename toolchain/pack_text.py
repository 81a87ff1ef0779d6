"""Packs the drive's texts: two octets in a word, and an octet above 127 stands for two others.

A character of a string takes a word of the C28x's flash. What the lists below have, names and units, meanings, causes
and remedies, words of states and help, is therefore packed by pairs that occur often (byte pair encoding: P. Gage, "A
New Algorithm for Data Compression", C Users Journal 12(2), 1994). The lists stay what people read and change; the
texts' numbers are made here as well, so that the code that says something includes none of them.
"""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NUMBERS = "firmware/text/text_numbers.h"
# The lists (with * those of every folder), the macro, which of its arguments is the text, and what its number is
# called, by the arguments.
LISTS = (
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 9, "TEXT_PARAMETER_{1}"),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 5, "TEXT_SIGNAL_{0}"),
    ("firmware/dictionary/fault_list.h", "FAULT", 2, "TEXT_FAULT_{0}"),
    ("firmware/dictionary/fault_list.h", "FAULT", 3, "TEXT_REMEDY_{0}"),
    ("firmware/text/catalogue_list.h", "WORDS", 2, "TEXT_{0}_{1}"),
    ("firmware/console/command_list.h", "COMMAND", 2, "TEXT_COMMAND_{0}"),
    ("firmware/console/help_list.h", "HELP", 2, "TEXT_HELP_{0}_{1}"),
    ("firmware/*/phrase_list.h", "PHRASE", 1, "SAY_{0}"),
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 1, "TEXT_PARAMETER_NAME_{1}"),
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 2, "TEXT_PARAMETER_UNIT_{1}"),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 0, "TEXT_SIGNAL_NAME_{0}"),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 1, "TEXT_SIGNAL_UNIT_{0}"),
    ("firmware/console/command_list.h", "COMMAND", 0, "TEXT_COMMAND_NAME_{0}"),
    ("firmware/console/command_list.h", "COMMAND", 1, "TEXT_COMMAND_ARGUMENTS_{0}"),
)
PAIRS = 128
FIRST_PAIR = 128
DEPTH = 8  # PACKED_DEPTH: pairs of pairs, at most so deep
INCLUDE = re.compile(r'^#include "(firmware/[^"]+)"$', re.MULTILINE)
TOKEN = re.compile(r'//[^\n]*|"(?:[^"\\]|\\.)*"|[(),]|[^"(),/]+|/')


def rows(text: str, macro: str) -> list[list[str]]:
    """The arguments of each call of the macro; strings that stand side by side are one, without their quotes."""
    found: list[list[str]] = []
    depth, open_call, last = 0, False, ""
    for token in TOKEN.findall(text):
        if token.startswith("//"):
            continue
        if token == "(" and depth == 0:
            open_call = last.split()[-1:] == [macro]
            if open_call:
                found.append([""])
        elif token == ")" and depth == 1:
            open_call = False
        elif token == "," and depth == 1 and open_call:
            found[-1].append("")
        elif open_call:
            found[-1][-1] += token[1:-1].replace('\\"', '"') if token.startswith('"') else token.strip()
        depth += (token == "(") - (token == ")")
        last = token
    return found


def files(root: Path) -> list[Path]:
    """All lists, with the parts that some consist of."""
    found = [path for pattern, *_ in LISTS for path in sorted(root.glob(pattern))]
    parts = [root / name for path in found for name in INCLUDE.findall(path.read_text(encoding="utf-8"))]
    return sorted({*found, *parts})


def whole(root: Path, name: str) -> str:
    """A list with its parts in the place of their names."""
    text = (root / name).read_text(encoding="utf-8")
    return INCLUDE.sub(lambda part: (root / part[1]).read_text(encoding="utf-8"), text)


def texts(root: Path = ROOT) -> dict[str, str]:
    """All texts by what their numbers are called, in their order."""

    def read() -> Iterator[tuple[str, str]]:
        for pattern, macro, column, name in LISTS:
            for path in sorted(root.glob(pattern)):
                for row in rows(whole(root, path.relative_to(root).as_posix()), macro):
                    yield name.format(*row), row[column]

    found: dict[str, str] = {}
    for name, text in read():
        if not text.isascii() or "\\" in text or any(not 32 <= ord(c) < 127 for c in text):
            raise ValueError(f"not plain ASCII: {text!r}")
        if name in found:
            raise ValueError(f"{name} is there twice")
        found[name] = text
    return found


def squeeze(strings: list[list[int]]) -> list[tuple[int, int]]:
    """Replaces pairs in place, the most frequent first; the pairs."""
    pairs: list[tuple[int, int]] = []
    depth: dict[int, int] = {}
    while len(pairs) < PAIRS:
        counts = Counter(pair for string in strings for pair in pairwise(string))
        shallow = (p for p in counts if max(depth.get(p[0], 0), depth.get(p[1], 0)) < DEPTH)
        best = max(shallow, key=lambda p: (counts[p], p), default=None)
        if best is None or counts[best] <= 3:  # a pair takes a word itself
            break
        code = FIRST_PAIR + len(pairs)
        depth[code] = 1 + max(depth.get(best[0], 0), depth.get(best[1], 0))
        pairs.append(best)
        for string in strings:
            at = 0
            while at + 1 < len(string):
                if (string[at], string[at + 1]) == best:
                    string[at : at + 2] = [code]
                at += 1
    return pairs


def table(name: str, values: list[int]) -> list[str]:
    """A C array of 16-bit words."""
    lines = [f"const uint16_t {name}[] = {{"]
    lines += ["    " + " ".join(f"0x{value:04x}," for value in values[k : k + 16]) for k in range(0, len(values), 16)]
    return [*lines, "};", ""]


def numbers(names: list[str]) -> str:
    """The header with the texts' numbers."""
    lines = ["// Made by toolchain/compose.py: the numbers of the packed texts.", "", "enum {"]
    return "\n".join([*lines, *(f"  {name}," for name in names), "  PACKED_TEXTS", "};", ""])


def pack(strings: list[str]) -> str:
    """The C file with the texts."""
    coded = {string: [ord(c) for c in string] for string in strings}
    pairs = squeeze(list(coded.values()))
    octets: list[int] = []
    start: dict[str, int] = {}
    for string, codes in coded.items():
        start[string] = len(octets)
        octets += [*codes, 0]
    starts = [start[string] for string in strings]
    octets += [0] * (len(octets) % 2)
    words = [octets[k] | octets[k + 1] << 8 for k in range(0, len(octets), 2)]
    plain = sum(len(string) + 1 for string in strings)
    taken = len(words) + len(starts) + len(pairs)
    return "\n".join(
        [
            f"// Made by toolchain/compose.py: {len(strings)} texts, {plain} characters, {taken} words.",
            '#include "firmware/text/packed_text.h"',
            "",
            f"typedef char all_texts_are_here[(PACKED_TEXTS == {len(strings)}) ? 1 : -1];",
            f"typedef char no_pair_is_too_deep[(PACKED_DEPTH == {DEPTH}) ? 1 : -1];",
            "",
            *table("packed_starts", starts),
            *table("packed_pairs", [first << 8 | second for first, second in pairs]),
            *table("packed_octets", words),
        ]
    )
