"""A drive that is asked what it does. Values are in the units that its table states; angles in turns."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cached_property
from typing import Self

from stillspin.drive import describe, protocol
from stillspin.drive.describe import unpack
from stillspin.drive.protocol import Command, Request, StatusCode, Words
from stillspin.drive.requester import Requester
from stillspin.drive.state import WIRING_FAULTS, Fault, RawFault, RawStatus, Status, rpm
from stillspin.drive.table import KNOWN_ROTOR, Table
from stillspin.errors import InputError
from stillspin.link.errors import RefusedError
from stillspin.link.transport import Transport

_LIMIT_BITS = 16
_SIGNALS_MOST = 16
_WIRING = "wiring"
_OR_NOTHING = frozenset({Words.REMEDY, Words.WIRING})
"""Kinds of words that only add to others: a drive without them says the others alone."""


class Inspection:
    """One drive, to be asked. Every method may be called from any thread; as a context it gives the port back."""

    def __init__(
        self,
        transport: Transport,
        *,
        timeout: float = 0.6,
        progress: Callable[[float], None] | None = None,
    ) -> None:
        """Take over an open transport and read the drive's table.

        Args:
            transport: is closed with the drive.
            timeout: s to wait for each answer.
            progress: gets the share of the table that has been read.
        """
        self.link = Requester(transport, timeout)
        self.holder = 0
        """The number under which this client holds a motor; 0 before it has one."""
        self._words: dict[tuple[int, int], str] = {}
        try:
            self._describe(progress)
        except BaseException:
            self.link.close()
            raise

    def _describe(self, progress: Callable[[float], None] | None = None) -> None:
        """Read who the drive is, and its table."""
        self.identity = describe.identity(self._ask)
        self.table: Table = describe.table(self._ask, self.identity, progress)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the port back. The drive goes on with what it does; every call from now on says that this is closed."""
        self.link.close()

    @property
    def version(self) -> str:
        """Of the firmware."""
        return self.identity.version

    @cached_property
    def left_out(self) -> list[str]:
        """Parts of the firmware that its edition has not, for people."""
        return describe.left_out(self._ask)

    def has_words(self, kind: Words) -> bool:
        """Whether its edition has the part of the firmware that says these words, as far as it tells."""
        return describe.has(self._ask, kind)

    def has_faults(self) -> list[int]:
        """Numbers of the faults that its edition has."""
        return describe.faults(self._ask, self.identity)

    def raw_status(self, once: float | None = None, *, urgent: bool = False) -> RawStatus:
        """The numbers behind `status`.

        Args:
            once: s to wait for the answer; the question is then not repeated.
            urgent: before all that waits.
        """
        body = struct.pack("<I", self.holder) if self.holder else b""
        answer = self.link.request(Request.STATUS, body, repeat=once is None, timeout=once, urgent=urgent)
        return RawStatus.unpack(answer)

    def status(self) -> Status:
        """What the drive does now."""
        return self.describe_status(self.raw_status())

    def describe_status(self, raw: RawStatus) -> Status:
        """A status in users' units and words."""
        bits = [bit for bit in range(_LIMIT_BITS) if raw.limits >> bit & 1]
        return Status(
            time=raw.time_ms / 1e3,
            state=self.words(Words.STATE, raw.state),
            fault=self._fault(raw.fault) if raw.fault else "",
            remedy=self.words(Words.REMEDY, raw.fault) if raw.fault else "",
            limits=tuple(self.words(Words.LIMIT, bit) for bit in bits),
            speed=rpm(raw.speed_q16, bool(raw.known & KNOWN_ROTOR)),
            speed_known=bool(raw.known & KNOWN_ROTOR),
            reference=rpm(raw.reference_q16),
            store=self.words(Words.STORE, raw.store),
            unsaved=raw.unsaved_known,
            raw=raw,
        )

    def _fault(self, code: int) -> str:
        """The cause, and of a mistake of the wiring which one the last start has seen."""
        parts = [self.words(Words.FAULT, code)]
        if code in WIRING_FAULTS and any(signal.name == _WIRING for signal in self.table.signals):
            seen = int(self.signals(_WIRING)[_WIRING])
            parts.append(self.words(Words.WIRING, seen) if seen else "")
        return ": ".join(filter(None, parts))

    def faults(self) -> list[Fault]:
        """The drive's fault memory, newest first."""
        found: list[Fault] = []
        for age in range(0x100):
            try:
                raw = RawFault.unpack(self._ask(Request.FAULT, struct.pack("<B", age)))
            except RefusedError:  # nothing that old
                break
            if age >= raw.total:
                break
            words = (
                self.words(Words.FAULT, raw.code),
                self.words(Words.STATE, raw.state),
                self.words(Words.REMEDY, raw.code),
            )
            found.append(Fault.from_raw(raw, words, self.table))
        return found

    def signals(self, *names: str) -> dict[str, float]:
        """Signals of one and the same control interrupt, at most 16; by name. NaN for what is unknown."""
        chosen = self.table.chosen(names)
        if not 1 <= len(chosen) <= _SIGNALS_MOST:
            raise InputError(f"{len(chosen)} signals at once; 1 … {_SIGNALS_MOST} are possible")
        numbers = struct.pack(f"<{len(chosen)}H", *(signal.index for signal in chosen))
        *raw, known = unpack(f"<{len(chosen)}iB", self._ask(Request.SIGNALS, numbers))
        return {signal.name: signal.to_user(value, known) for signal, value in zip(chosen, raw, strict=True)}

    def words(self, kind: Words, code: int) -> str:
        """The drive's words for a code."""
        if (kind, code) not in self._words:
            try:
                body = self._ask(Request.WORDS, struct.pack("<BB", kind, code))
                self._words[kind, code] = body.decode("ascii", "replace").rstrip("\0")
            except RefusedError as error:
                unknown = str(error) if error.status == StatusCode.EDITION else f"{kind.name.lower()} {code}"
                self._words[kind, code] = "" if kind in _OR_NOTHING else unknown
        return self._words[kind, code]

    def command(self, code: Command, argument: int = 0) -> None:
        """Any command; see the protocol."""
        repeat = code in protocol.REPEATABLE_COMMANDS
        urgent = code in {Command.STOP, Command.COAST}
        self.link.request(Request.COMMAND, struct.pack("<Bi", code, argument), repeat=repeat, urgent=urgent)

    def _ask(self, kind: Request, body: bytes) -> bytes:
        return self.link.request(kind, body, repeat=kind in protocol.REPEATABLE)
