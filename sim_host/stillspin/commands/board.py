"""`stillspin board`: the virtual drive on the desk."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from stillspin import core, resources
from stillspin.board import power, serve
from stillspin.cases import profile
from stillspin.drive import state
from stillspin.errors import InputError
from stillspin.image import opened
from stillspin.image.gdb import Remote
from stillspin.options import (
    NEEDS_IMAGE,
    ChangeOption,
    MotorOption,
    PaceOption,
    ParamsOption,
    ProfileOption,
    RomOption,
    SchemeOption,
    SeedOption,
    SerialLinkOption,
    number,
    whole,
)
from stillspin.runs import commission, variant


def board(
    *,
    profile_name: ProfileOption = "bench",
    motor: MotorOption = resources.DEFAULT_MOTOR,
    seed: SeedOption = 1,
    change: ChangeOption = None,
    params: ParamsOption = None,
    scheme: SchemeOption = None,
    speed: PaceOption = 1.0,
    serial_link: SerialLinkOption = None,
    can_link: Annotated[
        Path | None,
        typer.Option(
            "--can-link", metavar="PATH", help="Symbolic link to the SLCAN adapter: a name that stays the same."
        ),
    ] = None,
    socketcan: Annotated[
        str | None,
        typer.Option(
            "--socketcan", metavar="NAME", help="A CAN interface of the kernel, instead of the SLCAN adapter."
        ),
    ] = None,
    eeprom: Annotated[
        Path | None,
        typer.Option("--eeprom", metavar="FILE", help="Keeps what the drive saves from one start to the next."),
    ] = None,
    load: Annotated[
        float,
        typer.Option("--load", parser=number("--load", unit="Nm"), metavar="NM", help="Load torque on the shaft."),
    ] = 0.0,
    end: Annotated[
        float | None,
        typer.Option(
            "--for",
            parser=number("--for", 0, unit="s"),
            metavar="SECONDS",
            help="Switch off after so many seconds of the board's time.",
        ),
    ] = None,
    image: Annotated[
        Path | None,
        typer.Option(
            "--image",
            metavar="FILE",
            help="Execute this machine code of the C28x instead of the firmware: an .out file of cl2000 (COFF or "
            "ELF), Intel hex or a boot stream.",
        ),
    ] = None,
    rom: RomOption = None,
    gdb: Annotated[
        int | None,
        typer.Option(
            "--gdb",
            parser=whole("--gdb", 0, 65535),
            metavar="PORT",
            help="Let a debugger in at this port of this computer, 0 for any; the program of --image waits for it.",
        ),
    ] = None,
    parent: Annotated[
        int | None, typer.Option("--parent", metavar="PID", help="Switch off when this process, its parent, is gone.")
    ] = None,
) -> None:
    """Run a virtual board in real time; its serial port is a pseudo-terminal. Ctrl-C switches it off."""
    if image and (params or change or scheme):
        raise InputError("--image: only --profile, --motor and --seed go with it; the program has its own parameters")
    if rom and not image:
        raise InputError(NEEDS_IMAGE)
    if gdb is not None and not image:
        raise InputError("--gdb: goes with --image FILE alone; the firmware on this computer has gdb itself")
    native = core.load()
    schema, known = core.plant_schema(native), core.parameters(native)
    chosen = profile.load(profile_name, schema, known, motor)
    profile.say_not_stated(chosen)
    changes = profile.changes(change or [], schema, known, chosen.parameters)
    if params:
        chosen = replace(chosen, parameters={**chosen.parameters, **commission.load(params, known, chosen.parameters)})
        changes.words.append(f"--params {params.name}")
    if scheme:
        chosen = variant.scheme(scheme).told(chosen, known)
        changes.words.append(f"--scheme {scheme}")
    title = f"motor {chosen.motor}, profile {chosen.name}, seed {seed}" + "".join(
        f", {words}" for words in changes.words
    )
    if image:
        title += f", executes {image.name}"
    program = opened.read(image, rom) if image else None
    if program:
        powered = opened.power_with(native, program, chosen, seed)
    else:
        powered = power.power(native, chosen, changes, seed)
    debugger = Remote(powered, program.names, gdb) if program and gdb is not None else None
    title += f", gdb: target remote localhost:{debugger.port}" if debugger else ""
    remarks = partial(opened.warnings, image=program) if program else None
    placed = partial(opened.placed, image=program) if program else None
    options = serve.Options(
        state.WORDS, speed, serial_link, can_link, socketcan, load, end, eeprom, parent, debugger, remarks, placed
    )
    try:
        serve.serve(powered, options, title)
    finally:
        if debugger:
            debugger.close()
