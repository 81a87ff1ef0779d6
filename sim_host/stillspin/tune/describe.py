"""What does not change while a drive is connected: its table, for a page that has just been opened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stillspin.drive import Drive, scope
from stillspin.drive.table import Parameter, Signal
from stillspin.tune import choices, derived
from stillspin.tune.derived import Derived
from stillspin.tune.groups import group_of
from stillspin.tune.messages import Message, shown_unit


def describe(drive: Drive, plotted: Sequence[str]) -> Message:
    """Everything that does not change: the drive's table, for a page that has just been opened.

    Args:
        drive: that is connected.
        plotted: names of the signals that are streamed.
    """
    table = drive.table
    return {
        "t": "hello",
        "version": drive.version,
        "edition": drive.identity.edition,
        "left_out": drive.left_out,
        "crc": table.crc,
        "where": drive.link.transport.name,
        "parameters": [_parameter(entry) for entry in table.parameters],
        "signals": [_signal(entry) for entry in table.signals],
        "derived": [_signal(entry) for entry in derived.available(table)],
        "words": choices.of_signals(drive),
        "values": drive.parameters(),
        "plotted": list(plotted),
        "edges": list(scope.EDGES),
        "depth": scope.DEPTH,
    }


def _signal(entry: Signal | Derived) -> Message:
    return {"name": entry.name, "unit": shown_unit(entry.unit), "meaning": entry.meaning}


def _parameter(entry: Parameter) -> Message:
    return {
        "name": entry.name,
        "id": entry.id,
        "group": group_of(entry.id),
        "unit": shown_unit(entry.unit),
        "choices": choices.of_parameter(entry),
        "decimals": entry.decimals,
        "minimum": entry.minimum,
        "maximum": entry.maximum,
        "initial": entry.initial,
        "always": entry.always,
        "meaning": entry.meaning,
        "range": str(replace(entry.range, unit=shown_unit(entry.unit))),
    }
