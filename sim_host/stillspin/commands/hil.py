"""`stillspin hil`: a board computes a scenario period by period and has to agree with the virtual drive to the bit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from typing import Annotated

import typer
from rich.console import Console

from stillspin import commission, core, execute, profile, scenario_file
from stillspin.commands.connection import DriveOption, wanted
from stillspin.drive.requester import Requester
from stillspin.hil import Loop, LoopResult
from stillspin.link import address
from stillspin.link.errors import DriveError
from stillspin.one_line_errors import BROKEN
from stillspin.options import ChangeOption, ParamsOption, ProfileOption, SeedOption
from stillspin.progress import PhaseBar
from stillspin.revision import revision

_TIMEOUT = 1.0  # s; a step of a slow bus takes tens of milliseconds


def hil(
    *,
    scenarios: Annotated[list[str], typer.Argument(metavar="ID...", help="Scenarios, such as A10.")],
    where: DriveOption = "",
    profile_name: ProfileOption = "bench",
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    only: Annotated[list[str] | None, typer.Option("--run", help="Only this run of the scenario. Repeatable.")] = None,
) -> None:
    """Step a board through scenarios: this computer runs the plant, and compares every answer bit for bit.

    The board's power stage stays off; it leaves this mode by a reset, which the end of the command brings about.
    """
    native = core.load()
    todo = [scenario_file.load(name) for name in scenarios]
    settings = {
        motor: _settings(native, (profile_name, motor), seed, change or [], params)
        for motor in {scenario.motor for scenario in todo}
    }
    jobs = [job for scenario in todo for job in execute.prepare(scenario, settings[scenario.motor], native)]
    jobs = [job for job in jobs if not only or job.run.name in only]
    agreed = True
    with _loop(wanted(where)) as loop:
        for job in jobs:
            title = f"{job.scenario} {job.run.name}"
            with PhaseBar(Console(stderr=True)) as bar:
                result = loop.run(native, job, partial(bar.show, phase=title))
            _tell(title, result)
            agreed = agreed and result.difference is None
    if not agreed:
        raise typer.Exit(BROKEN)


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


def _tell(title: str, result: LoopResult) -> None:
    rate = f"{result.steps} steps in {result.seconds:.1f} s ({result.rate:.0f} steps/s)"
    if result.difference:
        print(f"{title}: DIFFERS at {result.difference}; {rate}")
    else:
        end = f"; the run ended: {result.reason}" if result.reason else ""
        print(f"{title}: identical, log {result.board[:16]}, {rate}{end}")
