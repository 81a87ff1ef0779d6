"""Random sequences of instructions on the core in C++ and on the one in Python, everything compared.

The instructions are those that go straight on; what branches, traps or saves whole status registers is in
test_c28x_programs.
"""

import random

import c28x_moves  # noqa: F401 (it adds its operations)
import c28x_pointers  # noqa: F401
import pytest
from c28x_desk import ask, put, state
from c28x_machine import FLAGS, Machine
from c28x_sums import OPERATIONS

from stillspin.c28x.table import forms

STRAIGHT = [form for form in forms() if form.operation in OPERATIONS]
PROGRAM = 0x3F8000
PAGE = 0x8000
"""Where pointers, DP and the stack begin; far from the program."""
WINDOW = 0x400
EXTREMES = (0, 1, 0x7FFF, 0x8000, 0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFF8000, 0xFFFFFFFF)
SEQUENCES = 1500
LENGTH = 12


def value32(rng):
    return rng.choice(EXTREMES) if rng.random() < 0.4 else rng.getrandbits(32)


def location(rng, form):
    wide = "32" in form.syntax
    codes = [*range(0x40), *range(0x40, 0x48), *range(0x80, 0xA0), *range(0xA0, 0xA8), *range(0xAE, 0x100)]
    codes += [0xA9, 0xAB, 0xAC] * 8 if wide else [0xA8, 0xA9, 0xAA, 0xAB, 0xAC] * 6
    if "mem" in form.syntax:
        codes = [code for code in codes if not 0xA0 <= code <= 0xAD]
    return rng.choice(codes)


def instruction(rng, form):
    bits = form.opcode
    for letter, field in form.fields.items():
        value = location(rng, form) if letter == "L" else rng.randrange(field.most + 1)
        if letter == "S" and "#1..15" in form.syntax:
            value = max(value, 1)
        bits |= value << field.shift
    return [bits >> 16, bits & 0xFFFF] if form.words == 2 else [bits]


def begin(rng):
    pick = {name: rng.randrange(2) for name in FLAGS}
    pointers = [PAGE + rng.randrange(WINDOW) for _ in range(8)]
    pointers[0] = rng.randrange(64)
    return Machine(
        acc=value32(rng), p=value32(rng), xt=value32(rng), xar=pointers, sp=PAGE + 0x1000 + rng.randrange(64),
        dp=PAGE // 64 + rng.randrange(8), pc=PROGRAM, pm=rng.randrange(8), ovc=rng.randrange(-32, 32),
        arp=rng.randrange(8), page0=0, flags=pick,
        memory={PAGE + k: value32(rng) >> 8 & 0xFFFF for k in range(-64, WINDOW + 64)},
    )  # fmt: skip


def sequence(rng, must_have):
    """Words of a random sequence, the begin and the end of the second core."""
    chosen = rng.choices([form for form in STRAIGHT if form.operation != "mov_xar_pc"], k=LENGTH - 1)
    # A pointer to the program is the last thing that a sequence makes: nothing writes over what is still to come.
    chosen.insert(LENGTH - 1 if must_have.operation == "mov_xar_pc" else rng.randrange(LENGTH), must_have)
    words = []
    for form in chosen:
        if form.repeatable and rng.random() < 0.3:
            words.append(0xF600 + rng.randrange(6))
        words += instruction(rng, form)
    machine = begin(rng)
    machine.memory.update({PROGRAM + k: word for k, word in enumerate(words)})
    return machine, PROGRAM + len(words)


def commands_of(machine):
    there = machine.state()
    rows = [machine.memory.get(PAGE + k, 0) for k in range(-64, WINDOW + 64)]
    program = {address: word for address, word in machine.memory.items() if address >= PROGRAM}
    return [
        "fresh",
        *(f"set {name} {value:x}" for name, value in there.items()),
        f"put {PAGE - 64:x} " + " ".join(f"{word:x}" for word in rows),
        *put(program),
    ]


@pytest.fixture(scope="module")
def cases():
    rng = random.Random(2808)
    commands, ends, seen = [], [], set()
    for k in range(SEQUENCES):
        machine, end = sequence(rng, STRAIGHT[k % len(STRAIGHT)])
        commands += commands_of(machine)
        trail = []
        while machine.pc < end:
            form = machine.step(OPERATIONS)
            trail.append(form.syntax)
            seen.add(form.operation)
        commands += [
            f"step {len(trail):x}",
            "state",
            f"get {PAGE - 64:x} {WINDOW + 128:x}",
            f"get {PAGE + 0xF80:x} 100",
        ]
        ends.append((machine, trail))
    return ends, ask(commands), seen


def test_every_straight_operation_is_in_some_sequence(cases):
    assert cases[2] >= {form.operation for form in STRAIGHT}
    assert len(STRAIGHT) > 300


def test_both_cores_end_alike(cases):
    ends, answers, _ = cases
    assert len(answers) == 3 * len(ends)
    for k, (machine, trail) in enumerate(ends):
        got = state(answers[3 * k])
        wrong = {name: (hex(got[name]), hex(value)) for name, value in machine.state().items() if got[name] != value}
        assert not wrong, f"sequence {k} (core, model): {wrong} after {'; '.join(trail)}"
        for answer, first in ((answers[3 * k + 1], PAGE - 64), (answers[3 * k + 2], PAGE + 0xF80)):
            for offset, word in enumerate(answer.split()):
                at = first + offset
                assert int(word, 16) == machine.read(at), f"sequence {k}, {at:#x}, after {'; '.join(trail)}"
