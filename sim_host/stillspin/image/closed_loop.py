"""A run of a scenario on an image, which drives the plant from the virtual chip's pins and is told by its serial port.

What the native run calls, the image is sent: parameters, references and commands as records of the link. What the
native run reads from the firmware's variables, the image streams (run_record.py).
"""

from __future__ import annotations

import struct
import time
from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from stillspin.cases.scenario import Run
from stillspin.core import NativeCore, Plant, Progress
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.drive import describe, values
from stillspin.drive.protocol import CONTROL_PERIOD, STREAM_EVENT, Command, Request, Words
from stillspin.drive.state import FAULT, READY, RUN, RawStatus
from stillspin.drive.table import Table
from stillspin.errors import CampaignError, StillspinError
from stillspin.image import opened
from stillspin.image.opened import Image
from stillspin.image.run_record import RASTER, Played, RunRecord
from stillspin.image.serial_client import SerialClient
from stillspin.link.errors import NoAnswerError, RefusedError
from stillspin.link.records import Record
from stillspin.scales import SCALES

_BOOT = 500
_READY = 50_000
_LATE = 60
_REPORT = 200

_COMMANDS = {"start": Command.START, "stop": Command.STOP, "coast": Command.COAST, "reset": Command.RESET}


class Wanted(Protocol):
    """What is run."""

    @property
    def run(self) -> Run:
        """Its steps."""

    @property
    def plant(self) -> Plant:
        """All entries that are not at their defaults."""

    @property
    def parameters(self) -> dict[str, float]:
        """Of the firmware."""

    @property
    def seed(self) -> int:
        """Of the noise."""


class _BrokenOffError(Exception):
    """The run has ended before its time; says why."""


Look = Callable[[NativeBoard], None]


def _not(_board: NativeBoard) -> None:
    pass


def play(
    native: NativeCore,
    job: Wanted,
    image: Image,
    progress: Progress | None,
    looks: tuple[Look, Look] = (_not, _not),
) -> Played:
    """The run. Never raises for what happens inside it.

    Args:
        native: the native module.
        job: what is run.
        image: what drives the plant.
        progress: gets the share done (0 … 1); false breaks the run off.
        looks: at the board when its start procedure is over, and when the run has ended behind it.

    Raises:
        InputError: the image cannot be executed.
        ValueError: the plant cannot be.
    """
    board = opened.power_plant(native, image, job.plant, job.seed)
    return play_on(board, job, progress, [str(row["name"]) for row in native.signals()], looks, image=image)


def play_on(
    board: NativeBoard,
    job: Wanted,
    progress: Progress | None,
    columns: Sequence[str],
    looks: tuple[Look, Look] = (_not, _not),
    *,
    image: Image | None = None,
) -> Played:
    """The same on a board that has just been switched on, of an image or not, which is switched off at the end."""
    loop = _ClosedLoop(board, job, progress or (lambda _: True), looks[0])
    reason = ""
    began = time.perf_counter()
    try:
        loop.carry_out()
    except CampaignError as error:
        reason = str(opened.placed(error, board, image) if image else error)
    except (_BrokenOffError, StillspinError) as error:
        reason = str(error)
    try:
        if loop.begun:
            looks[1](board)
    finally:
        resets = int(board.statistics()["resets"])
        loop.notes += opened.warnings(board, image) if image else []
        board.close()
    reason = reason or ("the watchdog reset the chip" if resets else "")
    return loop.played(columns, reason, time.perf_counter() - began)


