"""A drive whose signals are recorded: as a stream, a log, or a capture around a trigger."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace

from stillspin.drive import log, scope, values
from stillspin.drive.describe import unpack
from stillspin.drive.motion import Motion
from stillspin.drive.protocol import Request
from stillspin.drive.requester import wait_until
from stillspin.drive.stream import Stream
from stillspin.link.errors import DriveError


class Acquisition(Motion):
    """Its signals over time."""

    def stream(self, signals: Sequence[str], period: float = 0.02) -> Stream:
        """Up to eight signals every `period` seconds; iterate over it."""
        return Stream(self.link, self.table.chosen(signals), period)

    def log(self, *signals: str, duration: float, period: float = 0.02) -> log.Log:
        """Keep up to eight signals for a while; returns when it is over.

        Args:
            signals: names.
            duration: s.
            period: s between samples, 1 ms and more.

        Raises:
            InputError: no such signal, too many, or a period or duration out of range.
            LinkError: the way to the drive is lost.
        """
        with self.stream(signals, period) as stream:
            return log.keep(stream, duration, self.identity.text)

    def scope_arm(self, setup: scope.Setup) -> None:
        """Start a capture."""
        self._ask(Request.SCOPE_SETUP, scope.encode(setup, self.table))
        self.link.request(Request.SCOPE_ARM, repeat=False)

    def scope_state(self) -> scope.ScopeState:
        """Where the capture stands."""
        state, recorded, at, time_ms = unpack("<BHHI", self._ask(Request.SCOPE_STATE, b""))
        return scope.ScopeState(state, recorded, at, time_ms / 1e3)

    def scope_stop(self) -> None:
        """End a capture; what has been recorded can be read."""
        self._ask(Request.SCOPE_STOP, b"")

    def scope_read(self, setup: scope.Setup, chunk: int = scope.CHUNK) -> scope.Capture:
        """Fetch a capture that is done or stopped; small chunks of records leave room on the line for a stream."""
        state = self.scope_state()
        words = [values.read_channel(self._ask, number, state.recorded, chunk) for number in range(len(setup.channels))]
        return replace(scope.decode(setup, state, words, self.table), version=self.identity.text)

    def capture(
        self,
        *channels: str | scope.Channel,
        trigger: scope.Trigger | None = None,
        decimation: int = 1,
        pretrigger: float = 0.25,
        timeout: float = 10.0,
        run: float | None = None,
    ) -> scope.Capture:
        """Record up to four signals around a trigger.

        Args:
            channels: names of signals, or Channels with a full scale.
            trigger: at once without one.
            decimation: control interrupts (100 µs) per record.
            pretrigger: share of the records before the trigger.
            timeout: s to wait for the trigger.
            run: rpm at which the motor runs, as by `running`, from when the scope waits for its trigger (the records
                in front of one are there by then) until the capture is done.

        Raises:
            DriveError: no trigger came, or the motor does not run.
        """
        chosen = tuple(scope.Channel(item) if isinstance(item, str) else item for item in channels)
        setup = scope.Setup(
            chosen, trigger or scope.Trigger(chosen[0].signal if chosen else ""), decimation, pretrigger
        )
        self.scope_arm(setup)
        if run is not None and setup.trigger.edge != "now":
            wait_until(lambda: self.scope_state().state != scope.FILLING, timeout + setup.duration)
        with nullcontext() if run is None else self.running(run):
            done = wait_until(lambda: self.scope_state().done, timeout + setup.duration)
        if not done:
            self.scope_stop()
            raise DriveError(f"no trigger within {timeout:g} s; check its signal, level and edge")
        return self.scope_read(setup)
