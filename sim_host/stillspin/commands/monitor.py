"""`stillspin monitor`: signals as lines in the terminal, live; as a table of numbers where nobody looks."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Annotated

import typer
from rich.console import Console, Group
from rich.live import Live
from rich.text import Text

from stillspin import csv_table
from stillspin.commands import braille
from stillspin.commands.connection import DriveOption, opened
from stillspin.counted import counted
from stillspin.drive import Drive, Sample, Status, Stream
from stillspin.options import DurationOption, number

_DEFAULT = ["speed", "speed_reference", "current_d", "current_q"]
_COLOURS = ["cyan", "dark_orange", "green", "magenta", "blue", "yellow", "red", "white"]
_LABEL = 11
_REFRESH = 0.1
_STATUS = 0.5
_MOST = 4000


def monitor(
    *,
    signals: Annotated[
        list[str] | None, typer.Argument(metavar="[SIGNAL]...", help="Up to 8 [default: speeds and currents].")
    ] = None,
    where: DriveOption = "",
    period: Annotated[
        float,
        typer.Option(
            "--period", parser=number("--period", 0, unit="ms"), metavar="MS", help="Milliseconds between samples."
        ),
    ] = 20.0,
    duration: DurationOption = 0.0,
) -> None:
    """Show signals live, until Ctrl-C."""
    screen = Console()
    with opened(where) as drive, drive.stream(signals or _DEFAULT, period / 1e3) as stream:
        end = time.monotonic() + duration if duration else math.inf  # the drive's table may have taken its time
        try:
            if screen.is_terminal:
                _draw(drive, stream, screen, end)
            else:
                _list(drive, stream, end)
        except KeyboardInterrupt:
            if duration:  # without, it is the end
                raise
        lost = stream.why_lost()
    if lost:
        screen.print(lost)


def _samples(stream: Stream, end: float) -> Iterator[Sample | None]:
    while time.monotonic() < end:
        yield stream.next(_REFRESH)


def _list(drive: Drive, stream: Stream, end: float) -> None:
    print(csv_table.head({"firmware": drive.identity.text}), end="")
    print("time [s]", *(csv_table.heading(signal.name, signal.unit) for signal in stream.signals), sep="\t")
    for sample in _samples(stream, end):
        if sample:
            print(f"{sample.time:.3f}", *(f"{value:.6g}" for value in sample.values), sep="\t", flush=True)


@dataclass
class _Panel:
    unit: str
    numbers: list[int]
    """Of the signals that share the unit."""
    values: list[deque[float]] = field(default_factory=list)


def _draw(drive: Drive, stream: Stream, screen: Console, end: float) -> None:
    units = list(dict.fromkeys(signal.unit for signal in stream.signals))
    panels = [_Panel(unit, [at for at, s in enumerate(stream.signals) if s.unit == unit]) for unit in units]
    for panel in panels:
        panel.values = [deque(maxlen=_MOST) for _ in panel.numbers]
    status, asked, drawn = drive.status(), time.monotonic(), 0.0
    with Live(console=screen, auto_refresh=False, screen=True) as live:
        for sample in _samples(stream, end):
            if sample:
                for panel in panels:
                    for values, number in zip(panel.values, panel.numbers, strict=True):
                        values.append(sample.values[number])
            now = time.monotonic()
            if now - asked > _STATUS:
                status, asked = drive.status(), now
            if now - drawn > _REFRESH:
                drawn = now
                live.update(_picture(panels, stream, status, screen), refresh=True)


def _picture(panels: list[_Panel], stream: Stream, status: Status, screen: Console) -> Group:
    width = max(20, screen.width - _LABEL - 1)
    head = [_headline(status, stream.lost)]
    if status.remedy:
        head.append(Text(status.remedy, style="red"))
    height = max(3, (screen.height - 1 - len(head)) // max(1, len(panels)) - 2)
    parts = list(head)
    for panel in panels:
        parts += _panel(panel, stream, width, height)
    return Group(*parts)


def _headline(status: Status, lost: int) -> Text:
    line = Text(f"{status.state}  {status.speed_text}", style="bold")
    if status.fault:
        line.append(f"  {status.fault}", style="bold red")
    if status.limits:
        line.append(f"  limited by {', '.join(status.limits)}", style="yellow")
    if lost:
        line.append(f"  {counted(lost, 'sample')} lost", style="red")
    return line


def _value(value: float, unit: str) -> str:
    return "unknown" if math.isnan(value) else f"{value:.4g} {unit}"


def _panel(panel: _Panel, stream: Stream, width: int, height: int) -> list[Text]:
    shown = [list(values)[-2 * width :] for values in panel.values]
    known = [value for values in shown for value in values if not math.isnan(value)]
    low, high = braille.nice_range(min(known), max(known)) if known else (-1.0, 1.0)
    title = Text(" " * _LABEL)
    for values, place in zip(shown, panel.numbers, strict=True):
        signal = stream.signals[place]
        value = _value(values[-1], signal.unit) if values else ""
        title.append(f" {signal.name} {value} ", style=_COLOURS[place % len(_COLOURS)])
    lines = [title]
    for index, row in enumerate(braille.plot(shown, low, high, width, height)):
        label = {0: f"{high:.5g}", height - 1: f"{low:.5g}"}.get(index, "")
        line = Text(f"{label:>{_LABEL}} ", style="dim")
        for character, owner in row:
            style = _COLOURS[panel.numbers[owner] % len(_COLOURS)] if owner >= 0 else ""
            line.append(character, style=style)
        lines.append(line)
    return lines
