"""A second C28x, in Python integers: registers, memory and locations.

Its operations are in c28x_sums, c28x_moves and c28x_pointers.

It shares the table of instructions with the core in C++ and nothing else. What a value is, is worked out as a number
and brought into its width afterwards; flags are questions about the exact number.
"""

from dataclasses import dataclass, field
from functools import partial

from stillspin.c28x.table import Form, find

FLAGS = ("sxm", "ovm", "tc", "c", "z", "n", "v")
MAPPED = ((0, 0x10000), (0x3F0000, 0x400000))
"""The memory of the desk; elsewhere there is none."""


def signed(value, bits):
    value %= 1 << bits
    return value - (1 << bits) if value >= 1 << (bits - 1) else value


def fits(value, bits):
    return -(1 << (bits - 1)) <= value < 1 << (bits - 1)


def flipped(value):
    return int(f"{value % (1 << 16):016b}"[::-1], 2)


@dataclass
class Fields:
    """What an instruction says beside its operation."""

    form: Form
    loc: int = 0
    high: bool = False
    constant: int = 0
    shift: int = 0
    condition: int = 0
    bit: int = 0
    n: int = 0
    address: int = 0


def fields_of(form, bits, address):
    def get(letter, fixed):
        return form.get(letter, bits) if letter in form.fields else form.fixed.get(fixed, 0)

    constant = get("C", "value")
    if "Signed" in form.syntax:
        constant = signed(constant, form.fields["C"].width)
    bias = int("S" in form.fields and any(text in form.syntax for text in ("#1..16", "#2..8")))
    return Fields(
        form,
        loc=get("L", "loc"),
        high=bool(get("A", "ax")),
        constant=constant,
        shift=get("S", "shift") + bias,
        condition=get("K", "cond"),
        bit=get("B", "bit"),
        n=get("n", "reg"),
        address=address,
    )


