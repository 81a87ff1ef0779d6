"""A virtual chip that executes code, as the tests have it: a program that obeys commands (tests/c28x/chip_desk.cpp)."""

import subprocess
from itertools import islice
from pathlib import Path

from stillspin.c28x import linked
from stillspin.c28x.program import assemble_files

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "tests/c28x/programs"
DESK = ROOT / "build/release/tests/c28x/chip_desk"
MILLISECOND = 100_000


def program(name):
    """Words, names and lines of a program with what brings the chip up before it."""
    return assemble_files([PROGRAMS / f"{name}.asm"])


def parts_of(name):
    """Names of the files that a program is written in, its own first."""
    return list(dict.fromkeys([f"{name}.asm", *(line.file for line in program(name).lines.values())]))


def changed_file(folder, name, part, old, new):
    """The program's source in another folder, with a piece of one of its files changed where it stands first."""
    for file in parts_of(name):
        text = (PROGRAMS / file).read_text()
        if file == part:
            assert old in text
            text = text.replace(old, new, 1)
        (folder / file).write_text(text)
    return folder / f"{name}.asm"


def linked_file(folder, name, sources=()):
    """The program as a file with labels and lines; of other sources when there are some."""
    made = assemble_files(list(sources) or [PROGRAMS / f"{name}.asm"])
    file = folder / f"{name}.out"
    file.write_bytes(linked.to_elf(made, 0x3F7FF6))
    return file


def blocks(words):
    """Words by address as runs of neighbours: [(first, words)]."""
    made = []
    for address in sorted(words):
        if made and address == made[-1][0] + len(made[-1][1]):
            made[-1][1].append(words[address])
        else:
            made.append((address, [words[address]]))
    return made


def put(words):
    return [f"put {first:x} " + " ".join(f"{word:x}" for word in block) for first, block in blocks(words)]


def ask(commands):
    done = subprocess.run(
        [DESK], input="\n".join(commands) + "\n", capture_output=True, text=True, check=True, timeout=60
    )
    answers = done.stdout.splitlines()
    assert not any(line.startswith("error") for line in answers), answers
    return answers


def rows(answer, width):
    """Numbers of an answer, `width` to a row."""
    numbers = map(int, answer.split())
    return list(iter(lambda: tuple(islice(numbers, width)), ()))


def words(answer):
    return [int(word, 16) for word in answer.split()]
