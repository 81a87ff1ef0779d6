"""Records and console text to a virtual board in this process: no port, no second program."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator

from stillspin import core, resources
from stillspin.board.desk import SLICE, TICKS_PER_SECOND
from stillspin.board.pacer import Pacer
from stillspin.board.power import power
from stillspin.cases import profile
from stillspin.errors import InputError
from stillspin.link.errors import LinkError
from stillspin.link.records import Record, to_wire
from stillspin.link.splitter import Item, Splitter

_PAUSE = 0.002
_LATE = 0.2
"""Seconds of the board's time behind a beat, from which on it goes no faster than the clock."""


class VirtualTransport:
    """A virtual board whose time passes while somebody receives, which a client's thread does all the time.

    There can be one in a process: the firmware has static state, as on its chip.
    """

    has_console = True

    def __init__(
        self,
        profile_name: str = "bench",
        changes: list[str] | None = None,
        *,
        speed: float = 1.0,
        seed: int = 1,
        motor: str = resources.DEFAULT_MOTOR,
    ) -> None:
        """Power a board.

        Args:
            profile_name: the plant, a name from `stillspin list` or a TOML file.
            changes: entries of the plant or firmware parameters, as `run --set` takes them.
            speed: times real time; 0 is as fast as possible.
            seed: of the noise.
            motor: the machine and its board, a name from `stillspin list` or a TOML file.

        Raises:
            InputError: no such plant, or another virtual board in this process.
        """
        native = core.load()
        schema, known = core.plant_schema(native), core.parameters(native)
        chosen = profile.load(profile_name, schema, known, motor)
        self.name = f"virtual board, motor {chosen.motor}, profile {chosen.name}"
        try:
            self._board = power(native, chosen, profile.changes(changes or [], schema, known, chosen.parameters), seed)
        except RuntimeError as error:
            raise InputError(str(error)) from error
        self._pacer = Pacer(speed)
        self._splitter = Splitter()
        self._lock = threading.Lock()
        self._awaited = math.inf
        self._closed = False

    @property
    def port(self) -> tuple[int, int] | None:
        """See Transport."""
        return None

    def set_load(self, torque: float) -> None:
        """Load torque on the shaft from now on, N m; positive opposes positive rotation."""
        with self._lock:
            self._check()
            self._board.set_load(torque)

    def set_input(self, name: str, value: float) -> None:
        """Set an input of the board: "emergency" pressed is 1; the others are those of `NativeBoard.set_input`."""
        with self._lock:
            self._check()
            self._board.set_input(name, value)

    def truth(self) -> dict[str, float]:
        """The true machine: angle and speed of the shaft, currents, torques, DC link."""
        with self._lock:
            self._check()
            return dict(self._board.truth())

    def send(self, record: Record) -> None:
        """See Transport."""
        self.send_text(to_wire(record))

    def send_text(self, octets: bytes) -> None:
        """See Transport."""
        with self._lock:
            self._check()
            self._board.serial_write(octets)

    def receive(self, timeout: float) -> list[Item]:
        """See Transport. Lets the board's time pass."""
        end = time.monotonic() + timeout
        while True:
            octets = self._step()
            now = time.monotonic()
            if octets or now > end:
                # Silence is measured in the board's time: it may run slower than the clock.
                return self._splitter.feed(octets, self._time)
            if not self._pacer.free or self._time > self._awaited:
                time.sleep(_PAUSE)

    def beats(self, interval: float, end: threading.Event) -> Iterator[None]:
        """See Transport. A board that is faster than the clock waits for who is late with the next one."""
        try:
            while not end.is_set():
                beat = self._time + interval
                self._awaited = beat + _LATE
                while self._time < beat and not end.wait(_PAUSE / 2):
                    pass
                yield
        finally:
            self._awaited = math.inf

    def close(self) -> None:
        """See Transport. Switches the board off."""
        with self._lock:
            if not self._closed:
                self._closed = True
                self._board.close()

    @property
    def _time(self) -> float:
        return self._board.now / TICKS_PER_SECOND

    def _step(self) -> bytes:
        with self._lock:
            self._check()
            due = self._pacer.due(self._time)
            try:
                if due >= SLICE:
                    self._board.advance(round(SLICE * TICKS_PER_SECOND))
            except RuntimeError as error:
                raise LinkError(f"{self.name} stopped: {error}") from error
            return bytes(self._board.serial_read())

    def _check(self) -> None:
        if self._closed:
            raise LinkError(f"{self.name} is switched off")
