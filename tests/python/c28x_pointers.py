"""What the second C28x does with bits, pointers and the stack, by the operations of the table."""

from c28x_moves import AX, store
from c28x_sums import get, operation


@operation("tbit", "tbit_t", "tset", "tclr")
def bit(m, i):
    name = i.form.operation
    number = 15 - m.t % 16 if name == "tbit_t" else i.bit
    read, write = m.place(i.loc)
    value = read()
    m.flags["tc"] = value // 2**number % 2
    if name in ("tset", "tclr"):
        value = value - m.flags["tc"] * 2**number + (name == "tset") * 2**number
        write(value)
        if i.loc in AX:
            m.set_nz(value, 16)


@operation("addb_sp", "subb_sp", "addb_xar", "subb_xar", "adrk", "sbrk", "cmpr", "asp", "nasp")
def pointer(m, i):
    name = i.form.operation
    sign = -1 if name.startswith("s") else 1
    if name == "cmpr":
        a, b = m.half(m.arp, False), m.half(0, False)
        m.flags["tc"] = int((a == b, a < b, a > b, a != b)[i.shift])
    elif name.endswith("sp") and "b_" in name:
        m.sp = (m.sp + sign * i.constant) % 2**16
    elif name == "asp":
        m.spa = m.sp % 2
        m.sp = (m.sp + m.spa) % 2**16
    elif name == "nasp":
        m.sp, m.spa = (m.sp - m.spa) % 2**16, 0
    else:
        m.step_xar(m.arp if name in ("adrk", "sbrk") else i.n, sign * i.constant)


@operation("and_ier", "or_ier", "and_ifr", "or_ifr")
def masks(m, i):
    work, name = i.form.operation.split("_")
    old = getattr(m, name)
    setattr(m, name, old & i.constant if work == "and" else old | i.constant)


def push(m, value, width=1):
    (m.write if width == 1 else m.write_long)(m.sp, value)
    m.sp = (m.sp + width) % 2**16


def pop(m, width=1):
    m.sp = (m.sp - width) % 2**16
    return (m.read if width == 1 else m.read_long)(m.sp)


def pair(m, name, n):
    if name == "p":
        return ("p", False), ("p", True)
    upper = name == "arh"
    return (n, upper), (n + 1, upper)


@operation(*(f"{way}_{name}" for way in ("push", "pop") for name in ("ar", "arh", "p")))
def long_stack(m, i):
    way, name = i.form.operation.split("_")
    low, high = pair(m, name, i.n)
    if way == "push":
        push(m, m.half(*low) + m.half(*high) * 2**16, 2)
    else:
        value = pop(m, 2)
        m.set_half(*low, value)
        m.set_half(*high, value >> 16)


@operation(*(f"{way}_{name}" for way in ("push", "pop") for name in ("loc16", "dp", "ifr", "dbgier")))
def word_stack(m, i):
    way, name = i.form.operation.split("_")
    if name == "loc16" and way == "push":
        value = get(m, i)  # the location is found with SP as it is before
        push(m, value)
    elif name == "loc16":
        store(m, i, pop(m))
    elif way == "push":
        push(m, getattr(m, name))
    else:
        setattr(m, name, pop(m))
