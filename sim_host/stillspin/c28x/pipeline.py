"""In which phase of the pipeline a form needs and changes the registers of addresses.

Addresses are made early, in the second half of decoding (D2); results arrive late, at the end of execution (E), three
phases after it. What an instruction needs early and an earlier one changes late makes it wait. Constants, and the steps
of pointers, are changes that are made early; they wait for a late one of the same register as a use does.

Registers are bits of a mask: 0 to 7 for XAR0 to XAR7, then SP and DP.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from stillspin.c28x.table import Form

SP = 1 << 8
DP = 1 << 9

_STACK = re.compile(
    r"(lc|lcr|lc_xar7|lcr_xar|lret\w*|iret|trap|intr\w*|push_\w+|pop_\w+|addb_sp|subb_sp|n?asp|xcall\w*|xretc)"
)
_EARLY_OF_FIELD = re.compile(
    r"(banz|bar_n?eq|lcr_xar|\w+_loc32_xar|mov_loc16_ar|movb_x?ar|movl_xar_const|addb_xar|subb_xar)"
)
_LATE_OF_FIELD = re.compile(r"(movl_xar_loc32|movz_ar_loc16|mov_ar_loc16|mov_xar_pc|norm_xar)")
_LATE = {"pop_dp": DP, "pop_dp_st1": DP, "pop_arh": 0b11}
_READS_ITS_LOCATION = re.compile(r"(cmp|nop|rpt|loop|push|sqr|tbit)")
_ONLY_WRITES_IT = re.compile(r"(mov|pop|x?pread|in$)")


@dataclass(frozen=True)
class Phases:
    """The masks of what is fixed, and what of the fields counts."""

    early: int
    late: int
    early_reg: bool
    late_reg: bool
    location_early: bool
    """A register in the place of the location is needed early."""
    location_late: bool
    """It is changed late."""


def phases(form: Form) -> Phases:
    """When a form needs and changes the registers of addresses."""
    operation = form.operation
    early, late = 0, _LATE.get(operation, 0)
    if _STACK.fullmatch(operation):
        early |= SP
    for register in re.findall(r"\*XAR(\d)", form.syntax):
        early |= 1 << int(register)
    if operation in ("push_ar", "pop_ar"):
        pair = 0b11 << form.fixed.get("reg", 0)
        early, late = (early | pair, late) if operation == "push_ar" else (early, late | pair)
    if operation == "push_arh":
        early |= 0b11
    first = re.match(r"\S+ (loc|mem)", form.syntax)
    writes = bool(first) and not _READS_ITS_LOCATION.match(operation)
    return Phases(
        early=early,
        late=late,
        early_reg=bool(_EARLY_OF_FIELD.fullmatch(operation)),
        late_reg=bool(_LATE_OF_FIELD.fullmatch(operation)),
        location_early=not (writes and _ONLY_WRITES_IT.match(operation)),
        location_late=writes,
    )
