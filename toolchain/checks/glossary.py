"""Every abbreviation in README.md and the book is in the book's glossary, by which each page explains it."""

import re
from pathlib import Path

from book.hooks import abbreviations

from checks import Finding
from checks.links import pages, prose

_CODE = re.compile(r"`[^`\n]+`|\]\([^)]*\)|<!--.*?-->")
_CAPITALS = re.compile(r"(?<![\w/.-])[A-Z][A-Za-z]*[A-Z]+(?:[-/][A-Z0-9]+)*\b")
# Names of states, messages, requests, files, pins, registers, products, keys, quantities; what every reader knows.
_NAMES = """
BOOT CALIBRATE READY START RUN COMMISSION STOP FAULT IDLE SWRESET README LICENSE COMMAND STATUS LOOK DIAGNOSTIC IDENTITY
WORDS STREAM SIGNALS LINK INFO ERASE WRITE CHECK SEAL RESTART CANH CANL CANRXA CANTXA VCC VCCIO CMPA CMPB AQCSFRC
CCR CCE LSPCLK PARTID LAA LBB LAWICEL PCAN XDS MOTO LTS BSD CR LF SIGTERM RS SCI-A SCI-B FFFF PC ID KiB SocketCAN OK
ANT ECI EMJ-04APB22 EMRAX GMCC GMP LACFAN MATLAB MIT MPLAB ORNL SDK TM-2006 ZKSN
"""
_IS_NAME = frozenset(_NAMES.split())


def unexplained(line: str) -> list[str]:
    """Abbreviations of a line of prose that neither the glossary has nor is a name."""
    known = abbreviations()
    found = _CAPITALS.findall(_CODE.sub(" ", line))
    return [word for word in found if not {word, *re.split("[-/]", word)} & (known.keys() | _IS_NAME)]


def check(root: Path) -> list[Finding]:
    """A finding for every abbreviation that is explained nowhere."""
    return [
        Finding(page.relative_to(root).as_posix(), number, f"{word} is not in docs/glossary.md")
        for page in pages(root)
        for number, line in prose(page.read_text(encoding="utf-8"))
        for word in unexplained(line)
    ]