@dataclass
class Machine:
    acc: int = 0
    p: int = 0
    xt: int = 0
    xar: list = field(default_factory=lambda: [0] * 8)
    sp: int = 0x400
    dp: int = 0
    pc: int = 0
    rpc: int = 0
    ifr: int = 0
    ier: int = 0
    dbgier: int = 0
    pm: int = 0
    ovc: int = 0
    arp: int = 0
    page0: int = 0
    spa: int = 0
    flags: dict = field(default_factory=lambda: dict.fromkeys(FLAGS, 0))
    memory: dict = field(default_factory=dict)
    ports: dict = field(default_factory=dict)
    repeated: int = 0

    def read(self, address):
        return self.memory.get(address % (1 << 22), 0)

    def write(self, address, value):
        address %= 1 << 22
        if any(first <= address < end for first, end in MAPPED):
            self.memory[address] = value % (1 << 16)

    def read_long(self, address):
        address -= address % 2
        return self.read(address) + (self.read(address + 1) << 16)

    def write_long(self, address, value):
        address -= address % 2
        self.write(address, value)
        self.write(address + 1, value >> 16)

    # Halves of registers: (name, upper half?).
    def half(self, name, upper):
        value = self.xar[name] if isinstance(name, int) else getattr(self, name)
        return value >> 16 if upper else value % (1 << 16)

    def set_half(self, name, upper, half):
        half %= 1 << 16
        value = self.xar[name] if isinstance(name, int) else getattr(self, name)
        value = (half << 16) + value % (1 << 16) if upper else (value >> 16 << 16) + half
        self.set_long(name, value)

    def long(self, name):
        return self.xar[name] if isinstance(name, int) else getattr(self, name)

    def set_long(self, name, value):
        value %= 1 << 32
        if isinstance(name, int):
            self.xar[name] = value
        else:
            setattr(self, name, value)

    @property
    def t(self):
        return self.xt >> 16

    @property
    def ext(self):
        return self.flags["sxm"]

    def set_nz(self, value, bits):
        self.flags["n"] = int(signed(value, bits) < 0)
        self.flags["z"] = int(value % (1 << bits) == 0)

    def step_xar(self, n, by):
        self.xar[n] = (self.xar[n] + by) % (1 << 32)

    # --- locations: a getter and a setter for one access of `width` words -----------------------------------------
    def place(self, loc, width=1):
        registers = {8: ("acc", True), 9: ("acc", False), 10: ("p", True), 11: ("p", False), 12: ("xt", True)}
        if 0xA0 <= loc <= 0xAD:
            return self._register(loc - 0xA0, registers, width)
        address = self._address(loc, width)
        if width == 1:
            return partial(self.read, address), partial(self.write, address)
        return partial(self.read_long, address), partial(self.write_long, address)

    def _register(self, code, registers, width):
        if code == 13:
            return (lambda: self.sp), (lambda value: setattr(self, "sp", value % (1 << 16)))
        name, upper = registers.get(code, (code, False))
        if width == 1:
            return partial(self.half, name, upper), partial(self.set_half, name, upper)
        return partial(self.long, name), partial(self.set_long, name)

    def _address(self, loc, width):
        low = loc % 64
        if loc < 64:
            return self.dp * 64 + low
        if loc < 128:
            return low if self.page0 else (self.sp - low) % (1 << 16)
        if loc == 0xBD:
            at = self.sp
            self.sp = (self.sp + width) % (1 << 16)
            return at
        if loc == 0xBE:
            self.sp = (self.sp - width) % (1 << 16)
            return self.sp
        if 0xA8 <= loc < 0xC0:
            return self._indirect(loc, width)
        return self._pointer(loc, width)

    def _pointer(self, loc, width):
        n = self.arp = loc % 8
        at = self.xar[n]
        if loc < 0x88:
            self.step_xar(n, width)
            return at
        if loc < 0x90:
            self.step_xar(n, -width)
            return self.xar[n]
        if loc < 0xA0:
            return at + self.half((loc - 0x90) // 8, False)
        return at + (loc - 0xC0) // 8

    def _indirect(self, loc, width):
        n, by = self.arp, self.half(0, False)
        if loc == 0xBF:
            at, self.arp = self.xar[6], 6
            if at % 256 == self.xar[1] % 256:
                self.xar[6] = at - at % 256
            else:
                self.set_half(6, False, at + width)
            return at
        at = self.xar[n]
        if loc < 0xB0:  # addition with the carry the other way round
            total = flipped(at) + (flipped(by) if loc == 0xAE else -flipped(by))
            self.set_half(n, False, flipped(total))
        elif loc < 0xB8:
            self.arp = loc % 8
        else:
            self.step_xar(n, {0xB8: 0, 0xB9: width, 0xBA: -width, 0xBB: by, 0xBC: -by}[loc])
        return at

    # --- one instruction ------------------------------------------------------------------------------------------
    def step(self, operations):
        word0, word1 = self.read(self.pc), self.read(self.pc + 1)
        form = find(word0, word1)
        bits = (word0 << 16) + word1 if form.words == 2 else word0
        i = fields_of(form, bits, self.pc)
        self.pc += form.words
        if form.operation in ("rpt_const", "rpt_loc16"):
            count = i.constant if form.operation == "rpt_const" else self.place(i.loc)[0]()
            self._repeat(count, operations)
        else:
            operations[form.operation](self, i)
        return form

    def _repeat(self, count, operations):
        at, form = self.pc, self.step(operations)
        if form.repeatable:
            for self.repeated in range(1, count + 1):
                after, self.pc = self.pc, at
                self.step(operations)
                self.pc = after
        self.repeated = 0

    def state(self):
        names = ("acc", "p", "xt", "sp", "dp", "pc", "ifr", "ier", "dbgier", "pm", "arp", "page0", "spa")
        return {
            **{name: getattr(self, name) for name in names},
            **{f"xar{n}": value for n, value in enumerate(self.xar)},
            **self.flags,
            "ovc": self.ovc % 256,
        }
