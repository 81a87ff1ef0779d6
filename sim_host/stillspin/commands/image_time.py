"""`stillspin image time`: what an image's interrupts, functions and source lines take on the virtual board."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core, resources
from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.c28x import timed
from stillspin.cases import profile, scenario_file
from stillspin.core_board import NativeBoard
from stillspin.core_code import Interrupt, Spent
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash import sections
from stillspin.image import closed_loop, opened, vectors
from stillspin.image.opened import Image
from stillspin.options import ImageArgument, OtherMotorOption, ProfileOption, RomOption, SeedOption, number, whole
from stillspin.report.progress import PhaseBar
from stillspin.revision import revision
from stillspin.runs import execute
from stillspin.runs.execute import Job, Settings

_STACK = 0x0400
"""Where the boot ROM leaves the stack pointer."""
_STACK_SECTION = ".stack"
_STACK_NAMES = ("__stack", "___stack")
"""Of the linker, where the stack begins."""
_ELSEWHERE = "(code without a name)"
_OUTSIDE = "(outside of the memories)"
_USUAL = 0.1
"""Seconds that it is looked at."""
_WAITS = ("registers", "data", "fetches")


def _say_run(file: Path, seconds: float, before: Mapping[str, int], after: Mapping[str, int], asleep: int) -> None:
    grown = {key: after[key] - before[key] for key in after}
    cycles = max(grown["cycles"], 1)
    print(f"{file.name}: {seconds:g} s, {cycles} cycles, {counted(grown['instructions'], 'instruction')}")
    waited = ", ".join(f"{what} {100 * grown[f'waited_for_{what}'] / cycles:.1f} %" for what in _WAITS)
    print(f"waited for {waited}; asleep {100 * asleep / (seconds * TICKS_PER_SECOND):.1f} %")


def _say_interrupts(
    image: Image,
    each: Mapping[Interrupt, list[int]],
    within: Mapping[Interrupt, Mapping[int, int]],
    most: int,
    lines: int,
) -> None:
    names, begins = image.names.functions, _begins(image)
    print(f"\n{'interrupt':<28}{'count':>8}{'mean':>10}{'worst':>8}   cycles")
    for which in sorted({*each, *within}):
        vector, routine = which
        label = f"{vectors.name(vector)} {names.get(routine, f'0x{routine:06X}')}"
        cycles = each.get(which)
        if not cycles:
            print(f"{label:<28}{'entered, but none has returned':>34}")
            continue
        print(f"{label:<28}{len(cycles):>8}{sum(cycles) / len(cycles):>10.1f}{max(cycles):>8}")
        for line in timed.histogram(cycles):
            print(line)
        inside = {address: (count, 0, 0, 0) for address, count in within.get(which, {}).items()}
        rows = timed.functions(image.program, names, inside, begins)
        of_each = [(row.name, row.cycles) for row in rows[:most]]
        of_each += [
            ("(the others)", sum(row.cycles for row in rows[most:])),
            (_ELSEWHERE, timed.elsewhere(rows, inside)[0]),
            (_OUTSIDE, timed.outside(inside)[0]),
        ]
        of_each += [(f"{source}", count[0]) for source, count in timed.by_line(image.names.lines, inside)[:lines]]
        for name, count in of_each:
            if count:
                print(f"    {name:<32}{count / len(cycles):>10.1f}   of each in the mean")


def _begins(image: Image) -> dict[int, str]:
    """The names of its sections by where they begin; none of a format without names."""
    there = [part for part in sections.read(image.file, image.program) if not part.name.startswith("(")]
    return {at: part.name for part in there for at in (part.run, part.load) if at is not None}


def _shares(spent: Spent, total: int) -> str:
    """Columns: cycles, their share of all, and of them what was waited for."""
    cycles, *waits = spent
    columns = "".join(f"{100 * wait / max(cycles, 1):>10.1f}%" for wait in waits)
    return f"{cycles:>12}{100 * cycles / total:>8.1f}%{columns}"


_HEADS = f"{'cycles':>12}{'share':>9}" + "".join(f"{head:>11}" for head in _WAITS)


def _say_functions(image: Image, spent: Mapping[int, Spent], most: int) -> None:
    program = image.program
    rows = timed.functions(program, image.names.functions, spent, _begins(image))
    total = max(sum(cycles for cycles, *_ in spent.values()), 1)
    print(f"\n{'function':<28}{_HEADS}{'ran':>8}   of its words")
    for row in rows[:most]:
        size = row.end - row.first
        share = f"{'copied':>8}" if row.copied else f"{100 * row.ran / size:>7.0f}%{size:>8}"
        print(f"{row.name:<28}{_shares(row.spent, total)}{share}")
    if len(rows) > most:
        print(f"and {len(rows) - most} more (--functions)")
    for what, rest in ((_ELSEWHERE, timed.elsewhere(rows, spent)), (_OUTSIDE, timed.outside(spent))):
        if rest[0]:
            print(f"{what:<28}{_shares(rest, total)}")
    ran = sum(row.ran for row in rows)
    print(f"code that ran: {counted(ran, 'word')} of {program.size} that the image has, data among them")


def _say_lines(image: Image, spent: Mapping[int, Spent], most: int) -> None:
    if not image.names.lines:
        print(
            "\nno source lines: the image has neither .debug_line of DWARF 2 to 5 (cl2000 -g) nor line numbers of COFF"
        )
        return
    total = max(sum(cycles for cycles, *_ in spent.values()), 1)
    rows = timed.by_line(image.names.lines, spent)
    print(f"\n{'source line':<28}{_HEADS}")
    for source, count in rows[:most]:
        print(f"{source!s:<28}{_shares(count, total)}")
    if len(rows) > most:
        print(f"and {len(rows) - most} more (--lines)")


def _of_the_stack(image: Image, highest: int) -> str:
    """How much that is, as far as the image says where its stack begins, and of how much."""
    room = [part for part in sections.read(image.file, image.program) if part.name == _STACK_SECTION]
    addresses = image.names.addresses
    begin = room[0].run if room else next((addresses[name] for name in _STACK_NAMES if name in addresses), _STACK)
    if highest < begin:
        return ""
    return f", {counted(highest - begin, 'word', room[0].words if room else None)} from 0x{begin:04X}"


class _Looked:
    """What an image did from a moment on."""

    def __init__(self, image: Image, most: int, lines: int) -> None:
        self._image, self._most, self._lines = image, most, lines

    def begin(self, board: NativeBoard) -> None:
        """From now on."""
        self._before, self._asleep, self._since = board.code(), board.statistics()["idle_ticks"], board.now
        board.profile()

    def say(self, board: NativeBoard) -> None:
        """Until now."""
        seconds = (board.now - self._since) / TICKS_PER_SECOND
        _say_run(self._image.file, seconds, self._before, board.code(), board.statistics()["idle_ticks"] - self._asleep)
        spent, interrupts, stack = board.spent()
        within = board.within()
        if interrupts or within:
            _say_interrupts(self._image, interrupts, within, self._most, self._lines)
        _say_functions(self._image, spent, self._most)
        if self._lines:
            _say_lines(self._image, spent, self._lines)
        print(f"stack: up to 0x{stack:04X}{_of_the_stack(self._image, stack)}")


def _jobs(scenarios: Sequence[str], image: Image, profile_name: str, motor: str | None, seed: int) -> list[Job]:
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = [(scenario, motor or scenario.motor) for scenario in map(scenario_file.load, scenarios)]
    motors = dict.fromkeys(name for _, name in chosen)
    plates = {name: profile.load(profile_name, schema, known, name) for name in motors}
    for plate in plates.values():
        profile.say_not_stated(plate)
    jobs: list[Job] = []
    for scenario, name in chosen:
        settings = Settings(plates[name], profile.Changes(), seed, revision(), image=image)
        jobs += execute.prepare(scenario, settings, native)
    return jobs


def _in_scenarios(image: Image, jobs: Sequence[Job], looked: _Looked) -> bool:
    """Each run in turn; whether all came to their ends."""
    native = core.load()
    whole = True
    for number_of, job in enumerate(jobs):
        print(f"{'' if number_of == 0 else chr(10)}{job.scenario}, run {job.run.name}:")
        with PhaseBar(Console(stderr=True)) as bar:
            show = partial(bar.show, phase=f"{job.scenario} {job.run.name}")
            played = closed_loop.play(native, job, image, show, (looked.begin, looked.say))
        for words in played.notes:
            print(words)
        if not played.completed:
            print(f"stillspin: {job.scenario}, run {job.run.name}: broken off: {played.reason}", file=sys.stderr)
        whole = whole and played.completed
    return whole


def time(
    *,
    file: ImageArgument,
    scenarios: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[SCENARIO]...",
            help="Scenarios to run; the image is told what to do over its serial port [default: none].",
        ),
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            "--for",
            parser=number("--for", 0.0001, unit="s"),
            metavar="SECONDS",
            help="How long to look; a scenario says that itself [default: 0.1].",
        ),
    ] = None,
    after: Annotated[
        float | None,
        typer.Option(
            "--after",
            parser=number("--after", 0, unit="s"),
            metavar="SECONDS",
            help="From when on, after power-on; in a scenario it is the end of the start procedure [default: 0].",
        ),
    ] = None,
    most: Annotated[
        int,
        typer.Option(
            "--functions", metavar="N", parser=whole("--functions", 1, 10_000), help="How many functions to list."
        ),
    ] = 20,
    lines: Annotated[
        int,
        typer.Option(
            "--lines", metavar="N", parser=whole("--lines", 0, 100_000), help="How many source lines to list."
        ),
    ] = 0,
    rom: RomOption = None,
    profile_name: ProfileOption = "bench",
    motor: OtherMotorOption = None,
    seed: SeedOption = 1,
) -> None:
    """Run an image on the virtual board and say what its interrupts and functions took, in cycles of the CPU.

    In a scenario it drives the motor, and is told what to do over its serial port; exit status 1 when a run breaks off.
    """
    image = opened.read(file, rom)
    looked = _Looked(image, most, lines)
    if scenarios:
        if seconds is not None or after is not None:
            raise InputError("--for, --after: a scenario says itself from when and how long; leave them out")
        if not _in_scenarios(image, _jobs(scenarios, image, profile_name, motor, seed), looked):
            raise typer.Exit(ExitCode.SHORT)
        return
    board = opened.power_on(image, profile_name, motor or resources.DEFAULT_MOTOR, seed)
    with opened.closing(board, image):
        opened.advance(board, after or 0.0)
        looked.begin(board)
        opened.advance(board, _USUAL if seconds is None else seconds)
        looked.say(board)
        opened.say(board, image)
