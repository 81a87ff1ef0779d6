"""A drive that moves its motor."""

from __future__ import annotations

import secrets
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from stillspin.drive import look as looking
from stillspin.drive.adjustment import Adjustment
from stillspin.drive.protocol import HOLDERS, Command, StatusCode
from stillspin.drive.requester import wait_until
from stillspin.drive.state import ENERGISED, FAULT, RUN
from stillspin.errors import InputError
from stillspin.link.errors import DriveError, NoAnswerError, RefusedError
from stillspin.quantity import Range

_SPEED_MAX = 2.0**15


class Motion(Adjustment):
    """Its motor."""

    def start(
        self, speed: float | str | None = None, *, guarded: bool = False, wait: bool = False, timeout: float = 10.0
    ) -> None:
        """Energise the motor.

        Args:
            speed: rpm, set beforehand; otherwise the one in force.
            guarded: the drive stops by itself when this client has not asked for its `status` for the drive's
                `link_timeout`; `kept_alive` asks by itself. What other clients ask does not count.
            wait: return when the start procedure is over and the motor runs; otherwise as soon as the drive begins.
            timeout: s to wait for that.

        Raises:
            RefusedError: it is not ready, or its parameters do not fit together.
            DriveError: with `wait`, the start ended in a fault, in the drive's words; or it took longer than
                `timeout`, and the motor is stopped.
        """
        if speed is not None:
            self.ref(speed)
        self.command(Command.START, self.hold() if guarded else 0)
        if wait:
            try:
                self.wait_for_run(timeout)
            except BaseException:
                with suppress(DriveError):
                    self.stop()
                raise

    def stop(self) -> None:
        """Speed to zero along the ramp, then power stage off."""
        self.command(Command.STOP)

    def hold(self) -> int:
        """The argument of a guarded start: this client's number, which `status` tells the drive from now on."""
        self.holder = self.holder or secrets.choice(HOLDERS)
        return self.holder

    def let_go(self) -> bool:
        """Stop the motor if it runs by a guarded start of this client, and say whether it did."""
        held = self.raw_status(urgent=True).held
        if held:
            self.stop()
        return held

    def coast(self) -> None:
        """Power stage off at once; the shaft coasts."""
        self.command(Command.COAST)

    def look(self) -> looking.Look:
        """How the shaft turns, when that is unknown: two short-circuit pulses from `ready`, then ready again.

        Raises:
            RefusedError: it is not ready, or its parameters do not fit together.
            DriveError: ended by a stop or a fault.
        """
        return looking.look(self)

    def reset(self) -> None:
        """Clear a latched fault."""
        self.command(Command.RESET)

    def ref(self, speed: float | str) -> None:
        """Speed reference.

        Args:
            speed: rpm; text may have the unit behind the number.

        Raises:
            InputError: no number, or beyond the drive's speed_limit.
            RefusedError: the drive says why not.
        """
        try:
            wanted = Range(unit="rpm").read(speed, "speed")
            if abs(wanted) < _SPEED_MAX:
                self.command(Command.SPEED, round(wanted * 2**16))
                return
        except InputError:  # said below, with the range that holds
            pass
        except RefusedError as error:
            if error.status != StatusCode.RANGE:
                raise
        limit = self.get("speed_limit")
        Range(-limit, limit, "rpm", set_by="speed_limit").read(speed, "speed")

    @contextmanager
    def running(self, speed: float, *, timeout: float = 10.0) -> Iterator[None]:
        """The motor runs while the context lasts, and no longer: guarded by the link, stopped at its end.

        Args:
            speed: rpm.
            timeout: s for the start, and for the stop.

        Raises:
            DriveError: it does not start, or ends in a fault.
        """
        self.start(speed, guarded=True)
        with self.kept_alive():
            try:
                self.wait_for_run(timeout)
                yield
            finally:
                if not self.link.lost and self.let_go():
                    wait_until(lambda: self.raw_status().state not in ENERGISED, timeout)

    @contextmanager
    def kept_alive(self, interval: float = 0.05) -> Iterator[None]:
        """Lets the drive hear from this client every `interval` seconds, as a guarded start wants it."""
        end = threading.Event()
        self.hold()

        def tell() -> None:
            for _ in self.link.transport.beats(interval, end):
                try:
                    self.raw_status()
                except NoAnswerError:
                    continue
                except DriveError:
                    return

        thread = threading.Thread(target=tell, name="stillspin keep-alive", daemon=True)
        thread.start()
        try:
            yield
        finally:
            end.set()
            thread.join()

    def wait_for_run(self, timeout: float = 10.0) -> None:
        """Wait until the start procedure is over and the motor runs.

        Raises:
            DriveError: a fault, or not in time.
        """
        wait_until(lambda: self.raw_status().state in {RUN, FAULT}, timeout)
        status = self.status()
        if status.raw.state != RUN:
            why = status.fault_text or f"the drive is {status.state} after {timeout:g} s"
            raise DriveError(f"the motor does not run: {why}")
