"""Small assembly programs on the C28x core; what they should find comes from Python's integers."""

import math
import random

import pytest
from c28x_desk import Run, number_of, words_of

EDGES = (0, 1, 2, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 10, 0x12345678, 0xFEDCBA98)


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value


# --- division ---------------------------------------------------------------------------------------------------------

UNSIGNED_DIVISION = """
start:  MOVW DP,#0x200
        MOVB ACC,#0
        MOVL P,@num
        RPT #31
     || SUBCUL ACC,@den
        MOVL @quot,P
        MOVL @rest,ACC
        ESTOP0
        .org 0x8000
num:    .long 0
den:    .long 0
quot:   .long 0
rest:   .long 0
"""

WORD_DIVISION = """
start:  MOVW DP,#0x200
        MOVU ACC,@num
        RPT #15
     || SUBCU ACC,@den
        MOV @rest,AH
        MOV @quot,AL
        ESTOP0
        .org 0x8000
num:    .word 0
den:    .word 0
quot:   .word 0
rest:   .word 0
"""

SIGNED_DIVISION = """
start:  MOVW DP,#0x200
        CLRC TC
        MOVL ACC,@den
        ABSTC ACC               ; TC is the sign of the quotient
        MOVL XT,ACC
        MOVL ACC,@num
        ABSTC ACC
        MOVL P,ACC
        MOVB ACC,#0
        RPT #31
     || SUBCUL ACC,@XT
        MOVL @rest,ACC
        MOVL ACC,@P
        NEGTC ACC
        MOVL @quot,ACC
        ESTOP0
        .org 0x8000
num:    .long 0
den:    .long 0
quot:   .long 0
rest:   .long 0
"""


@pytest.mark.parametrize("num", EDGES)
@pytest.mark.parametrize("den", [den for den in EDGES if den])
def test_unsigned_division(num, den):
    run = Run(UNSIGNED_DIVISION, memory={"NUM": words_of(num, 2), "DEN": words_of(den, 2)}, reads=[("QUOT", 4)])
    assert (number_of(run.memory[0][:2]), number_of(run.memory[0][2:])) == divmod(num, den)


@pytest.mark.parametrize(("num", "den"), [(0, 1), (65535, 1), (65535, 65535), (12345, 67), (40000, 40001), (1, 2)])
def test_division_of_words(num, den):
    run = Run(WORD_DIVISION, memory={"NUM": [num], "DEN": [den]}, reads=[("QUOT", 2)])
    assert tuple(run.memory[0]) == divmod(num, den)


@pytest.mark.parametrize(("num", "den"), [(100, 7), (-100, 7), (100, -7), (-100, -7), (0x7FFFFFFF, -1), (-5, 9)])
def test_signed_division_rounds_towards_zero(num, den):
    run = Run(SIGNED_DIVISION, memory={"NUM": words_of(num, 2), "DEN": words_of(den, 2)}, reads=[("QUOT", 2)])
    exact = abs(num) // abs(den) * (1 if (num < 0) == (den < 0) else -1)
    assert signed(number_of(run.memory[0]), 32) == exact


# --- products ---------------------------------------------------------------------------------------------------------

LONG_PRODUCT = """
start:  MOVW DP,#0x200
        SPM 0
        MOVL XT,@a
        IMPYL P,XT,@b
        QMPYL ACC,XT,@b
        MOVL @product,P
        MOVL @product+2,ACC
        ESTOP0
        .org 0x8000
a:      .long 0
b:      .long 0
product: .long 0, 0
"""

# The lower 64 bits of a 64 x 64 product: the low words with all of their product, the mixed ones with their lower half.
WIDE_PRODUCT = """
start:  MOVW DP,#0x200
        SPM 0
        MOVL XT,@a
        QMPYUL P,XT,@b          ; upper half of low x low
        MOVL @product+2,P
        IMPYL P,XT,@b           ; lower half of low x low
        MOVL @product,P
        IMPYL P,XT,@b+2         ; low of a by high of b
        MOVL ACC,@product+2
        ADDUL ACC,@P
        MOVL XT,@a+2
        IMPYL P,XT,@b
        ADDUL ACC,@P
        MOVL @product+2,ACC
        ESTOP0
        .org 0x8000
a:      .long 0, 0
b:      .long 0, 0
product: .long 0, 0
"""


