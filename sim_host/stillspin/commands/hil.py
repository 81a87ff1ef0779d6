"""`stillspin hil`: a board computes scenarios period by period and has to agree with the virtual drive to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core
from stillspin.cases import profile
from stillspin.commands.connection import DriveOption, wanted
from stillspin.drive.requester import Requester
from stillspin.errors import InputError
from stillspin.hil import Difference, Loop, runs
from stillspin.hil.results import Results, Row, begun, ended
from stillspin.hil.runs import LoopRun
from stillspin.link import address
from stillspin.link.errors import DriveError, RefusedError
from stillspin.one_line_errors import BROKEN
from stillspin.options import ChangeOption, ParamsOption, ProfileOption, SeedOption
from stillspin.report import tables
from stillspin.report.progress import PhaseBar
from stillspin.revision import revision
from stillspin.runs import commission, execute

_TIMEOUT = 1.0  # s; a step of a slow bus takes tens of milliseconds


def hil(
    *,
    scenarios: Annotated[
        list[str], typer.Argument(metavar="ID...", help="Scenarios, such as A10; commission; all for everything.")
    ],
    port: Annotated[
        str, typer.Option("--port", metavar="PORT", help="The board's serial port: /dev/ttyUSB0, or with ?baud=390625.")
    ] = "",
    can: Annotated[
        str,
        typer.Option("--can", metavar="ADAPTER", help="An SLCAN adapter: /dev/ttyACM0?node=1; or socketcan:can0."),
    ] = "",
    where: DriveOption = "",
    check: Annotated[
        bool, typer.Option("--check", help=f"Only the start and the first {runs.CHECK:g} s of every run.")
    ] = False,
    file: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Keep the results here, beside what it has already.")
    ] = None,
    profile_name: ProfileOption = "bench",
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    only: Annotated[list[str] | None, typer.Option("--run", help="Only this run of the scenario. Repeatable.")] = None,
) -> None:
    """Step a board through scenarios: this computer runs the plant, and compares every answer bit for bit.

    The board's power stage stays off; it leaves this mode by a reset, which the end of the command brings about.
    Exit status: 0 when every run is identical, 1 when one is not, 2 for bad input.
    """
    native = core.load()

    def settings(motor: str) -> execute.Settings:
        return _settings(native, (profile_name, motor), seed, change or [], params)

    chosen = [run for run in runs.named(scenarios, settings, native, check=check) if not only or run.name in only]
    if not chosen:
        raise InputError(f"--run {' '.join(only or [])}: there is no such run in {' '.join(scenarios)}")
    results = Results(file)
    done = [_tell(new) for new in _step_through(chosen, _address(port, can, where), results, native)]
    if len(done) > 1:
        tables.loop(done)
    if not all(new.identical for new in done):
        raise typer.Exit(BROKEN)


def _address(port: str, can: str, where: str) -> str:
    """The one address that is meant."""
    if (port != "") + (can != "") > 1:
        raise InputError("--port and --can: only one of them, there is one board")
    if port:
        return port if port.startswith("serial:") else f"serial://{port}"
    if can:
        interface, colon, _ = can.partition(":")
        return f"can:{can}" if colon and "/" not in interface else f"can:slcan:{can}"
    return wanted(where)


def _settings(
    native: core.NativeCore, plant: tuple[str, str], seed: int, change: list[str], params: ParamsOption
) -> execute.Settings:
    """Settings of a campaign; `plant`: names of profile and motor."""
    profile_name, motor = plant
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor)
    if params:
        chosen = replace(chosen, parameters={**chosen.parameters, **commission.load(params, known)})
    return execute.Settings(chosen, profile.changes(change, schema, known), seed, revision())


def _step_through(chosen: list[LoopRun], where: str, results: Results, native: core.NativeCore) -> Iterator[Row]:
    """The runs one after the other; what is lost with the board ends them behind a row that says so."""
    of, link = revision(), address.parse(where).kind
    with _loop(where) as loop:
        for run in chosen:
            title = f"{run.scenario} {run.name}"
            new = begun(run, link, of)
            try:
                with PhaseBar(Console(stderr=True)) as bar:
                    result = loop.run(native, run.play, partial(bar.show, phase=title))
                new = ended(new, result)
            except DriveError as error:
                new = replace(new, lost=str(error))
                results.add(new)
                yield new
                if isinstance(error, RefusedError):
                    continue
                return
            results.add(new)
            yield new


@contextmanager
def _loop(where: str) -> Iterator[Loop]:
    """A board in the loop, which is let go at the end."""
    requester = Requester(address.connect(where), _TIMEOUT)
    try:
        loop = Loop(requester)
        try:
            yield loop
        finally:
            with suppress(DriveError):  # a board that was never in the loop, or has left it already
                loop.leave()
    finally:
        requester.close()


def _tell(new: Row) -> Row:
    title = f"{new.scenario} {new.run}" + ("" if new.whole else " (its start)")
    rate = f"{new.steps} steps in {new.seconds:.1f} s ({new.rate:.0f} steps/s)"
    if new.lost:
        print(f"{title}: BROKE OFF: {new.lost}", flush=True)
    elif new.step is not None:
        print(f"{title}: DIFFERS at {Difference(new.step, new.words)}; {rate}", flush=True)
    else:
        end = f"; the run ended: {new.ended}" if new.ended else ""
        print(f"{title}: identical, log {new.board[:16]}, {rate}{end}", flush=True)
    return new
