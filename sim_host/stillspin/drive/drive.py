"""The drive as an object. Values are in the units that the drive's table states; angles in turns."""

from __future__ import annotations

import secrets
import struct
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import replace

from stillspin.drive import describe, log, protocol, scope, values
from stillspin.drive import look as looking
from stillspin.drive.commissioning import OnProgress, Report, follow
from stillspin.drive.describe import unpack
from stillspin.drive.protocol import HOLDERS, Command, Request, StatusCode, Words
from stillspin.drive.requester import Requester, wait_until
from stillspin.drive.state import ENERGISED, FAULT, RUN, Fault, RawFault, RawStatus, Status, rpm
from stillspin.drive.stream import Stream
from stillspin.drive.table import KNOWN_ROTOR, Table
from stillspin.drive.values import ConflictWarning
from stillspin.errors import InputError
from stillspin.link import address
from stillspin.link.errors import DriveError, NoAnswerError, RefusedError
from stillspin.link.transport import Transport
from stillspin.link.virtual import VirtualTransport
from stillspin.quantity import Range

_LIMIT_BITS = 16
_SPEED_MAX = 2.0**15
_SIGNALS_MOST = 16


class Drive:
    """One drive. Every method may be called from any thread; use it as a context, so that the port is given back."""

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
            self.identity = describe.identity(self._ask)
            self.table: Table = describe.table(self._ask, self.identity, progress)
        except BaseException:
            self.link.close()
            raise

    @classmethod
    def open(cls, where: str, *, timeout: float = 0.6, progress: Callable[[float], None] | None = None) -> Drive:
        """The drive at an address such as serial:///dev/ttyUSB0?baud=115200 or can:slcan:/dev/ttyACM0?node=1.

        Raises:
            InputError: no address.
            DriveError: nothing can be opened there, or nothing answers.
        """
        return cls(address.connect(where), timeout=timeout, progress=progress)

    @classmethod
    def virtual(
        cls, profile: str = "bench", changes: list[str] | None = None, *, speed: float = 1.0, seed: int = 1
    ) -> Drive:
        """A virtual board in this process; `drive.link.transport` has its shaft (set_load, truth).

        Args:
            profile: the plant, a name from `stillspin list` or a TOML file.
            changes: as `run --set` takes them.
            speed: multiple of real time; 0 is as fast as possible.
            seed: of the noise.
        """
        return cls(VirtualTransport(profile, changes, speed=speed, seed=seed), timeout=2.0)

    def __enter__(self) -> Drive:
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

    # Parameters

    def get(self, name: str) -> float:
        """The value of a parameter."""
        parameter = self.table.parameter(name)
        (raw,) = unpack("<i", self._ask(Request.PARAMETER_GET, struct.pack("<H", parameter.id)))
        return parameter.to_user(raw)

    def set(self, name: str, value: float | str) -> float:
        """Change a parameter until the drive is switched off; `save` keeps it.

        Args:
            name: of the parameter.
            value: in its unit; text may have the unit behind the number.

        Returns:
            The value that is in effect. A value that does not go together with the others, so that the drive would
            not start, is taken with a ConflictWarning: the next ones may put it right.

        Raises:
            InputError: no such parameter, no number, or out of range.
            RefusedError: the drive says why not.
        """
        change = self.change(name, value)
        if change.conflict:
            warnings.warn(change.conflict, ConflictWarning, stacklevel=2)
        return change.value

    def change(self, name: str, value: float | str) -> values.Change:
        """As `set`, with the drive's words about a conflict instead of a warning."""
        return values.change(self._ask, self.table.parameter(name), value)

    def parameters(self) -> dict[str, float]:
        """The values of all parameters, by name."""
        return {name: self.table.parameter(name).to_user(raw) for name, raw in self.raw_parameters().items()}

    def raw_parameters(self) -> dict[str, int]:
        """All parameters as the drive holds them."""
        return values.read_all(self._ask, self.table)

    # Commands

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
        wanted = Range(unit="rpm").read(speed, "speed")
        try:
            if abs(wanted) < _SPEED_MAX:
                self.command(Command.SPEED, round(wanted * 2**16))
                return
        except RefusedError as error:
            if error.status != StatusCode.RANGE:
                raise
        limit = self.get("speed_limit")
        Range(-limit, limit, "rpm", set_by="speed_limit").read(speed, "speed")

    def save(self) -> None:
        """Keep the present parameters in the drive's store; returns when they are there.

        Raises:
            DriveError: they are not.
        """
        values.save(self)

    def defaults(self) -> None:
        """Every parameter to its default; not kept until `save`."""
        self.command(Command.DEFAULTS)

    def load(self) -> None:
        """Every parameter as the store has it."""
        self.command(Command.LOAD)

    def command(self, code: Command, argument: int = 0) -> None:
        """Any command; see the protocol."""
        repeat = code in protocol.REPEATABLE_COMMANDS
        urgent = code in {Command.STOP, Command.COAST}
        self.link.request(Request.COMMAND, struct.pack("<Bi", code, argument), repeat=repeat, urgent=urgent)

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
            why = status.fault or f"the drive is {status.state} after {timeout:g} s"
            raise DriveError("; ".join(filter(None, (f"the motor does not run: {why}", status.remedy))))

    # Inspection

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
            fault=self.words(Words.FAULT, raw.fault) if raw.fault else "",
            remedy=self.words(Words.REMEDY, raw.fault) if raw.fault else "",
            limits=tuple(self.words(Words.LIMIT, bit) for bit in bits),
            speed=rpm(raw.speed_q16, bool(raw.known & KNOWN_ROTOR)),
            speed_known=bool(raw.known & KNOWN_ROTOR),
            reference=rpm(raw.reference_q16),
            store=self.words(Words.STORE, raw.store),
            unsaved=raw.unsaved_known,
            raw=raw,
        )

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
            kinds = ((Words.FAULT, raw.code), (Words.STATE, raw.state), (Words.REMEDY, raw.code))
            found.append(Fault.from_raw(raw, *(self.words(*kind) for kind in kinds)))
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
            except RefusedError:
                self._words[kind, code] = "" if kind == Words.REMEDY else f"{kind.name.lower()} {code}"
        return self._words[kind, code]

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

    # Scope

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
            run: rpm at which the motor runs from when the scope is armed until the capture is done, as by `running`.

        Raises:
            DriveError: no trigger came, or the motor does not run.
        """
        chosen = tuple(scope.Channel(item) if isinstance(item, str) else item for item in channels)
        setup = scope.Setup(
            chosen, trigger or scope.Trigger(chosen[0].signal if chosen else ""), decimation, pretrigger
        )
        self.scope_arm(setup)
        with nullcontext() if run is None else self.running(run):
            done = wait_until(lambda: self.scope_state().done, timeout + setup.duration)
        if not done:
            self.scope_stop()
            raise DriveError(f"no trigger within {timeout:g} s; check its signal, level and edge")
        return self.scope_read(setup)

    # Commissioning

    def commission(self, on_progress: OnProgress | None = None) -> Report:
        """Let the drive measure machine and inverter. It takes about a minute and a half and turns the shaft.

        It ends with this program: the drive stops by itself when it hears nothing from this client.

        Args:
            on_progress: gets the share done, 0 to 1, and the phase in words, at the end what is not saved; False from
                it stops.

        Raises:
            DriveError: it was stopped, or ended in a fault.
        """
        with self.kept_alive():
            self.command(Command.COMMISSION, self.hold())
            return follow(self, on_progress)

    def _ask(self, kind: Request, body: bytes) -> bytes:
        return self.link.request(kind, body, repeat=kind in protocol.REPEATABLE)
