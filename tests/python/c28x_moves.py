"""What the second C28x multiplies and moves, by the operations of the table."""

from c28x_machine import signed
from c28x_sums import get, minus, operation, plus, product_out, unsigned_sum

HIGH_PAGE = 0x3F0000
AX, ACC = (0xA8, 0xA9), (0xA9,)


def accumulate(m, name):
    if name in ("mpys_t", "sqrs", "movs", "qmpysl"):
        m.acc = minus(m, m.acc, product_out(m))
    elif name == "movp":
        m.acc = product_out(m) % 2**32
        m.set_nz(m.acc, 32)
    elif name == "impysl":
        m.acc = unsigned_sum(m, m.acc, m.p, -1)
    elif name in ("impyal", "imacl"):
        m.acc = unsigned_sum(m, m.acc, m.p, 1)
    elif name in ACCUMULATING:
        m.acc = plus(m, m.acc, product_out(m))


ACCUMULATING = (
    *("mpya_t", "mpya_loc16_const", "sqra", "mova", "movad", "qmpyal", "qmacl", "mac_pma", "mac_xar7", "xmac", "xmacd"),
)


def result(m, name, value):
    if "_acc" in name:
        m.acc = value % 2**32
        m.set_nz(m.acc, 32)
    else:
        m.p = value % 2**32


@operation("mpy_acc_t", "mpy_p_t", "mpyu_acc", "mpyu_p", "mpyxu_acc", "mpyxu_p", "mpya_t", "mpys_t")
def by_t(m, i):
    name = i.form.operation
    other = get(m, i)
    accumulate(m, name)
    first = m.t if name.startswith("mpyu_") else signed(m.t, 16)
    result(m, name, first * (other if "u_" in name else signed(other, 16)))


@operation("mpy_acc_loc16_const", "mpy_p_loc16_const", "mpya_loc16_const", "mpyb_acc", "mpyb_p")
def by_constant(m, i):
    name = i.form.operation
    if not name.startswith("mpyb"):
        first = get(m, i)
        accumulate(m, name)
        if name != "mpy_p_loc16_const":
            m.set_half("xt", True, first)
    else:
        first = m.t
    result(m, name, signed(first, 16) * i.constant)


@operation("sqra", "sqrs", "mova", "movs", "movp")
def load_t(m, i):
    value = get(m, i)
    accumulate(m, i.form.operation)
    m.set_half("xt", True, value)
    if i.form.operation.startswith("sqr"):
        m.p = signed(m.t, 16) ** 2


@operation("movad", "xmacd", "dmov", "movdl")
def delay(m, i):
    name = i.form.operation
    width = 2 if name == "movdl" else 1
    accumulate(m, name)
    at = m._address(i.loc, width)
    if width == 2:
        m.xt = m.read_long(at)
        m.write_long(at + 2, m.xt)
        return
    value = m.read(at)
    if name != "dmov":
        m.set_half("xt", True, value)
    if name == "xmacd":
        m.p = signed(value, 16) * signed(m.read(HIGH_PAGE + (i.constant + m.repeated) % 2**16), 16) % 2**32
    m.write(at + 1, value)


@operation("mac_pma", "xmac", "mac_xar7")
def mac(m, i):
    name = i.form.operation
    if name == "mac_xar7":
        at = m.xar[7]
    else:
        at = i.constant + m.repeated if name == "mac_pma" else HIGH_PAGE + (i.constant + m.repeated) % 2**16
    first = get(m, i)
    accumulate(m, name)
    m.set_half("xt", True, first)
    if name == "mac_xar7" and at == m.xar[7]:
        m.step_xar(7, i.n)
    m.p = signed(m.t, 16) * signed(m.read(at), 16) % 2**32


@operation("imacl", "qmacl", "dmac")
def mac_long(m, i):
    name = i.form.operation
    at = m.xar[7]
    other = m.read_long(at)
    first = get(m, i, 2)
    if m.xar[7] == at:
        m.step_xar(7, 2 * i.n)
    accumulate(m, name)
    if name == "dmac":
        m.xt = first
        kept = m.p
        m.p = signed(first % 2**16, 16) * signed(other % 2**16, 16)
        lower = product_out(m)
        m.p = signed(first >> 16, 16) * signed(other >> 16, 16)
        m.acc = plus(m, m.acc, product_out(m))
        m.p = (kept + lower) % 2**32
    else:
        long_product(m, name, signed(first, 32) * signed(other, 32))


def long_product(m, name, product):
    if name.startswith("q"):
        result(m, name, product >> 32)
    elif "_acc" in name:
        result(m, name, product)
    else:
        m.p = product * 2 // 2**m.pm % 2**32


