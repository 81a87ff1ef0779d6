"""`stillspin image record` and `image replay`: one run's inputs given to another, and their outputs compared."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import core, resources
from stillspin.board import power
from stillspin.cases import profile, scenario_file
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.errors import CampaignError, InputError
from stillspin.exit_codes import ExitCode
from stillspin.image import opened
from stillspin.image import recording as recordings
from stillspin.image.opened import Image
from stillspin.image.recording import Difference, Octets, Recording
from stillspin.options import (
    NEEDS_IMAGE,
    ImageArgument,
    MotorOption,
    OtherMotorOption,
    ProfileOption,
    RomOption,
    SeedOption,
    number,
)
from stillspin.report.progress import PhaseBar
from stillspin.revision import revision
from stillspin.runs import execute
from stillspin.runs.execute import Job, Settings

_USUAL = 0.1
"""Seconds that are recorded."""


def _octets(texts: list[str]) -> list[Octets]:
    """SECONDS:TEXT, a line each."""
    made = []
    for text in texts:
        when, mark, line = text.partition(":")
        try:
            seconds = float(when)
        except ValueError:
            seconds = -1.0
        if not mark or not 0 <= seconds < float("inf"):
            raise InputError(f"--send: '{text}' is not SECONDS:TEXT, such as 0.5:start")
        made.append((seconds, f"{line}\r".encode().hex()))
    return made


def _firmware(profile_name: str, motor: str, seed: int) -> NativeBoard:
    native = core.load()
    chosen = profile.load(profile_name, core.plant_schema(native), core.parameters(native), motor)
    profile.say_not_stated(chosen)
    return power.power(native, chosen, profile.Changes(), seed)


def _job(identifier: str, only: str | None, image: Image | None, where: tuple[str, str | None, int]) -> Job:
    """A run of a scenario: profile, motor and seed as given."""
    native = core.load()
    scenario = scenario_file.load(identifier)
    profile_name, motor, seed = where
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor or scenario.motor)
    profile.say_not_stated(chosen)
    settings = Settings(chosen, profile.Changes(), seed, revision(), image=image)
    jobs = {job.run.name: job for job in execute.prepare(scenario, settings, native)}
    name = only or next(iter(jobs))
    if name not in jobs:
        raise InputError(f"--run {name}: {scenario.id} has no such run; it has {', '.join(jobs)}")
    return jobs[name]


def _of_scenario(job: Job) -> Recording:
    with PhaseBar(Console(stderr=True)) as bar:
        recording, played = recordings.of_run(
            core.load(), job, job.image, partial(bar.show, phase=f"{job.scenario} {job.run.name}")
        )
    for words in played.notes:
        print(words)
    if recording is None or not played.completed:
        raise CampaignError(f"{job.scenario}, run {job.run.name}: broken off, nothing is recorded: {played.reason}")
    return recording


def record(
    *,
    out: Annotated[Path, typer.Argument(metavar="RECORDING", help="Where to write what was recorded.")],
    file: Annotated[
        Path | None,
        typer.Option(
            "--image", metavar="FILE", help="Record this image instead of the firmware that is built for this computer."
        ),
    ] = None,
    scenario: Annotated[
        str | None,
        typer.Option(
            "--scenario",
            metavar="ID",
            help="Record a run of this scenario; the drive is told what to do over its serial port.",
        ),
    ] = None,
    only: Annotated[
        str | None, typer.Option("--run", metavar="NAME", help="Which of its runs [default: the first].")
    ] = None,
    seconds: Annotated[
        float | None,
        typer.Option(
            "--for",
            parser=number("--for", 0.0001, 100, "s"),
            metavar="SECONDS",
            help="How long [default: 0.1, or the scenario's run].",
        ),
    ] = None,
    send: Annotated[
        list[str] | None,
        typer.Option(
            "--send", metavar="SECONDS:TEXT", help="Send this line to the serial port at that time. Repeatable."
        ),
    ] = None,
    rom: RomOption = None,
    profile_name: ProfileOption = "bench",
    motor: OtherMotorOption = None,
    seed: SeedOption = 1,
) -> None:
    """Record a run from power-on: all that a program reads of its surroundings, and all that it has the gates do.

    Read are the codes of the converter (ADC), pins, trip inputs and the encoder's edges; written the registers of the
    timers that make the gates' pulses (ePWM).
    """
    octets = _octets(send or [])
    if rom and not file:
        raise InputError(NEEDS_IMAGE)
    image = opened.read(file, rom) if file else None
    if scenario:
        if octets:
            raise InputError("--send: a scenario says itself what is sent; leave it out")
        job = _job(scenario, only, image, (profile_name, motor, seed))
        recording = _of_scenario(job if seconds is None else replace(job, run=replace(job.run, duration=seconds)))
    else:
        if only:
            raise InputError(f"--run {only}: is one of a scenario; name that with --scenario")
        name = motor or resources.DEFAULT_MOTOR
        board = opened.power_on(image, profile_name, name, seed) if image else _firmware(profile_name, name, seed)
        with opened.closing(board, image) if image else closing(board):
            recording = recordings.play(board, _USUAL if seconds is None else seconds, octets)
            if image:
                opened.say(board, image)
    made_by, says = (image.file.name, opened.identity(image)) if image else ("firmware", firmware())
    recordings.save(replace(recording, made_by=made_by, firmware=says, revision=revision()), out)
    print(f"{out}: {counted(len(recording.samples), 'sample')}, {counted(len(recording.writes), 'write')} to the ePWM")


def _write(write: tuple[int, int, int] | None) -> str:
    if write is None:
        return "no write any more"
    return f"step {write[0]}, {recordings.register(write[1])} = 0x{write[2]:04X}"


def _say(difference: Difference, image: Image) -> None:
    recorded, here = _write(difference.expected), _write(difference.found)
    print(f"write {difference.index + 1} differs: recorded {recorded}; here {here}")
    if difference.program:
        print(f"written at {image.names.place(difference.program - 1)}")


def replay(
    *,
    file: ImageArgument,
    recording_file: Annotated[Path, typer.Argument(metavar="RECORDING", help="What `image record` has written.")],
    rom: RomOption = None,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
) -> None:
    """Give an image the inputs of a recorded run, and compare what it has the gates do, bit for bit.

    Compared is every write to the timers of the gates' pulses (ePWM). Exit status 4 when one differs: the first is
    named by step, register and source line; 1 when the recording has nothing to compare.
    """
    image, recording = opened.read(file, rom), recordings.load(recording_file)
    board = opened.power_on(image, profile_name, motor, seed)
    with opened.closing(board, image):
        recordings.play(board, recording.seconds, recording.octets, recording)
        difference = recordings.compare(recording, board)
        steps, writes = len(board.recorded()[0]), len(board.recorded()[1])
        opened.say(board, image)
    if difference:
        _say(difference, image)
        raise typer.Exit(ExitCode.DIFFERS)
    if not any(step < len(recording.samples) for step, *_ in recording.writes):
        print(
            f"{file.name}: nothing was compared: {recording.made_by} took "
            f"{counted(len(recording.samples), 'sample')} of the converter and wrote nothing to the ePWM before the "
            "last; record for longer (--for)"
        )
        raise typer.Exit(ExitCode.SHORT)
    print(
        f"{file.name}: the same {counted(min(writes, len(recording.writes)), 'write')} to the ePWM as "
        f"{recording.made_by} in {counted(min(steps, len(recording.samples)), 'step')}"
    )
