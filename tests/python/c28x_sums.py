"""What the second C28x calculates: sums, products, shifts, comparisons and logic, by the operations of the table."""

from c28x_machine import fits, flipped, signed

OPERATIONS = {}
BELOW, ABOVE = -(1 << 31), (1 << 31) - 1


def operation(*names):
    def keep(function):
        OPERATIONS.update(dict.fromkeys(names, function))
        return function

    return keep


def count(m, up):
    m.ovc = signed(m.ovc + (1 if up else -1), 6)


def into_acc(m, exact, unsigned_exact, borrows):
    """The sum that the accumulator's adder makes of an exact one, with its flags."""
    out = not 0 <= unsigned_exact < 1 << 32
    m.flags["c"] = int(out != borrows)
    if not fits(exact, 32):
        m.flags["v"] = 1
        if m.flags["ovm"]:
            exact = ABOVE if exact > 0 else BELOW
        else:
            count(m, exact > 0)
    m.set_nz(exact, 32)
    return exact % (1 << 32)


def plus(m, a, b, extra=0):
    return into_acc(m, signed(a, 32) + signed(b, 32) + extra, a % 2**32 + b % 2**32 + extra, False)


def minus(m, a, b, extra=0):
    return into_acc(m, signed(a, 32) - signed(b, 32) - extra, a % 2**32 - b % 2**32 - extra, True)


def extend(m, value):
    return signed(value, 16) if m.ext else value


def get(m, i, width=1):
    return m.place(i.loc, width)[0]()


def shift_of(m, i):
    return m.t % 16 if "<< T" in i.form.syntax else i.shift


@operation("add_acc_loc16", "add_acc_loc16_t", "sub_acc_loc16", "sub_acc_loc16_t")
def add_loc(m, i):
    before = m.flags["c"]
    adds = i.form.syntax.startswith("ADD")
    shift = shift_of(m, i)
    value = extend(m, get(m, i)) * 2**shift
    m.acc = (plus if adds else minus)(m, m.acc, value)
    if i.shift == 16 and m.flags["c"] != adds:
        m.flags["c"] = before


@operation("add_acc_const", "sub_acc_const")
def add_const(m, i):
    value = extend(m, i.constant) * 2**i.shift
    m.acc = (plus if i.form.syntax.startswith("ADD") else minus)(m, m.acc, value)


@operation("addb_acc", "subb_acc")
def add_byte(m, i):
    m.acc = (plus if i.form.syntax.startswith("ADD") else minus)(m, m.acc, i.constant)


@operation("addu", "subu", "addl_acc_loc32", "subl_acc_loc32", "addcu", "addcl", "sbbu", "subbl")
def add_plain(m, i):
    value = get(m, i, 2 if "32" in i.form.syntax else 1)
    name = i.form.operation
    carries = name in ("addcu", "addcl", "sbbu", "subbl")
    if name.startswith("add"):
        m.acc = plus(m, m.acc, value, m.flags["c"] if carries else 0)
    else:
        m.acc = minus(m, m.acc, value, 1 - m.flags["c"] if carries else 0)


def unsigned_sum(m, a, b, sign):
    exact = a + sign * b
    out = not 0 <= exact < 2**32
    if out:
        count(m, sign > 0)
    m.flags["c"] = int(out == (sign > 0))
    if not fits(signed(a, 32) + sign * signed(b, 32), 32):
        m.flags["v"] = 1
    m.set_nz(exact, 32)
    return exact % 2**32


@operation("addul_acc", "subul_acc", "addul_p", "subul_p")
def add_unsigned(m, i):
    value = get(m, i, 2)
    name = "p" if i.form.operation.endswith("_p") else "acc"
    sign = 1 if i.form.operation.startswith("add") else -1
    setattr(m, name, unsigned_sum(m, getattr(m, name), value, sign))


@operation("addl_loc32_acc", "subl_loc32_acc", "subrl")
def into_long(m, i):
    read, write = m.place(i.loc, 2)
    if i.form.operation == "addl_loc32_acc":
        write(plus(m, read(), m.acc))
    elif i.form.operation == "subl_loc32_acc":
        write(minus(m, read(), m.acc))
    else:
        write(minus(m, m.acc, read()))


def sum16(m, exact, unsigned_exact, borrows):
    m.flags["c"] = int((not 0 <= unsigned_exact < 2**16) != borrows)
    if not fits(exact, 16):
        m.flags["v"] = 1
    m.set_nz(exact, 16)
    return exact % 2**16


def plus16(m, a, b):
    return sum16(m, signed(a, 16) + signed(b, 16), a % 2**16 + b % 2**16, False)


def minus16(m, a, b):
    return sum16(m, signed(a, 16) - signed(b, 16), a % 2**16 - b % 2**16, True)


@operation("add_ax_loc16", "sub_ax_loc16", "addb_ax")
def add_ax(m, i):
    value = i.constant if i.form.operation == "addb_ax" else get(m, i)
    work = minus16 if i.form.operation == "sub_ax_loc16" else plus16
    m.set_half("acc", i.high, work(m, m.half("acc", i.high), value))


