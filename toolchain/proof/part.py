"""A part of the proofs: what Frama-C reads together, and with which of its two provers."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

QMATH = "hal/qmath/*.c"
RANGES, LINK_RANGES = "tests/prove/qmath_ranges.h", "tests/prove/link_ranges.h"
SLICES = (
    *("-eva-slevel", "100", "-eva-auto-loop-unroll", "600"),
    *("-eva-split-return-function", "q_clz32:full"),
)


@dataclass(frozen=True)
class Part:
    """What is read together."""

    name: str
    sources: tuple[str, ...]  # the driver, patterns of the drive's files
    flags: tuple[str, ...]
    headers: tuple[str, ...] = (RANGES,)  # with what functions promise: shown where their code is read
    given: str = ""  # functions of which the contract is taken, not the code
    proved: tuple[str, ...] = ()  # functions whose contract WP proves, where EVA reads nothing
    related: tuple[str, ...] = ()  # functions whose calls another part proves: their numbers belong together


def with_contract(*headers: str) -> str:
    """The functions that headers of tests/prove/ have contracts of."""
    root = Path(__file__).resolve().parents[2]
    texts = [(root / header).read_text(encoding="utf-8") for header in headers]
    return ",".join(name for text in texts for name in re.findall(r"\*/\n[\w ]+?[ *](\w+)\(", text))


def eva(
    name: str,
    sources: tuple[str, ...],
    flags: tuple[str, ...] = (),
    given: str = "",
    *,
    headers: tuple[str, ...] = (RANGES,),
    precision: str = "0",
) -> Part:
    """What EVA reads from the driver's function `prove_NAME` on."""
    begin = ("-main", f"prove_{name}", "-eva", "-eva-no-print", "-eva-precision", precision)
    return Part(name, sources, (*begin, *flags), headers, given)


def wp(
    name: str, sources: tuple[str, ...], flags: tuple[str, ...], proved: tuple[str, ...], headers: tuple[str, ...]
) -> Part:
    """Functions whose contracts WP proves, and that nothing in them goes wrong."""
    return Part(name, sources, ("-wp", "-wp-rte", "-wp-prover", "z3", *flags), headers, proved=proved)


def of_qmath(name: str, flags: tuple[str, ...] = SLICES, given: str = "") -> Part:
    """The arithmetic itself."""
    return eva(name, ("tests/prove/qmath.c", QMATH), flags, given, precision="1")


def of_link(
    name: str, sources: tuple[str, ...], flags: tuple[str, ...], *given: str, related: tuple[str, ...] = ()
) -> Part:
    """What has to do with texts and records."""
    part = eva(name, sources, flags, ",".join(given), headers=(LINK_RANGES,))
    return replace(part, related=related)
