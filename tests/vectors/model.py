"""The vectors' results by their definitions, in Python's integers: what vectors.c has to find on every processor.

Sums, products, quotients and roots follow from "the nearest 32-bit number", with the rounding that the headers state.
Reciprocal, sine and arc tangent are defined with an error; their method is computed here anew, from tables that are
made, not copied.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

Words = list[int]

LOW, HIGH = -(1 << 31), (1 << 31) - 1
MASK = (1 << 32) - 1
BLOCKS, CASES = 8, 64
EDGES = (0, 1, -1, 2, -2, 32767, -32768, 32768, 65535, 65536, -65536, 1 << 30, HIGH - 1, HIGH, LOW, -HIGH)
QUARTER_SINE = [round(math.sin(math.radians(90 * i / 64)) * (1 << 30)) for i in range(65)]
RECIPROCAL = [round((1 << 24) / (2 * (128 + i) + 1)) for i in range(128)]
ONE_Q15 = 32767


def limited(x: int, low: int = LOW, high: int = HIGH) -> int:
    """The nearest number of the range."""
    return min(max(x, low), high)


def wrapped(x: int) -> int:
    """The low 32 bits as a signed number."""
    return ((x & MASK) ^ 0x80000000) - 0x80000000


def rounded(x: int, shift: int) -> int:
    """x / 2^shift, halves up."""
    return (x + (1 << shift >> 1)) >> shift


def half_away(num: int, den: int) -> int:
    """num / den to the nearest integer, halves away from zero."""
    size = (2 * abs(num) + abs(den)) // (2 * abs(den))
    return -size if (num < 0) != (den < 0) else size


def toward_zero(num: int, den: int) -> int:
    """C's quotient."""
    return abs(num) // den if num >= 0 else -(abs(num) // den)


def quotient(num: int, den: int, shift: int = 0) -> int:
    """num * 2^shift / den, saturated; by zero with the sign of num."""
    if den == 0:
        return 0 if num == 0 else (HIGH if num > 0 else LOW)
    return limited(half_away(num << shift, den))


def root(x: int) -> int:
    """The nearest integer to the root."""
    floor = math.isqrt(x)
    return floor + (x - floor * floor > floor)


def reciprocal_q31(divisor: int) -> int:
    """2^63 / divisor from below, by two Newton steps."""
    seed = RECIPROCAL[(divisor >> 24) - 128] << 16
    estimate = seed * (~(divisor * seed >> 32) & MASK) >> 31
    rest = ((1 << 63) - divisor * estimate) >> 16
    return estimate + (estimate * rest >> 47)


def sincos(angle: int) -> tuple[int, int]:
    """Angle sum from the nearest of 64 nodes of a quarter turn, to third order."""
    phase = angle & ((1 << 30) - 1)
    node = (phase + (1 << 23)) >> 24
    distance = (phase - (node << 24)) * 256 * 1686629713 >> 32
    square = distance * distance >> 32
    cube = distance * square >> 32
    step = distance - ((cube * 715827883 >> 32) >> 8)
    sin_a, cos_a = QUARTER_SINE[node], QUARTER_SINE[64 - node]
    sine = sin_a + rounded((cos_a * step >> 32) - ((sin_a * square >> 32) >> 5), 4)
    cosine = cos_a + rounded(-(sin_a * step >> 32) - ((cos_a * square >> 32) >> 5), 4)
    for _ in range(angle >> 30):
        sine, cosine = cosine, -sine
    return sine, cosine


def arctangent(t: int) -> int:
    """Binary angle of a tangent in Q31, 0 to 1, by the header's polynomial."""
    u = t * t >> 31
    p = -422311978
    for coefficient in (1033810582, -1211158625, 971703253, -661142237, 443664106, -324622312, 293388565):
        p = (p * u >> 32) + coefficient
    return rounded(t * ((1 << 29) + (p * (HIGH - u) >> 32)), 31)


def atan2(y: int, x: int) -> int:
    """Angle of a vector."""
    longer, shorter = max(abs(x), abs(y)), min(abs(x), abs(y))
    if longer == 0:
        return 0
    zeros = 32 - longer.bit_length()
    angle = arctangent((shorter << zeros) * reciprocal_q31(longer << zeros) >> 32)
    if abs(y) > abs(x):
        angle = (1 << 30) - angle
    if x < 0:
        angle = (1 << 31) - angle
    return -angle if y < 0 else angle