@operation("add_loc16_ax", "sub_loc16_ax", "subr", "add_loc16_const", "inc", "dec")
def into_word(m, i):
    read, write = m.place(i.loc)
    ax = m.half("acc", i.high)
    work = {
        "add_loc16_ax": lambda value: plus16(m, value, ax),
        "sub_loc16_ax": lambda value: minus16(m, value, ax),
        "subr": lambda value: minus16(m, ax, value),
        "add_loc16_const": lambda value: plus16(m, value, i.constant),
        "inc": lambda value: plus16(m, value, 1),
        "dec": lambda value: minus16(m, value, 1),
    }
    write(work[i.form.operation](read()))


def compare(m, a, b, bits, with_carry=True):
    exact = signed(a, bits) - signed(b, bits)
    m.flags["n"], m.flags["z"] = int(exact < 0), int(exact == 0)
    if with_carry:
        m.flags["c"] = int(a % 2**bits >= b % 2**bits)
    return exact


@operation("cmp_ax_loc16", "cmp_loc16_const", "cmpb", "cmpl_loc32", "cmpl_p")
def compare_all(m, i):
    name = i.form.operation
    if name == "cmp_loc16_const":
        compare(m, get(m, i), i.constant, 16)
    elif name == "cmpl_loc32":
        compare(m, m.acc, get(m, i, 2), 32)
    elif name == "cmpl_p":
        compare(m, m.acc, product_out(m), 32)
    else:
        value = i.constant if name == "cmpb" else get(m, i)
        compare(m, m.half("acc", i.high), value, 16)


@operation("max_ax", "min_ax", "maxl", "minl")
def extreme(m, i):
    wide = i.form.operation.endswith("l")
    value = get(m, i, 2 if wide else 1)
    old = m.acc if wide else m.half("acc", i.high)
    exact = compare(m, old, value, 32 if wide else 16, with_carry=wide)
    if exact < 0 if i.form.operation.startswith("max") else exact > 0:
        m.flags["v"] = 1
        if wide:
            m.acc = value
        else:
            m.set_half("acc", i.high, value)


@operation("maxcul", "mincul")
def lower_extreme(m, i):
    value = get(m, i, 2)
    wants_more = i.form.operation == "maxcul"
    n, z = m.flags["n"], m.flags["z"]
    better = m.p < value if wants_more else m.p > value
    if (n, z) == (int(wants_more), 0):
        m.p = value
    elif (n, z) == (0, 1) and better:
        m.p, m.flags["v"] = value, 1


@operation("subcu", "subcul")
def division_step(m, i):
    wide = i.form.operation == "subcul"
    value = get(m, i, 2 if wide else 1)
    doubled = 2 * ((m.acc << 32) + m.p)
    rest = (doubled >> 32) - value if wide else 2 * m.acc - value * 2**16
    m.flags["c"] = int(rest >= 0)
    if wide:
        m.p = (doubled + (rest >= 0)) % 2**32
        m.acc = (rest if rest >= 0 else doubled >> 32) % 2**32
    else:
        m.acc = (rest + 1 if rest >= 0 else 2 * m.acc) % 2**32
    m.set_nz(m.acc, 32)


LOGIC = {"and": int.__and__, "or": int.__or__, "xor": int.__xor__}


@operation(*(f"{name}_acc_{what}" for name in LOGIC for what in ("const", "loc16")))
def logic_acc(m, i):
    name, _, what = i.form.operation.split("_")
    value = i.constant * 2**i.shift if what == "const" else get(m, i)
    m.acc = LOGIC[name](m.acc, value) % 2**32
    m.set_nz(m.acc, 32)


@operation(*(f"{name}_ax_loc16" for name in LOGIC), "andb", "orb", "xorb", "and_ax_loc16_const")
def logic_ax(m, i):
    name = i.form.operation
    value = i.constant if name.endswith("b") else get(m, i)
    first = i.constant if name == "and_ax_loc16_const" else m.half("acc", i.high)
    result = LOGIC[name.split("_")[0].removesuffix("b")](first, value)
    m.set_half("acc", i.high, result)
    m.set_nz(result, 16)


@operation(*(f"{name}_loc16_{what}" for name in LOGIC for what in ("ax", "const")))
def logic_word(m, i):
    name, _, what = i.form.operation.split("_")
    read, write = m.place(i.loc)
    result = LOGIC[name](read(), (i.constant if what == "const" else m.half("acc", i.high)) % 2**16)
    write(result)
    m.set_nz(result, 16)


@operation("not_acc", "not_ax")
def invert(m, i):
    if i.form.operation == "not_acc":
        m.acc = 2**32 - 1 - m.acc
        m.set_nz(m.acc, 32)
    else:
        result = 2**16 - 1 - m.half("acc", i.high)
        m.set_half("acc", i.high, result)
        m.set_nz(result, 16)


