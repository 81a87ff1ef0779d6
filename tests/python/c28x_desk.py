"""The C28x core in C++ as the tests have it: a program that obeys commands (tests/c28x/desk.cpp)."""

import subprocess
from pathlib import Path

from stillspin.c28x.program import assemble

ROOT = Path(__file__).resolve().parents[2]
DESK = ROOT / "build/release/tests/c28x/c28x_desk"


def numbers(text):
    return [int(word, 16) for word in text.split()]


def state(text):
    return {name: int(value, 16) for name, value in (word.split("=") for word in text.split())}


def put(words):
    """Commands that put words, by address, into memory."""
    return [f"put {address:x} {word:x}" for address, word in words.items()]


def ask(commands):
    """The lines of the answers, of all commands at once: starting the program takes longer than thousands of them."""
    text = "\n".join(commands) + "\n"
    done = subprocess.run([DESK], input=text, capture_output=True, text=True, check=True, timeout=60)
    return done.stdout.splitlines()


class Run:
    """A program that was run to its ESTOP0, its registers afterwards and what was asked of its memory."""

    def __init__(self, source, *, registers=(), memory=(), requests=(), reads=(), cycles=100000):
        """`registers` and `memory` are what there is before, by name and by label; `reads` are (label, words)."""
        self.program = assemble(source)
        at = self.program.symbols
        commands = ["fresh", *put(self.program.words), f"set pc {at.get('START', 0):x}"]
        commands += [f"set {name} {value:x}" for name, value in dict(registers).items()]
        for label, words in dict(memory).items():
            commands.append(f"put {at[label]:x} " + " ".join(f"{word & 0xFFFF:x}" for word in words))
        commands += [f"request {number:x}" for number in requests]
        commands += [f"go {cycles:x}", "state", "cycles"]
        commands += [f"get {at.get(label, label):x} {count:x}" for label, count in reads]
        self.end, there, spent, *rows = ask(commands)
        self.registers = state(there)
        self.cycles, self.instructions = map(int, spent.split())
        self.memory = [numbers(row) for row in rows]


def words_of(value, count):
    """A number as `count` words, the lowest first."""
    return [value >> 16 * k & 0xFFFF for k in range(count)]


def number_of(words):
    return sum(word << 16 * k for k, word in enumerate(words))
