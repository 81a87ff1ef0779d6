"""A debugger's way to a board that executes an image: GDB's remote serial protocol on a port of this computer.

The board's time stands while the program is stopped. Whoever runs the board calls `poll` between two slices of its time
and lets it pass where `runs` says so.
"""

from __future__ import annotations

import contextlib
import re
import select
import socket
from collections.abc import Callable
from typing import NamedTuple

from stillspin.core_board import NativeBoard
from stillspin.errors import InputError
from stillspin.flash.names import Names
from stillspin.image import gdb_target as target
from stillspin.image import opened, runaway, trace
from stillspin.image.gdb_packets import INTERRUPT, LARGEST, Line, framed

_HOST = "127.0.0.1"
_TRAPPED = "S05"
_ASKED = "S02"
_ILLEGAL = "S04"
"""The signals SIGTRAP, SIGINT, SIGILL: a breakpoint, a step or the beginning; Ctrl-C; what is no instruction."""
_WRONG = "E01"
_BREAKPOINTS = frozenset("01")
"""Types of `Z`: in memory, in hardware."""
_READS, _WRITES = 1, 2
_WATCHPOINTS = {"2": (_WRITES, "watch"), "3": (_READS, "rwatch"), "4": (_READS | _WRITES, "awatch")}
"""Those for data: what an instruction does there, and how a stop is told."""
_TRAP_WORD = 0x7625
"""ESTOP0."""
_SUPPORTED = f"PacketSize={LARGEST:x};qXfer:features:read+;QStartNoAckMode+;vContSupported+;swbreak-;hwbreak-"
_PAUSE = 20e-6
"""Seconds in which every instruction ends."""


class _Request(NamedTuple):
    """A packet by its beginning, and what answers its rest."""

    begin: str
    answer: Callable[[str], str | None]