@operation("neg_acc", "negtc", "abs", "abstc", "neg_ax", "neg64")
def negate(m, i):
    name = i.form.operation
    bits = {"neg_ax": 16, "neg64": 64}.get(name, 32)
    old = {16: m.half("acc", i.high), 32: m.acc, 64: (m.acc << 32) + m.p}[bits]
    number = signed(old, bits)
    if name == "abstc" and number < 0:
        m.flags["tc"] ^= 1
    does = m.flags["tc"] if name == "negtc" else number < 0 if name.startswith("abs") else True
    result = -number if does else number
    if not fits(result, bits):
        m.flags["v"] = 1
        result = 2 ** (bits - 1) - 1 if m.flags["ovm"] and bits > 16 else number
    if name.startswith("abs"):
        m.flags["c"] = 0
    elif does:
        m.flags["c"] = int(number == 0)
    m.set_nz(result, bits)
    keep(m, i, result, bits)


def keep(m, i, value, bits):
    if bits == 16:
        m.set_half("acc", i.high, value)
    elif bits == 32:
        m.acc = value % 2**32
    else:
        m.acc, m.p = value % 2**64 >> 32, value % 2**32


@operation("sat", "sat64")
def saturate(m, i):
    bits = 32 if i.form.operation == "sat" else 64
    value = m.acc if bits == 32 else (m.acc << 32) + m.p
    m.flags["v"] = int(m.ovc != 0)
    if m.ovc:
        value = 2 ** (bits - 1) - 1 if m.ovc > 0 else -(2 ** (bits - 1))
    m.ovc = m.flags["c"] = 0
    keep(m, i, value, bits)
    m.set_nz(value, bits)


SHIFTS = {
    **{
        "lsl_acc": (32, 0, 1),
        "lsl_acc_t": (32, 15, 1),
        "lsll_t": (32, 31, 1),
        "sfr": (32, 0, -1),
        "sfr_t": (32, 15, -1),
    },
    **{"asrl_t": (32, 31, -1), "lsrl_t": (32, 31, -1), "lsl_ax": (16, 0, 1), "lsl_ax_t": (16, 15, 1)},
    **{"lsr_ax": (16, 0, -1), "lsr_ax_t": (16, 15, -1), "asr_ax": (16, 0, -1), "asr_ax_t": (16, 15, -1)},
    **{"lsl64": (64, 0, 1), "lsl64_t": (64, 63, 1), "lsr64": (64, 0, -1), "lsr64_t": (64, 63, -1)},
    **{"asr64": (64, 0, -1), "asr64_t": (64, 63, -1)},
}
"""Width, mask of T (0: a constant shift), direction."""


@operation(*SHIFTS)
def shift(m, i):
    name = i.form.operation
    bits, mask, way = SHIFTS[name]
    old = {16: m.half("acc", i.high), 32: m.acc, 64: (m.acc << 32) + m.p}[bits]
    by = m.t & mask if mask else i.shift
    if name.startswith("asr") or (name.startswith("sfr") and m.flags["sxm"]):
        old = signed(old, bits)
    if way > 0:
        m.flags["c"] = old * 2**by >> bits & 1
        value = old * 2**by
    else:
        m.flags["c"] = 2 * old // 2**by % 2 if by else 0
        value = old // 2**by
    keep(m, i, value, bits)
    m.set_nz(value, bits)


@operation("rol", "ror")
def rotate(m, i):
    ring = (m.flags["c"] << 32) + m.acc
    ring = (2 * ring) % 2**33 + (ring >> 32) if i.form.operation == "rol" else ring // 2 + ring % 2 * 2**32
    m.flags["c"], m.acc = ring >> 32, ring % 2**32
    m.set_nz(m.acc, 32)


@operation("cmp64", "test_acc")
def test(m, i):
    if i.form.operation == "test_acc":
        m.set_nz(m.acc, 32)
        return
    m.set_nz((m.acc << 32) + m.p, 64)
    m.flags["n"] ^= m.flags["v"]
    m.flags["v"] = 0


@operation("csb")
def count_sign_bits(m, i):
    text = f"{m.acc:032b}"
    m.set_half("xt", True, len(text) - len(text.lstrip(text[0])) - 1)
    m.flags["tc"] = int(text[0])
    m.set_nz(m.acc, 32)


@operation("norm_ind", "norm_xar")
def normalise(m, i):
    small = fits(2 * signed(m.acc, 32), 32) and m.acc != 0
    m.flags["tc"] = int(not small)
    if small:
        m.acc = 2 * m.acc % 2**32
        by = m.half(0, False)
        n = i.n if i.form.operation == "norm_xar" else m.arp
        m.step_xar(n, (0, 1, -1, by, -by)[i.shift])
    m.set_nz(m.acc, 32)


@operation("flip")
def flip(m, i):
    result = flipped(m.half("acc", i.high))
    m.set_half("acc", i.high, result)
    m.set_nz(result, 16)


def product_out(m):
    """P through the product shifter, as a number."""
    return signed(signed(m.p, 32) * 2 // 2**m.pm, 32)
