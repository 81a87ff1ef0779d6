"""Packs the drive's texts: words of a dictionary, in as few bits as they are frequent (word_code.py).

A character of a string takes a word of the C28x's flash. What the lists below have, names and units, meanings, causes
and remedies, words of states and help, takes a fifth of that. The lists stay what people read and change; the texts'
numbers are made here as well, so that the code that says something includes none of them.
"""

import re
from collections import Counter
from itertools import zip_longest

import word_code
from row_lists import TREE, Lists

NUMBERS = "firmware/text/text_numbers.h"
# The lists, the macro, which of its arguments is the text, and what its number is called, by the arguments.
LISTS = (
    ("phrase_list.h", "PHRASE", 1, "SAY_{0}"),  # first, with numbers of eight bits: each stands in code
    ("unit_list.h", "UNIT", 1, "TEXT_UNIT_{0}"),
    ("parameter_list.h", "PARAMETER", 9, "TEXT_PARAMETER_{1}"),
    ("signal_list.h", "SIGNAL", 5, "TEXT_SIGNAL_{0}"),
    ("catalogue_list.h", "WORDS", 2, "TEXT_{0}_{1}"),
    ("fault_list.h", "FAULT", 2, "TEXT_FAULT_{0}"),
    ("fault_list.h", "FAULT", 3, "TEXT_REMEDY_{0}"),
    ("command_list.h", "COMMAND", 2, "TEXT_COMMAND_{0}"),
    ("help_list.h", "HELP", 2, "TEXT_HELP_{0}_{1}"),
    ("command_list.h", "COMMAND", 1, "TEXT_COMMAND_ARGUMENTS_{0}"),
    ("parameter_list.h", "PARAMETER", 1, "TEXT_PARAMETER_NAME_{1}"),
    ("signal_list.h", "SIGNAL", 0, "TEXT_SIGNAL_NAME_{0}"),
    ("command_list.h", "COMMAND", 0, "TEXT_COMMAND_NAME_{0}"),
)
NAME = re.compile(r"TEXT_(PARAMETER|SIGNAL|COMMAND)_NAME_")  # what is looked up: the last of the texts
BLOCK = 32  # PACKED_BLOCK: texts and entries from the beginning of a word on


def texts(lists: Lists = TREE) -> dict[str, str]:
    """All texts by what their numbers are called, in their order."""
    found: dict[str, str] = {}
    for list_name, macro, column, number in LISTS:
        for row in lists.rows(list_name, macro):
            name, text = number.format(*row), row[column]
            if not text.isascii() or "\\" in text or any(not 32 <= ord(c) < 127 for c in text):
                raise ValueError(f"not plain ASCII: {text!r}")
            if name in found:
                raise ValueError(f"{name} is there twice")
            found[name] = text
    return found


def table(name: str, values: list[int]) -> list[str]:
    """A C array of 16-bit words."""
    lines = [f"const uint16_t {name}[] = {{"]
    lines += ["    " + " ".join(f"0x{value:04x}," for value in values[k : k + 16]) for k in range(0, len(values), 16)]
    return [*lines, "};", ""]


def numbers(names: list[str]) -> str:
    """The header with the texts' numbers."""
    lines = [
        "// Made by toolchain/compose.py: the numbers of the packed texts.",
        "",
        "enum {",
    ]
    looked_up = next((name for name in names if NAME.match(name)), "PACKED_TEXTS")
    lines += [f"  {name}," for name in names]
    return "\n".join([*lines, "  PACKED_TEXTS,", f"  PACKED_FIRST_NAME = {looked_up}", "};", ""])


def key(name: str) -> int:
    """By which a name is looked up: packed_find()."""
    found = 0
    for letter in name.lower():
        found = (31 * found + ord(letter)) & 0xFF
    return (found ^ found >> 4) & 0xF


def blocks(items: list[str], start: int) -> tuple[list[int], list[int]]:
    """Words with bit strings, BLOCK of them from a word's first bit on; where each block begins."""
    whole = ["".join(items[k : k + BLOCK]) for k in range(0, len(items), BLOCK)]
    starts, words = [], []
    for bits in whole:
        starts.append(start + len(words))
        words += [int(f"{bits[k : k + 16]:0<16}", 2) for k in range(0, len(bits), 16)]
    return starts, words


def pack(strings: list[str], names: int = 0) -> str:
    """The C file with the texts, the last of which are names."""
    joints = [" "] * (len(strings) - names) + ["_"] * names
    said = [word_code.words(string, joint) for string, joint in zip(strings, joints, strict=True)]
    word_code.stems(said)
    word_code.phrases(said, joints)
    entries = word_code.entries(said)
    letters = Counter(letter for word in {*entries, *(w for text in said for w in text)} for letter in word)
    letters[word_code.END] = max(len(entries), *letters.values()) + 1  # the first code
    of_letters, of_entries = word_code.Code(letters), word_code.Code(entries)

    def spelled(word: str) -> str:
        return of_letters.of([*word, word_code.END])

    def bits(word: str) -> str:
        return of_entries.of([word]) if word in entries else of_entries.of([word_code.SPELLED]) + spelled(word)

    dictionary, words = blocks([spelled(word) for word in of_entries.symbols], 0)
    starts, more = blocks(["".join(map(bits, [*text, word_code.END])) for text in said], len(words))
    words += more

    def pairs(octets: list[int], width: int = 8) -> list[int]:
        return [low | high << width for low, high in zip_longest(octets[::2], octets[1::2], fillvalue=0)]

    tables = {
        "packed_starts": starts,
        "packed_dictionary": dictionary,
        "packed_entry_counts": of_entries.counts,
        "packed_letter_counts": of_letters.counts,
        "packed_letters": pairs([ord(letter or "\0") for letter in of_letters.symbols]),
        "packed_keys": pairs(pairs([key(name) for name in strings[len(strings) - names :]], 4)),
        "packed_bits": [*words, 0],  # a code is looked for in two words
    }
    plain = sum(len(string) + 1 for string in strings)
    taken = sum(map(len, tables.values()))
    return "\n".join(
        [
            f"// Made by toolchain/compose.py: {len(strings)} texts, {plain} characters, {taken} words.",
            '#include "firmware/text/packed_text.h"',
            "",
            f"typedef char all_texts_are_here[(PACKED_TEXTS == {len(strings)}) ? 1 : -1];",
            f"typedef char blocks_are_as_long[(PACKED_BLOCK == {BLOCK}) ? 1 : -1];",
            "",
            *(line for name, values in tables.items() for line in table(name, values)),
        ]
    )