class Remote:
    """One debugger at a time. At first the program is stopped, until a debugger has come and lets it go on."""

    def __init__(self, board: NativeBoard, names: Names, port: int) -> None:
        """Listen.

        Args:
            board: executes an image and has just been switched on.
            names: of the image.
            port: of this computer; 0 lets the system choose.

        Raises:
            InputError: the port is not free.
        """
        try:
            self._listening = socket.create_server((_HOST, port))
        except OSError as error:
            raise InputError(f"--gdb {port}: the port cannot be opened ({error.strerror}); choose another") from error
        self._board, self._names = board, names
        self._peer: socket.socket | None = None
        self._line = Line()
        self._places: set[int] = set()
        self._words: set[tuple[str, int]] = set()
        self._stopped = _TRAPPED
        self._stepping = False
        self.runs = True
        self._requests = self._known()
        board.stop_after(0)  # the boot ROM runs up to the program's first instruction

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self._listening.getsockname()[1])

    def close(self) -> None:
        """Hang up."""
        self._hang_up()
        self._listening.close()

    def poll(self, seconds: float) -> None:
        """Say that the program has stopped, take a debugger's requests, or wait for one for a while."""
        if self.runs and self._board.halted:
            self.runs = False
            self._stopped = self._reason()
            self._say(self._stopped)
        wanted = self._peer or self._listening
        if not select.select([wanted], [], [], 0 if self.runs else seconds)[0]:
            return
        if self._peer is None:
            self._peer, _ = self._listening.accept()
            self._peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._line = Line()
            self._pause()
            return
        try:
            octets = self._peer.recv(LARGEST)
        except OSError:
            octets = b""
        if not octets:
            self._leave()
            return
        packets, answers = self._line.take(octets)
        self._send(answers)
        for packet in packets:
            self._serve(packet)

    # ---- the line

    def _send(self, octets: bytes) -> None:
        if self._peer and octets:
            with contextlib.suppress(OSError):  # gone: the next look says so
                self._peer.sendall(octets)

    def _say(self, text: str) -> None:
        self._send(framed(text))

    def _hang_up(self) -> None:
        if self._peer:
            self._peer.close()
        self._peer = None

    def _leave(self) -> None:
        """The debugger has gone, and so have its breakpoints."""
        self._hang_up()
        self._places.clear()
        self._words.clear()
        self._go_on()

    # ---- requests

    def _known(self) -> list[_Request]:
        return [
            _Request("qSupported", lambda _: _SUPPORTED),
            _Request("QStartNoAckMode", self._without_acknowledgements),
            _Request("qXfer:features:read:target.xml:", self._description),
            _Request("qAttached", lambda _: "1"),
            _Request("qfThreadInfo", lambda _: "m1"),
            _Request("qsThreadInfo", lambda _: "l"),
            _Request("qC", lambda _: "QC1"),
            _Request("qRcmd,", self._monitor),
            _Request("vCont?", lambda _: "vCont;c;C;s;S"),
            _Request("vCont;", self._resume),
            _Request("?", lambda _: self._stopped),
            _Request("g", lambda _: target.registers(self._board)),
            _Request("G", self._set_registers),
            _Request("p", self._register),
            _Request("P", self._set_register),
            _Request("m", self._memory),
            _Request("M", self._set_memory),
            _Request("c", lambda at: self._resume("c", at)),
            _Request("s", lambda at: self._resume("s", at)),
            _Request("Z", lambda rest: self._place(rest, on=True)),
            _Request("z", lambda rest: self._place(rest, on=False)),
            _Request("H", lambda _: "OK"),
            _Request("T", lambda _: "OK"),
            _Request("D", self._detach),
            _Request("k", self._gone),
        ]

    def _serve(self, packet: str) -> None:
        if packet == INTERRUPT:
            if self.runs:
                self._pause()
                self._stopped = _ASKED
                self._say(self._stopped)
            return
        if self.runs:
            return  # while it runs nothing else is asked
        request = next((one for one in self._requests if packet.startswith(one.begin)), None)
        if request is None:
            self._say("")
            return
        try:
            answer = request.answer(packet[len(request.begin) :])
        except ValueError:
            answer = _WRONG
        if answer is not None:
            self._say(answer)

    def _without_acknowledgements(self, _: str) -> str:
        self._line.acknowledged = False
        return "OK"

    def _description(self, rest: str) -> str:
        offset, length = (int(part, 16) for part in rest.split(","))
        text = target.description()
        piece = text[offset : offset + length]
        return ("m" if offset + length < len(text) else "l") + piece

    def _set_registers(self, text: str) -> str:
        target.set_registers(self._board, text)
        return "OK"

    def _name(self, number: str) -> str:
        index = int(number, 16)
        if index >= len(target.NAMES):
            raise ValueError(f"no register {index}")
        return target.NAMES[index]

    def _register(self, number: str) -> str:
        name = self._name(number)
        return target.digits(self._board.registers()[name], target.REGISTERS[name])

    def _set_register(self, rest: str) -> str:
        number, _, text = rest.partition("=")
        target.set_register(self._board, self._name(number), text)
        return "OK"

    def _memory(self, rest: str) -> str:
        address, count = (int(part, 16) for part in rest.split(","))
        return target.memory(self._board, address, min(count, LARGEST // target.UNIT))

    def _set_memory(self, rest: str) -> str:
        where, _, text = rest.partition(":")
        address, count = (int(part, 16) for part in where.split(","))
        if len(text) != count * target.UNIT:
            raise ValueError("not as many words")
        target.set_memory(self._board, address, text)
        return "OK"

    def _place(self, rest: str, *, on: bool) -> str:
        """A breakpoint, both kinds are the core's own, so that no code is changed; or words to watch."""
        kind, address, *more = rest.split(",")
        first = int(address, 16)
        if kind in _BREAKPOINTS:
            (self._places.add if on else self._places.discard)(first)
            return "OK"
        if kind not in _WATCHPOINTS:
            return ""
        words = {(kind, first + offset) for offset in range(min(int(more[0], 16), LARGEST))}
        if on and not all(target.is_there(address) for _, address in words):
            return _WRONG
        self._words = self._words | words if on else self._words - words
        return "OK"

    def _monitor(self, text: str) -> str:
        """`monitor where`, `monitor cycles`, `monitor trace N`."""
        words = bytes.fromhex(text).decode("latin-1").split()
        said = ""
        if words == ["where"]:
            said = self._names.place(self._board.registers()["PC"])
        elif words == ["cycles"]:
            said = ", ".join(f"{name} {value}" for name, value in self._board.code().items())
        elif len(words) == 2 and words[0] == "trace" and re.fullmatch(r"\d{1,5}", words[1]):
            said = "\n".join(trace.lines(self._board, self._names))
            self._board.trace(int(words[1]))
        else:
            said = "where, cycles, or trace N: what was traced, and from now on the last N instructions"
        return f"{said}\n".encode("latin-1", "replace").hex()

    # ---- running and stopping

    def _reason(self) -> str:
        """Why it has stopped, as the protocol says it."""
        if accessed := self._board.accessed:
            return f"T05{self._watched(*accessed)}:{accessed[0]:x};"
        return _ILLEGAL if self._at_illegal() else _TRAPPED

    def _watched(self, address: int, done: int) -> str:
        """How an access is told: a debugger asks for a word in more than one way at times."""
        ways = [way for kind, way in _WATCHPOINTS.items() if (kind, address) in self._words and way[0] & done]
        return ways[0][1] if ways else _WATCHPOINTS["4"][1]

    def _at_illegal(self) -> bool:
        return runaway.is_illegal(self._board.words(self._board.registers()["PC"], 2))

    def _resume(self, action: str, at: str = "") -> None:
        if at:
            self._board.set_register("PC", int(at, 16))
        self._stepping = action[:1] in {"s", "S"}
        self._go_on()

    def _go_on(self) -> None:
        there = self._board.registers()["PC"]
        if self._board.halted and self._board.inspect(there) == _TRAP_WORD and there not in self._places:
            self._board.set_register("PC", there + 1)  # ESTOP0 has stopped it and would again
        if self._board.halted and self._at_illegal():
            self._trap()
            if self._stepping:
                self._stopped, self._stepping = self._reason(), False
                self._say(self._stopped)
                return
        self._board.stop_at(sorted(self._places), traps=self._peer is not None, words=self._accesses())
        if self._stepping:
            self._board.stop_after(1)
        self._stepping = False
        self.runs = True

    def _accesses(self) -> list[tuple[int, int]]:
        """Of each word all that it is watched for."""
        found: dict[int, int] = {}
        for kind, address in self._words:
            found[address] = found.get(address, 0) | _WATCHPOINTS[kind][0]
        return sorted(found.items())

    def _trap(self) -> None:
        """Through what is no instruction, to the first one of the trap's routine."""
        self._board.stop_at([])
        self._board.stop_after(1)
        opened.advance(self._board, _PAUSE)

    def _pause(self) -> None:
        """Before the next instruction; where the CPU sleeps, as it is."""
        if not self._board.halted:
            self._board.stop_after(0)
            opened.advance(self._board, _PAUSE)
        self.runs = False

    def _detach(self, _: str) -> str | None:
        self._say("OK")
        return self._gone("")

    def _gone(self, _: str) -> str | None:
        self._leave()
        return None
