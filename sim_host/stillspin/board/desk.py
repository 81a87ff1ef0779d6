"""The desk: a virtual board, what is plugged into it, and the slices in which its time passes."""

from __future__ import annotations

import select

from stillspin.board.advancing import advancing
from stillspin.board.can_plug import CanPlug
from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.core_board import NativeBoard

Plug = PseudoTerminal | CanPlug

TICKS_PER_SECOND = 100_000_000
SLICE = 0.002
"""Simulated seconds between two looks at the plugs."""
_QUEUE = 0.01
"""Seconds of octets that wait on the line before a program that writes is held back."""
_ANSWER = 0.01
"""Simulated seconds that a board in the loop may think before the plugs are looked at again."""
_WAIT = 0.02
"""Seconds of wall time between two of these looks while nothing comes."""
_SERVE = 50
"""Milliseconds in which native code serves the plugs of a board in the loop, before anything else is looked at."""
_MISMATCH = 0.03
_RATES = range(10, 10_000_001)


class Desk:
    """One board with its serial port plugged into a pseudo-terminal, and perhaps something on its CAN connector."""

    def __init__(self, board: NativeBoard, port: PseudoTerminal, can: CanPlug | None = None) -> None:
        self.board = board
        self.port = port
        self.can = can
        self.octets_in = 0
        self.octets_out = 0
        self._rests = False

    @property
    def time(self) -> float:
        """Seconds since the board was powered."""
        return self.board.now / TICKS_PER_SECOND

    def step(self, seconds: float) -> None:
        """Hand over what has been written, let time pass, hand back what the drive has sent.

        Args:
            seconds: simulated; at most SLICE, so that octets do not lie about.

        Raises:
            CampaignError: the board cannot go on.
        """
        self._hand_over()
        with advancing():
            self.board.advance(round(min(seconds, SLICE) * TICKS_PER_SECOND))
        self._hand_back()

    def answer(self) -> None:
        """For a board in the loop whose time is nobody's: wait for a request, let time pass until it is answered.

        Its time stands still while it waits, but for a moment now and then.

        Raises:
            CampaignError: the board cannot go on.
        """
        if not self.can or self.can.plain is not None:
            self._serve()
            return
        ready = self._wait() if self._rests else None
        octets_in = self.octets_in
        self._hand_over(ready)
        with advancing():
            heard = self.board.advance_until_heard(round(_ANSWER * TICKS_PER_SECOND))
        self._rests = heard or self.octets_in == octets_in
        self._hand_back()

    def _serve(self) -> None:
        """The same for a while in native code, where most of the time is."""
        self._hand_over()
        serial, can = self.port.listens_to, self.can.plain if self.can else None
        with advancing():
            served = self.board.serve_loop(-1 if serial is None else serial, -1 if can is None else can, _SERVE)
        octets_in, octets_out, commands, left, can_left = served
        self.octets_in += octets_in
        self.octets_out += octets_out
        if left:
            self.port.write(left)
        if self.can and (commands or can_left):
            self.can.pass_on(commands, can_left)
        self._hand_back()

    @property
    def wrong_rate(self) -> tuple[int, int] | None:
        """The bit rates of program and drive, when they do not fit together."""
        drive = self.board.serial_counts()["drive_rate"]
        if not self.port.is_open or drive == 0.0:
            return None
        rate = self.port.rate
        return (rate, round(drive)) if abs(rate / drive - 1.0) > _MISMATCH else None

    def close(self) -> None:
        """Switch the board off and unplug it."""
        self.board.close()
        self.port.close()
        if self.can:
            self.can.close()

    def _wait(self) -> list[Plug]:
        """Until a program has sent something, or for a while; the plugs at which it has."""
        wanted = {plug.listens_to: plug for plug in (self.port, self.can) if plug}
        ready, _, _ = select.select([descriptor for descriptor in wanted if descriptor is not None], (), (), _WAIT)
        return [wanted[descriptor] for descriptor in ready]

    def _hand_over(self, ready: list[Plug] | None = None) -> None:
        """What waits at these plugs, or at both."""
        if self.can and (ready is None or self.can in ready):
            self.can.hand_over()
        if ready is None or self.port in ready:
            self._hand_over_serial()

    def _hand_over_serial(self) -> None:
        rate = self.port.rate
        if rate in _RATES and rate != self.board.serial_rate:
            self.board.serial_rate = rate
        if self.board.serial_pending > _QUEUE * TICKS_PER_SECOND:
            return
        octets = self.port.read(max(int(_QUEUE * self.board.serial_rate / 10), 1))
        if octets:
            self.octets_in += len(octets)
            self.board.serial_write(octets)

    def _hand_back(self) -> None:
        octets = self.board.serial_read()
        if octets:
            self.octets_out += len(octets)
            self.port.write(octets)
        if self.can:
            self.can.hand_back()
