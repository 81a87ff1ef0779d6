#!/usr/bin/env python3
"""Packs the drive's texts: two octets in a word, and an octet above 127 stands for two others.

Usage: toolchain/pack_text.py OUTPUT.c     (the build does it)

A character of a string takes a word of the C28x's flash. What the lists below have, names and units, meanings, causes
and remedies, words of states and help, is therefore packed by pairs that occur often (byte pair encoding: P. Gage, "A
New Algorithm for Data Compression", C Users Journal 12(2), 1994). The lists stay what people read and change;
firmware/text/packed_text.h numbers the texts in the same order.
"""

import re
import sys
from collections import Counter
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# The list, its macro, and which of the macro's arguments is the text: in the order of packed_text.h.
LISTS = (
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 9),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 5),
    ("firmware/dictionary/fault_list.h", "FAULT", 2),
    ("firmware/dictionary/fault_list.h", "FAULT", 3),
    ("firmware/text/word_list.h", "WORDS", 2),
    ("firmware/console/command_list.h", "COMMAND", 2),
    ("firmware/console/help_list.h", "HELP", 2),
    ("firmware/text/phrase_list.h", "PHRASE", 1),
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 1),
    ("firmware/dictionary/parameter_list.h", "PARAMETER", 2),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 0),
    ("firmware/dictionary/signal_list.h", "SIGNAL", 1),
    ("firmware/console/command_list.h", "COMMAND", 0),
    ("firmware/console/command_list.h", "COMMAND", 1),
)
PAIRS = 128
FIRST_PAIR = 128
DEPTH = 8  # PACKED_DEPTH: pairs of pairs, at most so deep
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


def texts(root: Path = ROOT) -> list[str]:
    """All texts in their order."""
    found: list[str] = []
    for name, macro, column in LISTS:
        content = (root / name).read_text(encoding="utf-8")
        found += [row[column] for row in rows(content, macro)]
    for text in found:
        if not text.isascii() or "\\" in text or any(not 32 <= ord(c) < 127 for c in text):
            raise ValueError(f"not plain ASCII: {text!r}")
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


def pack(strings: list[str]) -> str:
    """The C file."""
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
            f"// Made by toolchain/pack_text.py: {len(strings)} texts, {plain} characters, {taken} words.",
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


def main() -> int:
    """See above."""
    try:
        content = pack(texts())
    except ValueError as error:
        print(f"pack_text: {error}", file=sys.stderr)
        return 1
    Path(sys.argv[1]).write_text(content, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