@dataclass
class Vectors:
    """The generator of vectors.c and the functions on its numbers."""

    state: int = 0
    tracking: list[int] = field(default_factory=lambda: [0, 0, 0, 0])
    region: int = 0
    share: int = ONE_Q15

    def draw(self) -> int:
        """Marsaglia's xorshift32."""
        x = self.state
        x ^= x << 13 & MASK
        x ^= x >> 17
        self.state = x = x ^ (x << 5 & MASK)
        return x

    def below(self, count: int) -> int:
        """0 .. count - 1."""
        return (self.draw() >> 8) % count

    def number(self) -> int:
        """Of every size, every eighth an edge."""
        kind = self.draw()
        if kind & 7 == 0:
            return EDGES[self.below(16)]
        shift = self.below(32)
        size = self.draw() >> shift
        return wrapped(-size if kind & 8 else size)

    def sums(self) -> Words:
        a, b = self.number(), self.number()
        return [limited(a + b), limited(a - b), limited(-a), limited(abs(a)), abs(b)]

    def shifts(self) -> Words:
        a = self.number()
        n = self.below(32)
        return [limited(a << (n if n < 31 else 0)), a >> n, rounded(a, n), 32 - (a & MASK).bit_length()]

    def products(self) -> Words:
        a, b = self.number(), self.number()
        shift = 1 + self.below(62)
        return [limited(rounded(a * b, shift)), a * b >> 32, (a & MASK) * (b & MASK) >> 32]

    def sums_of_products(self) -> Words:
        a, b, c, d = self.number() >> 2, self.number(), self.number() >> 2, self.number()
        shift = 1 + self.below(62)
        return [limited(rounded(a * b + c * d, shift)), limited(rounded(a * b - c * d, shift))]

    def halves(self) -> Words:
        a, b = (limited(self.number() >> 8, -32768, 32767) for _ in range(2))
        return [limited(x, -32768, 32767) for x in (a + b, a - b, rounded(a * b, 15))]

    def quotients(self) -> Words:
        num, den = self.number(), self.number()
        exact = quotient(num, den, self.below(32))
        divisor = max(den, 1)
        zeros = 32 - divisor.bit_length()
        inverse = reciprocal_q31(divisor << zeros) >> 1
        over = limited(rounded(num * inverse, 62 - zeros - self.below(31)))
        most = 31 + den.bit_length() - num.bit_length()
        large = quotient(num, den, most) if 0 <= most < 32 else 0
        return [exact, reciprocal_q31(den & MASK | 1 << 31), over, large]

    def roots(self) -> Words:
        upper, lower = self.number(), self.number()
        x = (upper & MASK) << 32 | lower & MASK
        square = (lower & MASK) ** 2
        near = (square, square + (lower & MASK), square + (lower & MASK) + 1)
        both = [min(root(x), MASK), root(lower & MASK), min(root(upper**2 + lower**2), HIGH)]
        return [*both, *(min(root(each & ((1 << 64) - 1)), MASK) for each in near)]

    def angles(self) -> Words:
        sine, cosine = sincos(self.number() & MASK)
        y, x = self.number(), self.number()
        return [sine, cosine, atan2(y, x)]

    def frames(self) -> Words:
        a, b = self.number() >> 3, self.number() >> 3
        beta = (a + 2 * b) * round((1 << 30) / math.sqrt(3)) >> 30
        sine, cosine = sincos(self.number() & MASK)
        d, q = (a * cosine + beta * sine) >> 30, (beta * cosine - a * sine) >> 30
        alpha, beta = (d * cosine - q * sine) >> 30, (d * sine + q * cosine) >> 30
        side, half = 2 * (beta * round((1 << 31) * math.sqrt(3) / 2) >> 32), alpha >> 1
        return [d, q, alpha, side - half, -side - half]

    def tracking_observer(self) -> Words:
        angle, speed, load, rest = self.tracking
        change_q8 = limited(rest + limited((self.number() >> 4) - load))
        change = change_q8 >> 8
        angle += speed + toward_zero(change, 2)
        speed, rest = limited(speed + change), change_q8 - change * 256
        error, bandwidth = self.number(), self.draw() >> 8
        squared = rounded(bandwidth**2, 30)
        angle += rounded(error * 3 * bandwidth, 30)
        speed = limited(speed + rounded(error * 3 * squared, 30))
        load = limited(load - rounded(error * rounded(squared * bandwidth, 24), 28))
        self.tracking = [angle & MASK, speed, load, rest]
        return self.tracking

    def output(self) -> Words:
        """Angle, speed, load, quality."""
        return [self.number() & MASK, self.number() >> 8, self.number() >> 3, self.below(32768)]

    def blend(self) -> Words:
        low_end = 1 + self.below(1000000)
        high_end = 1000001 + self.below(9000000)
        low, high = self.output(), self.output()

        def mixed(k: int) -> int:
            return high[k] + rounded(limited(low[k] - high[k]) * (self.share + (self.share >> 14)), 15)

        speed = abs(mixed(1))
        band = (high_end - low_end) // 8
        if speed < low_end + (band if self.region == 0 else 0):
            self.region = 0
        else:
            self.region = 2 if speed > high_end - (band if self.region == 2 else 0) else 1
        per_range = quotient(ONE_Q15, high_end - low_end, 30)
        between = limited(limited(rounded((high_end - speed) * per_range, 30)), 0, ONE_Q15)
        wanted = (ONE_Q15, between, 0)[self.region]
        self.share += limited(wanted - self.share, -(ONE_Q15 // 100), ONE_Q15 // 100)
        apart = wrapped(low[0] - high[0])
        angle = high[0] + rounded(apart * (self.share + (self.share >> 14)), 15)
        return [angle, mixed(1), mixed(2), mixed(3), self.share]

    @property
    def groups(self) -> list[Callable[[], Words]]:
        """In the order of vectors.c."""
        return [
            *(self.sums, self.shifts, self.products, self.sums_of_products, self.halves, self.quotients, self.roots),
            *(self.angles, self.frames, self.tracking_observer, self.blend),
        ]


def expected() -> Iterator[str]:
    """The lines of run_vectors."""
    vectors = Vectors()
    for number, group in enumerate(vectors.groups):
        vectors.state = 2463534242 + number
        for block in range(BLOCKS):
            value = 2166136261
            for _ in range(CASES):
                for word in group():
                    value = (value ^ word & MASK) * 16777619 & MASK
            yield f"{group.__name__} {block} {value:08x}"