@operation(*("impyl_acc", "impyl_p", "impyxul", "impyal", "impysl"))
@operation(*("qmpyl_acc", "qmpyl_p", "qmpyul", "qmpyxul", "qmpyal", "qmpysl"))
def by_xt(m, i):
    name = i.form.operation
    other = get(m, i, 2)
    accumulate(m, name)
    first = m.xt if name == "qmpyul" else signed(m.xt, 32)
    long_product(m, name, first * (other if "ul" in name else signed(other, 32)))


# --- moves ------------------------------------------------------------------------------------------------------------


def store(m, i, value, width=1):
    m.place(i.loc, width)[1](value)
    if i.loc in (AX if width == 1 else ACC):
        m.set_nz(value, 16 * width)


@operation("mov_acc_const", "mov_acc_loc16", "mov_acc_loc16_t", "movb_acc", "movu_acc_loc16", "movl_acc_loc32")
@operation("zalr", "zapa")
def load_acc(m, i):
    name = i.form.operation
    by = m.t % 16 if name.endswith("_t") else i.shift
    if name == "zalr":
        value = get(m, i) * 2**16 + 2**15
    elif name == "zapa":
        value = m.p = m.ovc = 0
    elif name.startswith("mov_"):
        value = i.constant if name == "mov_acc_const" else get(m, i)
        value = (signed(value, 16) if m.ext else value) * 2**by
    else:
        value = i.constant if name == "movb_acc" else get(m, i, 2 if name.startswith("movl") else 1)
    m.acc = value % 2**32
    m.set_nz(m.acc, 32)


@operation("mov_ax_loc16", "movb_ax")
def load_ax(m, i):
    value = i.constant if i.form.operation == "movb_ax" else get(m, i)
    m.set_half("acc", i.high, value)
    m.set_nz(value, 16)


@operation("mov_ph_loc16", "mov_pl_loc16", "mov_t_loc16", "mov_tl_zero", "mov_ar_loc16", "movb_ar")
def load_half(m, i):
    name = i.form.operation
    value = i.constant if name == "movb_ar" else 0 if name == "mov_tl_zero" else get(m, i)
    where = {"mov_ph_loc16": ("p", True), "mov_pl_loc16": ("p", False), "mov_t_loc16": ("xt", True)}
    m.set_half(*where.get(name, ("xt", False) if name == "mov_tl_zero" else (i.n, False)), value)


@operation(*("movz_ar_loc16", "movb_xar", "movl_xar_const", "movl_xar_loc32", "mov_xar_pc"))
@operation(*("movl_p_acc", "movl_p_loc32", "movl_xt_loc32", "movx_tl_loc16"))
def load_long(m, i):
    name = i.form.operation
    sources = {"movb_xar": i.constant, "movl_xar_const": i.constant, "mov_xar_pc": i.address, "movl_p_acc": m.acc}
    if name in sources:
        value = sources[name]
    elif name.endswith("loc16"):
        value = signed(get(m, i), 16) if name.startswith("movx") else get(m, i)
    else:
        value = get(m, i, 2)
    target = {"movl_p": "p", "movl_xt": "xt", "movx_t": "xt"}
    m.set_long(next((there for begin, there in target.items() if name.startswith(begin)), i.n), value)


@operation("mov_dp", "movw_dp", "spm", "mov_pm_ax", "mov_ovc_loc16", "movu_ovc_loc16", "clrc_ovc", "mov_ier_loc16")
def load_small(m, i):
    name = i.form.operation
    if name == "mov_dp":
        m.dp = m.dp // 1024 * 1024 + i.constant
    elif name == "movw_dp":
        m.dp = i.constant
    elif name in ("spm", "mov_pm_ax"):
        m.pm = i.constant if name == "spm" else m.half("acc", i.high) % 8
    elif name == "mov_ier_loc16":
        m.ier = get(m, i)
    else:
        value = 0 if name == "clrc_ovc" else get(m, i)
        m.ovc = signed(value >> 10 if name.startswith("mov_") else value, 6)


STORES = (
    *("mov_loc16_const", "mov_loc16_acc", "movh_loc16_acc", "mov_loc16_p", "movh_loc16_p", "mov_loc16_ar"),
    *("mov_loc16_ax", "mov_loc16_t", "mov_loc16_ovc", "movu_loc16_ovc", "mov_loc16_ier"),
    *("movl_loc32_acc", "movl_loc32_p", "movl_loc32_xar", "movl_loc32_xt"),
)