@pytest.mark.parametrize("a", EDGES)
@pytest.mark.parametrize("b", EDGES)
def test_signed_product_of_longs(a, b):
    run = Run(LONG_PRODUCT, memory={"A": words_of(a, 2), "B": words_of(b, 2)}, reads=[("PRODUCT", 4)])
    assert number_of(run.memory[0]) == signed(a, 32) * signed(b, 32) % 2**64


@pytest.mark.parametrize("seed", range(12))
def test_product_of_64_bits(seed):
    rng = random.Random(seed)
    a, b = rng.getrandbits(64), rng.getrandbits(64)
    run = Run(WIDE_PRODUCT, memory={"A": words_of(a, 4), "B": words_of(b, 4)}, reads=[("PRODUCT", 4)])
    assert number_of(run.memory[0]) == a * b % 2**64


# --- saturation -------------------------------------------------------------------------------------------------------

SUM = """
start:  {mode}
        CLRC OVC
        MOVL XAR4,#terms
        MOVB XAR0,#{last}
        ZAPA
next:   ADDL ACC,*XAR4++
        BANZ next,AR0--
        {after}
        ESTOP0
        .org 0x8000
terms:  .long {terms}
"""


def summed(terms, mode, after):
    there = ",".join(str(term % 2**32) for term in terms)
    return Run(SUM.format(mode=mode, last=len(terms) - 1, after=after, terms=there)).registers


@pytest.mark.parametrize("seed", range(6))
def test_a_sum_saturates_at_once_or_counts_and_saturates_at_the_end(seed):
    rng = random.Random(seed)
    terms = [rng.choice((1, -1)) * rng.randrange(1 << 30, 1 << 31) for _ in range(20)]
    limited = 0
    for term in terms:
        limited = max(-(2**31), min(2**31 - 1, limited + term))
    total = sum(terms)
    at_once = summed(terms, "SETC OVM", "NOP")
    assert signed(at_once["acc"], 32) == limited
    assert at_once["ovc"] == 0
    counted = summed(terms, "CLRC OVM", "NOP")
    assert signed(counted["acc"], 32) + signed(counted["ovc"], 8) * 2**32 == total
    at_end = summed(terms, "CLRC OVM", "SAT ACC")
    assert signed(at_end["acc"], 32) == max(-(2**31), min(2**31 - 1, total))
    assert (at_end["ovc"], at_end["v"]) == (0, int(not -(2**31) <= total < 2**31))


WIDE_SUM = """
start:  CLRC OVM
        CLRC OVC
        MOVW DP,#0x200
        MOVL P,@a
        MOVL ACC,@a+2
        ADDUL P,@b
        CLRC OVC
        ADDCL ACC,@b+2
        {after}
        MOVL @total,P
        MOVL @total+2,ACC
        ESTOP0
        .org 0x8000
a:      .long 0, 0
b:      .long 0, 0
total:  .long 0, 0
"""


@pytest.mark.parametrize(("a", "b"), [(2**62, 2**62), (-(2**63), -1), (5, -7), (2**32 - 1, 1), (-(2**63), 2**63 - 1)])
@pytest.mark.parametrize("saturate", [False, True])
def test_sum_of_64_bits(a, b, saturate):
    source = WIDE_SUM.format(after="SAT64 ACC:P" if saturate else "NOP")
    run = Run(source, memory={"A": words_of(a, 4), "B": words_of(b, 4)}, reads=[("TOTAL", 4)])
    limited = max(-(2**63), min(2**63 - 1, a + b))
    assert number_of(run.memory[0]) == (limited if saturate else a + b) % 2**64


# --- multiply and accumulate ------------------------------------------------------------------------------------------

FILTER = """
start:  {shift}
        ZAPA
        MOVL XAR6,#samples
        MOVL XAR7,#weights
        RPT #{last}
     || {mac}
        {rest}
        ESTOP0
        .org 0x8000
samples: .word {samples}
        .org 0x8100
weights: .word {weights}
"""


