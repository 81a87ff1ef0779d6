"""`stillspin scope`: capture up to four signals at the rate of the control interrupt, write them, draw them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin.commands import capture_file
from stillspin.commands.connection import DriveOption, opened
from stillspin.counted import counted
from stillspin.drive.scope import Channel, Trigger
from stillspin.errors import InputError
from stillspin.options import number, whole
from stillspin.quantity import Range
from stillspin.report import tables


def scope(
    *,
    signals: Annotated[
        list[str], typer.Argument(metavar="SIGNAL...", help="1 to 4 signals; SIGNAL=20 sets the full scale to ±20.")
    ],
    where: DriveOption = "",
    trigger: Annotated[str, typer.Option("--trigger", "-t", help="Signal of the trigger [default: the first].")] = "",
    level: Annotated[
        str,
        typer.Option(
            "--level", "-l", metavar="NUMBER", help="Level of the trigger, in the signal's unit [default: 0]."
        ),
    ] = "",
    edge: Annotated[
        str,
        typer.Option(
            "--edge",
            "-e",
            help="rising, falling, either, above, below, or now [default: rising with an option of the trigger].",
        ),
    ] = "",
    hysteresis: Annotated[
        float | None,
        typer.Option(
            "--hysteresis",
            parser=number("--hysteresis", 0),
            metavar="NUMBER",
            help="An edge counts only from this far beyond the level [default: from the signal's span].",
        ),
    ] = None,
    decimation: Annotated[
        int,
        typer.Option(
            "--decimation",
            parser=whole("--decimation", 1, 65535),
            metavar="N",
            help="Control interrupts (100 µs) per record.",
        ),
    ] = 1,
    pretrigger: Annotated[
        float,
        typer.Option(
            "--pretrigger",
            parser=number("--pretrigger", 0, 99.9, "%"),
            metavar="PERCENT",
            help="Percent of records before the trigger.",
        ),
    ] = 25.0,
    timeout: Annotated[
        float,
        typer.Option(
            "--timeout", parser=number("--timeout", 0, unit="s"), metavar="S", help="Seconds to wait for the trigger."
        ),
    ] = 30.0,
    run: Annotated[
        float | None,
        typer.Option(
            "--run",
            parser=number("--run", unit="rpm"),
            metavar="RPM",
            help="Run the motor at this speed once the scope waits, until it is done.",
        ),
    ] = None,
    out: Annotated[
        list[Path] | None,
        typer.Option("--out", "-o", help="File to write: .parquet, .csv, .mf4, .svg, .png or .pdf. Repeatable."),
    ] = None,
) -> None:
    """Capture signals around a trigger: 512 records of up to four signals, at up to 10 kHz."""
    files = out or capture_file.usual("capture")
    for file in files:
        capture_file.check(file)
    channels = [_channel(text) for text in signals]
    given = {"--trigger": trigger != "", "--level": level != "", "--hysteresis": hysteresis is not None}
    chosen = edge or ("rising" if any(given.values()) else "now")
    if chosen == "now" and any(given.values()):
        named = ", ".join(name for name, is_given in given.items() if is_given)
        raise InputError(f"{named}: no meaning with --edge now, which waits for nothing")
    source = trigger or channels[0].signal
    with opened(where) as drive, Console(stderr=True).status("waiting for the trigger"):
        signal = drive.table.signal(source)
        wanted = Trigger(source, signal.to_user(signal.to_raw(level or 0)), chosen, hysteresis)
        capture = drive.capture(
            *channels, trigger=wanted, decimation=decimation, pretrigger=pretrigger / 100, timeout=timeout, run=run
        )
    for file in files:
        capture_file.write(file, capture)
    tables.capture(capture)
    print(
        f"{counted(capture.time.size, 'record')} every {capture.interval * 1e3:g} ms; see {', '.join(map(str, files))}"
    )


def _channel(text: str) -> Channel:
    name, equals, scale = text.partition("=")
    if not equals:
        return Channel(name)
    return Channel(name, Range(0).read(scale, f"full scale of {name}"))