def stored(m, i):
    return {
        "mov_loc16_const": i.constant,
        "mov_loc16_acc": m.acc * 2**i.shift,
        "movh_loc16_acc": m.acc * 2**i.shift >> 16,
        "mov_loc16_p": product_out(m),
        "movh_loc16_p": product_out(m) >> 16,
        "mov_loc16_ar": m.half(i.n, False),
        "mov_loc16_ax": m.half("acc", i.high),
        "mov_loc16_t": m.t,
        "mov_loc16_ovc": m.ovc * 2**10,
        "movu_loc16_ovc": m.ovc % 64,
        "mov_loc16_ier": m.ier,
        "movl_loc32_acc": m.acc,
        "movl_loc32_p": m.p,
        "movl_loc32_xar": m.xar[i.n],
        "movl_loc32_xt": m.xt,
    }


@operation(*STORES)
def store_any(m, i):
    name = i.form.operation
    width = 2 if name.startswith("movl") else 1
    store(m, i, stored(m, i)[name] % (1 << 16 * width), width)


def holds(m, condition):
    f = m.flags
    answers = (
        *(not f["z"], f["z"], not f["n"] and not f["z"], not f["n"], f["n"], f["n"] or f["z"], f["c"] and not f["z"]),
        *(f["c"], not f["c"], not f["c"] or f["z"], not f["v"], f["v"], not f["tc"], f["tc"], False, True),
    )
    answer = bool(answers[condition])
    if condition in (10, 11):
        f["v"] = 0
    return answer


@operation("mov_loc16_ax_cond", "movb_loc16_const_cond", "movl_loc32_acc_cond")
def store_if(m, i):
    name = i.form.operation
    value = {"mov": m.half("acc", i.high), "movb": i.constant, "movl": m.acc}[name.split("_")[0]]
    width = 2 if name.startswith("movl") else 1
    write = m.place(i.loc, width)[1]
    if holds(m, i.condition):
        write(value)
        if i.loc in (AX if width == 1 else ACC):
            m.set_nz(value, 16 * width)


def byte_place(m, loc):
    """Getter and setter of a byte; an index counts bytes."""
    if 0x90 <= loc < 0xA0 or loc >= 0xC0:
        m.arp = loc % 8
        index = (loc - 0xC0) // 8 if loc >= 0xC0 else m.half((loc - 0x90) // 8, False)
        at, by = 2 * m.xar[loc % 8] + index, 8 * (index % 2)
        read, write = (lambda: m.read(at // 2)), (lambda value: m.write(at // 2, value))
    else:
        (read, write), by = m.place(loc), 0
    return read, write, by


@operation("movb_axlsb_loc16", "movb_axmsb_loc16", "movb_loc16_axlsb", "movb_loc16_axmsb")
def move_byte(m, i):
    read, write, by = byte_place(m, i.loc)
    ax = m.half("acc", i.high)
    if i.form.operation.startswith("movb_ax"):
        value = read() >> by & 0xFF
        value = value if "lsb" in i.form.operation else value * 256 + ax % 256
        m.set_half("acc", i.high, value)
        m.set_nz(value, 16)
        return
    value = ax % 256 if "lsb" in i.form.operation else ax // 256
    merged = read() & ~(0xFF << by) | value << by
    write(merged)
    if i.loc in AX:
        m.set_nz(merged, 16)


@operation(*("mov_direct_loc16", "mov_loc16_direct", "pread", "pwrite", "xpread_pma", "xpread_al", "xpwrite_al"))
@operation("in", "out")
def far(m, i):
    name = i.form.operation
    at = {
        "mov_direct_loc16": (i.constant + m.repeated) % 2**16,
        "mov_loc16_direct": (i.constant + m.repeated) % 2**16,
        "pread": m.xar[7] + m.repeated,
        "pwrite": m.xar[7] + m.repeated,
        "xpread_pma": HIGH_PAGE + (i.constant + m.repeated) % 2**16,
        "xpread_al": HIGH_PAGE + (m.half("acc", False) + m.repeated) % 2**16,
        "xpwrite_al": HIGH_PAGE + (m.half("acc", False) + m.repeated) % 2**16,
    }
    if name == "in":
        store(m, i, 0xFFFF)
    elif name == "out":
        get(m, i)
    elif name in ("mov_direct_loc16", "pwrite", "xpwrite_al"):
        m.write(at[name], get(m, i))
    else:
        store(m, i, m.read(at[name]))


@operation("nop", "iack", "estop1")
def nothing(m, i):
    if i.form.operation == "nop":
        m.place(i.loc)