def filtered(rng, mac, rest, *, shift="SPM 0", count=16, bits=16):
    samples = [rng.randrange(-(2 ** (bits - 1)), 2 ** (bits - 1)) for _ in range(count)]
    weights = [rng.randrange(-(2 ** (bits - 1)), 2 ** (bits - 1)) for _ in range(count)]
    rows = [",".join(str(word) for value in row for word in words_of(value, bits // 16)) for row in (samples, weights)]
    last = count - 1 if "DMAC" not in mac else count // 2 - 1
    run = Run(FILTER.format(shift=shift, mac=mac, rest=rest, last=last, samples=rows[0], weights=rows[1]))
    return run, samples, weights


@pytest.mark.parametrize("seed", range(8))
def test_filter_of_words(seed):
    run, x, w = filtered(random.Random(seed), "MAC P,*XAR6++,*XAR7++", "ADDL ACC,P << PM")
    exact = sum(a * b for a, b in zip(x, w, strict=True))
    assert signed(run.registers["acc"], 32) + signed(run.registers["ovc"], 8) * 2**32 == exact
    assert (run.registers["xar6"], run.registers["xar7"]) == (0x8010, 0x8110)


@pytest.mark.parametrize("seed", range(8))
def test_filter_of_words_two_at_a_time(seed):
    run, x, w = filtered(random.Random(seed), "DMAC ACC:P,*XAR6++,*XAR7++", "ADDL ACC,@P", shift="SPM -4")
    halves = [sum(x[k] * w[k] >> 4 for k in range(first, 16, 2)) for first in (0, 1)]
    assert signed(run.registers["acc"], 32) == sum(halves)


@pytest.mark.parametrize("seed", range(8))
def test_filter_of_longs(seed):
    run, x, w = filtered(random.Random(seed), "QMACL P,*XAR6++,*XAR7++", "ADDL ACC,P << PM", bits=32)
    exact = sum(a * b >> 32 for a, b in zip(x, w, strict=True))
    assert signed(run.registers["acc"], 32) + signed(run.registers["ovc"], 8) * 2**32 == exact


@pytest.mark.parametrize(("mac", "cycles"), [("MAC P,*XAR6++,*XAR7++", 17), ("ADDU ACC,*XAR6++", 16), ("NOP", 16)])
def test_repeats_cost_a_cycle_each(mac, cycles):
    alone, _, _ = filtered(random.Random(1), "NOP", "NOP", count=1)
    run, _, _ = filtered(random.Random(1), mac, "NOP", count=16)
    assert run.cycles - alone.cycles == cycles - 1


# --- a series ---------------------------------------------------------------------------------------------------------

# sin(u pi/2) for u in Q31, by Horner's rule over y = u^2; coefficients and sums are Q30, products of two of them Q28.
SINE = """
start:  MOVW DP,#0x200
        SPM 0
        CLRC OVM
        MOVL XT,@u
        QMPYL ACC,XT,@u
        MOVL @y,ACC
        MOVL XAR4,#series
        MOVB XAR0,#3
        MOVL ACC,*XAR4++
next:   MOVL XT,ACC
        QMPYL ACC,XT,@y
        LSL ACC,#2
        ADDL ACC,*XAR4++
        BANZ next,AR0--
        MOVL XT,ACC
        QMPYL ACC,XT,@u         ; Q29
        LSL ACC,#1
        MOVL @sine,ACC
        ESTOP0
        .org 0x8000
u:      .long 0
y:      .long 0
sine:   .long 0
series: .long {series}
"""
SERIES = [round((-1) ** k * (math.pi / 2) ** (2 * k + 1) / math.factorial(2 * k + 1) * 2**30) for k in (4, 3, 2, 1, 0)]
SINE_CYCLES = 10 + 4 * (1 + 2 + 1 + 1) + (3 * 4 + 2) + 6
"""QMPYL into ACC takes 2 cycles, BANZ 4 where it goes back and 2 where it does not, all others 1, ESTOP0 among them."""


def sine_of(u):
    """The same in Python's integers."""
    y = u * u >> 32
    total = SERIES[0]
    for coefficient in SERIES[1:]:
        total = (total * y >> 32 << 2) + coefficient
    return (total * u >> 32) << 1


@pytest.mark.parametrize("u", [0, 1, -1, 0x12345678, -0x12345678, 0x5A827999, 0x7FFFFFFF, -0x80000000])
def test_sine_by_its_series(u):
    text = SINE.format(series=", ".join(map(str, SERIES)))
    run = Run(text, memory={"U": words_of(u, 2)}, reads=[("SINE", 2)])
    found = signed(number_of(run.memory[0]), 32)
    assert found == sine_of(u)
    left_out = (math.pi / 2) ** 11 / math.factorial(11)
    assert abs(found / 2**30 - math.sin(u / 2**31 * math.pi / 2)) < left_out + 2e-8
    assert run.cycles == SINE_CYCLES
