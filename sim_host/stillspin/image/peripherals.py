"""What the virtual chip has not of an F2808's peripherals, and its registers by name (SPRS230, register maps)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

_SCI = {
    **{0x0: "SCICCR", 0x1: "SCICTL1", 0x2: "SCIHBAUD", 0x3: "SCILBAUD", 0x4: "SCICTL2", 0x5: "SCIRXST"},
    **{0x6: "SCIRXEMU", 0x7: "SCIRXBUF", 0x9: "SCITXBUF", 0xA: "SCIFFTX", 0xB: "SCIFFRX", 0xC: "SCIFFCT"},
    **{0xF: "SCIPRI"},
}
_SPI = {
    **{0x0: "SPICCR", 0x1: "SPICTL", 0x2: "SPISTS", 0x4: "SPIBRR", 0x6: "SPIRXEMU", 0x7: "SPIRXBUF"},
    **{0x8: "SPITXBUF", 0x9: "SPIDAT", 0xA: "SPIFFTX", 0xB: "SPIFFRX", 0xC: "SPIFFCT", 0xF: "SPIPRI"},
}
_XINT = {0x0: "XINT1CR", 0x1: "XINT2CR", 0x7: "XNMICR", 0x8: "XINT1CTR", 0x9: "XINT2CTR", 0xF: "XNMICTR"}
_ECAP = {
    **{0x00: "TSCTR", 0x02: "CTRPHS", 0x04: "CAP1", 0x06: "CAP2", 0x08: "CAP3", 0x0A: "CAP4"},
    **{0x14: "ECCTL1", 0x15: "ECCTL2", 0x16: "ECEINT", 0x17: "ECFLG", 0x18: "ECCLR", 0x19: "ECFRC"},
}
_EQEP = {
    **{0x00: "QPOSCNT", 0x02: "QPOSINIT", 0x04: "QPOSMAX", 0x06: "QPOSCMP", 0x08: "QPOSILAT", 0x0A: "QPOSSLAT"},
    **{0x0C: "QPOSLAT", 0x0E: "QUTMR", 0x10: "QUPRD", 0x12: "QWDTMR", 0x13: "QWDPRD", 0x14: "QDECCTL"},
    **{0x15: "QEPCTL", 0x16: "QCAPCTL", 0x17: "QPOSCTL", 0x18: "QEINT", 0x19: "QFLG", 0x1A: "QCLR", 0x1B: "QFRC"},
    **{0x1C: "QEPSTS", 0x1D: "QCTMR", 0x1E: "QCPRD", 0x1F: "QCTMRLAT", 0x20: "QCPRDLAT"},
}
_ECAN = {
    **{0x00: "CANME", 0x02: "CANMD", 0x04: "CANTRS", 0x06: "CANTRR", 0x08: "CANTA", 0x0A: "CANAA", 0x0C: "CANRMP"},
    **{0x0E: "CANRML", 0x10: "CANRFP", 0x12: "CANGAM", 0x14: "CANMC", 0x16: "CANBTC", 0x18: "CANES", 0x1A: "CANTEC"},
    **{0x1C: "CANREC", 0x1E: "CANGIF0", 0x20: "CANGIM", 0x22: "CANGIF1", 0x24: "CANMIM", 0x26: "CANMIL"},
    **{0x28: "CANOPC", 0x2A: "CANTIOC", 0x2C: "CANRIOC", 0x2E: "CANTSC", 0x30: "CANTOC", 0x32: "CANTOS"},
}


@dataclass(frozen=True)
class Peripheral:
    """Its words, and what its registers are called by their offset; the second word of one has no name of its own."""

    name: str
    words: range
    registers: Mapping[int, str]

    def register(self, address: int) -> str:
        """The register that an address lies in, or the address where none is named."""
        offset = address - self.words.start
        return self.registers.get(offset) or self.registers.get(offset & ~1) or f"0x{address:06X}"


def _at(name: str, first: int, words: int, registers: Mapping[int, str]) -> Peripheral:
    return Peripheral(name, range(first, first + words), registers)


MISSING = (
    _at("eCAN-B", 0x6200, 0x200, _ECAN),
    *(_at(f"eCAP{number + 1}", 0x6A00 + 0x20 * number, 0x20, _ECAP) for number in range(4)),
    _at("eQEP2", 0x6B40, 0x40, _EQEP),
    _at("SPI-A", 0x7040, 0x10, _SPI),
    _at("XINT (external interrupts)", 0x7070, 0x10, _XINT),
    _at("SPI-B", 0x7740, 0x10, _SPI),
    _at("SCI-B", 0x7750, 0x10, _SCI),
    _at("SPI-C", 0x7760, 0x20, _SPI),
    _at("SPI-D", 0x7780, 0x20, _SPI),
)


PARTS = (
    _at("the protected range of addresses", 0x0884, 2, {0x0: "PROTSTART", 0x1: "PROTRANGE"}),
    _at("the watchdog of eQEP1", 0x6B12, 2, {0x0: "QWDTMR", 0x1: "QWDPRD"}),
    _at("the edge capture of eQEP1", 0x6B1D, 4, {0x0: "QCTMR", 0x1: "QCPRD", 0x2: "QCTMRLAT", 0x3: "QCPRDLAT"}),
)
"""Of peripherals that are modelled."""


def missing(address: int) -> Peripheral | None:
    """The one that an address lies in."""
    return next((there for there in (*MISSING, *PARTS) if address in there.words), None)