class _ClosedLoop:
    def __init__(self, board: NativeBoard, job: Wanted, progress: Progress, begins: Look) -> None:
        self._board, self._job, self._progress, self._begins = board, job, progress, begins
        self._client = SerialClient(board, self._passed, self._event)
        self._record = RunRecord()
        self._table: Table | None = None
        self._origin: int | None = None
        self._load = 0.0
        self._corners = [time for time, _ in job.run.load]
        self._faults: list[tuple[float, str]] = []
        self.notes: list[str] = []
        self._left = list(job.run.commands)

    @property
    def begun(self) -> bool:
        """Whether the start procedure is over."""
        return self._origin is not None

    def carry_out(self) -> None:
        self._client.pass_periods(_BOOT)
        if self._finds_drive():
            self._start()
        else:
            self._say_what_cannot_be()
            self._begin()
        assert self._origin is not None
        end = self._origin + round(self._job.run.duration / CONTROL_PERIOD)
        while self._client.period < end + (_LATE if self._table else 0):
            self._client.pass_periods(1)
            self._give_commands()
            self._look_for_fault()

    def _finds_drive(self) -> bool:
        ask = self._client.ask
        try:
            who = describe.identity(ask)
        except NoAnswerError:
            return False
        self._read_table(who)
        return True

    def _read_table(self, who: describe.Identity) -> None:
        self._table = describe.table(self._client.ask, who, remembers=False)

    def _set_parameters(self, wanted: Mapping[str, float]) -> None:
        """The scales first: formats and ranges of all others follow from them."""
        scales = {name: value for name, value in wanted.items() if name in SCALES}
        for part in (scales, {name: value for name, value in wanted.items() if name not in SCALES}):
            for name, value in part.items():
                assert self._table is not None
                values.change(self._client.ask, self._table.parameter(name), value)
            if part is scales and scales:
                self._read_table(describe.identity(self._client.ask))

    def _say_what_cannot_be(self) -> None:
        run, words = self._job.run, []
        if self._job.parameters:
            words.append(counted(len(self._job.parameters), "parameter"))
        words.append("the start")
        if run.commands:
            words.append(counted(len(run.commands), "step") + " (references, commands)")
        self.notes.append(
            "the image answers no request of the record protocol at 115200 bit/s (IDENTITY, asked three times): "
            f"{', '.join(words)} could not be given to it and its own signals not be read; it ran under the "
            "scenario's load, and figures are of the true machine alone"
        )

    # ---- what the drive is told

    def _start(self) -> None:
        self._wait_for_ready()
        self._set_parameters(self._job.parameters)
        self._client.align()
        self._open_stream()
        if self._left and self._left[0][1] == "speed_ref_rpm" and self._left[0][0] <= 0.0:
            self._tell(*self._left.pop(0)[1:])
        self._client.ask(Request.COMMAND, struct.pack("<Bi", Command.START, 0))
        latest = self._client.period + round(self._job.run.max_start / CONTROL_PERIOD)
        while self._state() != RUN:
            self._client.pass_periods(1)
            if self._state() == FAULT:
                raise _BrokenOffError(f"fault during the start: {self._fault()}")
            if self._client.period > latest:
                raise _BrokenOffError(f"the start procedure took longer than {self._job.run.max_start:g} s")
        self._begin()

    def _wait_for_ready(self) -> None:
        end = self._client.period + _READY
        while self._client.period < end:
            status = RawStatus.unpack(self._client.ask(Request.STATUS, b""))
            if status.state == READY:
                return
            if status.state == FAULT:
                raise _BrokenOffError(f"fault before the start: {self._fault()}")
        raise _BrokenOffError(f"the drive is not ready {_READY * CONTROL_PERIOD:g} s after it answers")

    def _open_stream(self) -> None:
        assert self._table is not None
        missing = self._record.choose(self._table.signals)
        if missing:
            self.notes.append(f"this edition has no signal {', '.join(missing)}")
        places = [signal.index for signal in self._record.signals]
        period_ms = round(RASTER * CONTROL_PERIOD * 1e3)
        self._client.ask(Request.STREAM, struct.pack(f"<H{len(places)}H", period_ms, *places))

    def _begin(self) -> None:
        self._origin = self._client.period
        self._board.begin_run()
        self._begins(self._board)

    def _give_commands(self) -> None:
        while self._table and self._left and self._left[0][0] <= self._now() + 1e-9:
            _, what, value = self._left.pop(0)
            self._tell(what, value)

    def _tell(self, what: str, value: float) -> None:
        assert self._table is not None
        words = f"{what} {value:g}"
        if what.startswith("set:"):
            parameter = self._table.parameter(what.removeprefix("set:"))
            body = struct.pack("<Hi", parameter.id, parameter.to_raw(value))
            self._client.tell(Request.PARAMETER_SET, body, words)
        elif what == "speed_ref_rpm":
            self._client.tell(Request.COMMAND, struct.pack("<Bi", Command.SPEED, round(value * 2**16)), words)
        else:
            self._client.tell(Request.COMMAND, struct.pack("<Bi", _COMMANDS[what], 0), words)

    # ---- what comes back

    def _now(self) -> float:
        """Seconds since the start was over, negative before."""
        return -1.0 if self._origin is None else (self._client.period - self._origin) * CONTROL_PERIOD

    def _passed(self) -> None:
        self._record.pass_period(self._board.truth())
        self._renew_load()
        if self._client.period % _REPORT == 0 and not self._progress(
            min(max(self._now(), 0.0) / self._job.run.duration, 1.0)
        ):
            raise _BrokenOffError("stopped by the user")

    def _renew_load(self) -> None:
        points = self._job.run.load
        if self._origin is None or not points:
            return
        now = self._now()
        load = points[-1][1]
        after = bisect_right(self._corners, now)
        if after == 0:
            load = points[0][1]
        elif after < len(points):
            (t0, before), (t1, then) = points[after - 1 : after + 1]
            load = before + (then - before) * (now - t0) / (t1 - t0)
        if load != self._load:
            self._load = load
            self._board.set_load(load)

    def _event(self, record: Record) -> None:
        if record.kind == STREAM_EVENT:
            self._record.take(record.body, self._client.period)

    def _state(self) -> int:
        return self._record.state

    def _look_for_fault(self) -> None:
        if self._table and not self._faults and self._state() == FAULT:
            self._faults.append((self._now(), self._fault()))
            raise _BrokenOffError(f"fault: {self._faults[0][1]}")

    def _fault(self) -> str:
        status = RawStatus.unpack(self._client.ask(Request.STATUS, b""))
        try:
            words = self._client.ask(Request.WORDS, struct.pack("<BB", Words.FAULT, status.fault))
        except RefusedError:
            return f"number {status.fault}"
        return words.split(b"\0")[0].decode("ascii", "replace")

    # ---- what the run was

    def played(self, columns: Sequence[str], reason: str, wall: float) -> Played:
        refused = (f"refused: {words}" for words in self._client.refused)
        notes = [*self.notes, *refused]
        unknown = np.full(0, np.nan)
        rows: dict[str, npt.NDArray[Any]] = {}
        if self._origin is not None:
            rows, said = self._record.rows(self._origin, self._client.period, has_drive=self._table is not None)
            notes += said
            unknown = np.full(len(rows["time"]), np.nan)
        signals = {name: rows.get(name, unknown) for name in columns}
        stats = {
            "wall_seconds": wall,
            "simulated_seconds": self._client.period * CONTROL_PERIOD,
            "start_seconds": (self._origin or 0) * CONTROL_PERIOD,
        }
        return Played(signals, not reason, reason, self._faults, stats=stats, notes=notes, sent=self._client.sent)
