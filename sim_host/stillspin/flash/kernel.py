"""The flash kernel's requests: firmware/flash_kernel/kernel.h has them in C."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum

from stillspin.counted import counted
from stillspin.flash import layout
from stillspin.flash.files import Identity, identity_of
from stillspin.flash.line import Line
from stillspin.link.errors import DifferentError, NoAnswerError, RefusedError
from stillspin.link.records import ANSWER, Record, to_wire
from stillspin.link.splitter import Splitter

RATE = 115200
PROTOCOL = 1
WORDS_MAX = 112
"""In one request to write."""
_ATTEMPTS = 3
_WAIT = 2.0
_ERASE_WAIT = 60.0
"""Ten seconds a sector are typical, worn ones take longer."""
_CHECK_WAIT = 5.0
_POLL = 0.1
_INFO = struct.Struct(f"<HHHB{layout.IDENTITY_WORDS}H2H")


class Request(IntEnum):
    """Types of requests."""

    INFO = 0x30
    ERASE = 0x31
    WRITE = 0x32
    CHECK = 0x33
    SEAL = 0x34
    RESTART = 0x35


class Status(IntEnum):
    """First octet of every answer."""

    OK = 0
    UNKNOWN = 1
    RANGE = 2
    LENGTH = 4
    STATE = 6
    FLASH = 8
    LOCKED = 9


@dataclass(frozen=True)
class Info:
    """Chip and flash as the kernel finds them."""

    protocol: int
    part: int
    revision: int
    locked: bool
    mark: int
    identity: Identity | None
    has_boot_entry: bool


class Kernel:
    """A kernel that runs behind a line."""

    def __init__(self, line: Line) -> None:
        self._line = line
        self._splitter = Splitter()
        self._tag = 0
        self._clock = 0.0  # seconds of silence: all that the splitter measures

    def info(self, attempts: int = _ATTEMPTS) -> Info:
        """Who is there.

        Raises:
            DriveError: nobody, or something else.
        """
        body = self._ask(Request.INFO, b"", attempts=attempts)
        if len(body) != _INFO.size:
            raise DifferentError(
                f"{self._line.name}: the kernel is not this program's (its answer has {counted(len(body), 'octet')}): "
                "build both from one commit"
            )
        protocol, part, revision, locked, *words = _INFO.unpack(body)
        identity, entry = tuple(words[: layout.IDENTITY_WORDS]), words[layout.IDENTITY_WORDS :]
        return Info(
            protocol,
            part,
            revision,
            bool(locked),
            identity[0],
            identity_of(identity),
            any(word != layout.ERASED for word in entry),
        )

    def erase(self, sector: layout.Sector) -> None:
        """Set a sector's words to ones; the image loses its mark first.

        Raises:
            DriveError: it did not.
        """
        self._ask(Request.ERASE, bytes((sector.number,)), wait=_ERASE_WAIT)

    def write(self, address: int, words: tuple[int, ...]) -> None:
        """Program up to WORDS_MAX words and read them back.

        Raises:
            DriveError: it did not.
        """
        self._ask(Request.WRITE, struct.pack(f"<I{len(words)}H", address, *words))

    def crc(self, address: int, count: int) -> int:
        """CRC-32 over words of the flash or of the kernel's own RAM.

        Raises:
            DriveError: no answer.
        """
        (value,) = struct.unpack("<I", self._ask(Request.CHECK, struct.pack("<II", address, count), wait=_CHECK_WAIT))
        return int(value)

    def seal(self, crc: int) -> None:
        """Put the mark there, when the CRC-32 over all that an update writes is this one.

        Raises:
            DriveError: it is not.
        """
        self._ask(Request.SEAL, struct.pack("<I", crc), wait=_CHECK_WAIT)

    def restart(self) -> None:
        """Reset the chip.

        Raises:
            DriveError: no answer.
        """
        self._ask(Request.RESTART, b"", attempts=1)

    def _ask(self, kind: Request, body: bytes, *, wait: float = _WAIT, attempts: int = _ATTEMPTS) -> bytes:
        """The body of the answer; asked again when none comes, which every request stands."""
        for _ in range(attempts):
            self._tag = (self._tag + 1) & 0xFF
            self._line.write(to_wire(Record(kind, self._tag, body)))
            answer = self._answer(kind, wait)
            if answer is not None:
                return self._judged(kind, answer)
        raise NoAnswerError(
            f"{self._line.name}: the kernel does not answer ({kind.name.lower()}); check the cable, reset the board "
            "with its jumpers in serial boot and repeat: the update goes on where it can"
        )

    def _answer(self, kind: Request, wait: float) -> bytes | None:
        silent = 0.0
        while silent < wait:
            octets = self._line.read(512, _POLL)
            if not octets:
                silent += _POLL
                self._clock += _POLL
            for item in self._splitter.feed(octets, self._clock):
                if isinstance(item, Record) and item.kind == kind | ANSWER and item.tag == self._tag and item.body:
                    return item.body
        return None

    def _judged(self, kind: Request, answer: bytes) -> bytes:
        status, body = answer[0], answer[1:]
        if status == Status.OK:
            return body
        raise RefusedError(f"{self._line.name}: {kind.name.lower()}: {_words(status, body)}", status)


def _words(status: int, body: bytes) -> str:
    if status == Status.FLASH and len(body) == 6:
        code, address = struct.unpack("<HI", body)
        return (
            f"the flash failed at 0x{address:06X} (code {code} of TI's library): repeat; if it fails again, the sector "
            "is worn or damaged: look at it over JTAG"
        )
    if status == Status.UNKNOWN:
        return "the drive is running, not the kernel: set the jumpers to serial boot and reset the board"
    return {
        Status.RANGE: "refused: only sectors B, C and D are ever written",
        Status.LENGTH: "the request had a wrong length: build kernel and program from one commit",
        Status.STATE: "refused: the flash does not hold what was sent; repeat the update",
        Status.LOCKED: "the board is locked by passwords: open it over JTAG",
    }.get(Status(status) if status in set(Status) else Status.OK, f"refused with status {status}")
