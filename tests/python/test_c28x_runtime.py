"""Routines that C calls by name run on the core as code: quotients and floating point, against Python's."""

import random
import struct

import pytest
from c28x_chip import PROGRAMS
from c28x_desk import Run

COUNT = 150
CALLS = """
        .org 0x2000
start:  MOVW DP,#0
        MOV @SP,#0x0400
        SPM 0
        MOVL XAR1,#pairs
        MOVL XAR2,#results
        MOVL XAR3,#{last}
each:   MOVL ACC,*+XAR1[2]
        ADDB SP,#2
        MOVL *-SP[2],ACC
        MOVL ACC,*+XAR1[0]
        LCR {name}
        SUBB SP,#2
        MOVL *XAR2++,ACC
        ADDB XAR1,#4
        BANZ each,AR3--
        ESTOP0
        .org 0x4000
results: .word 0
        .org 0x5000
pairs:  .word 0
"""


def called(name, pairs):
    """Results of a routine, 32 bits each, of pairs of 32 bits."""
    source = CALLS.format(name=name, last=len(pairs) - 1) + " .org 0x1000\n" + (PROGRAMS / "runtime.asm").read_text()
    words = [word for pair in pairs for value in pair for word in (value & 0xFFFF, value >> 16 & 0xFFFF)]
    run = Run(source, memory={"PAIRS": words}, reads=[("RESULTS", 2 * len(pairs))], cycles=10_000_000)
    assert run.registers["sp"] == 0x0400
    found = run.memory[0]
    return [low | high << 16 for low, high in zip(found[::2], found[1::2], strict=True)]


def signed(value, bits=32):
    return value - (1 << bits) if value >> (bits - 1) else value


def single(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def number(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def floats(rng):
    """Near to each other and far apart, of either sign, with long fractions and short ones."""
    bits = rng.getrandbits(31) & ~(0xFF << 23) | rng.randrange(100, 155) << 23
    return (bits if rng.randrange(2) else bits & 0xFFFF0000) | rng.getrandbits(1) << 31


ARITHMETIC = {
    "FS$$ADD": lambda a, b: a + b,
    "FS$$SUB": lambda a, b: a - b,
    "FS$$MPY": lambda a, b: a * b,
    "FS$$DIV": lambda a, b: a / b,
}


@pytest.mark.parametrize("name", ARITHMETIC)
def test_floating_point_is_rounded_as_ieee_has_it(name):
    """Python's floats of 64 bits have room for what rounding to 32 needs."""
    rng = random.Random(name)
    pairs = [(floats(rng), floats(rng)) for _ in range(COUNT)]
    pairs += [(a, a ^ 1 << 31) for a, _ in pairs[:5]] + [(a, a + 1) for a, _ in pairs[:5]]
    expected = [single(ARITHMETIC[name](number(a), number(b))) for a, b in pairs]
    assert [f"{value:08x}" for value in called(name, pairs)] == [f"{value:08x}" for value in expected]


def test_conversions_and_comparisons():
    rng = random.Random(41)
    whole = [0, 1, 0xFFFFFFFF, 0x80000000, 0x01000001, *(rng.getrandbits(rng.randrange(1, 33)) for _ in range(COUNT))]
    pairs = [(value, 0) for value in whole]
    assert called("UL$$TOFS", pairs) == [single(float(value)) for value in whole]
    assert called("L$$TOFS", pairs) == [single(float(signed(value))) for value in whole]
    assert called("U$$TOFS", pairs) == [single(float(value & 0xFFFF)) for value in whole]
    some = [single(value) for value in (0.0, -0.9, 1.0, -123456.75, 2.0**30 + 64, -(2.0**31) + 256)]
    assert [signed(value) for value in called("FS$$TOL", [(a, 0) for a in some])] == [int(number(a)) for a in some]
    compared = [(a, b) for a in some for b in some] + [(single(0.0), single(-0.0))]
    order = [(number(a) > number(b)) - (number(a) < number(b)) for a, b in compared]
    assert [signed(value & 0xFFFF, 16) for value in called("FS$$CMP", compared)] == order


def test_quotients_of_integers():
    rng = random.Random(7)
    pairs = [(rng.getrandbits(32), rng.getrandbits(rng.randrange(2, 33)) | 1) for _ in range(COUNT)]
    assert called("UL$$DIV", pairs) == [a // b for a, b in pairs]

    def towards_0(a, b):
        return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)

    assert [signed(got) for got in called("L$$DIV", pairs)] == [towards_0(signed(a), signed(b)) for a, b in pairs]
    short = [(signed(a & 0xFFFF, 16), signed(a >> 16, 16)) for a, _ in pairs]
    short = [(a, b or 3) for a, b in short]
    given = [(a & 0xFFFF | (b & 0xFFFF) << 16, 0) for a, b in short]
    assert [signed(got & 0xFFFF, 16) for got in called("I$$DIV", given)] == [towards_0(a, b) for a, b in short]
