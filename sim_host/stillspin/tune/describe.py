"""What does not change while a drive is connected: its table, for a page that has just been opened."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from stillspin.drive import scope
from stillspin.drive.table import Parameter, Signal
from stillspin.tune import choices, derived
from stillspin.tune.derived import Derived
from stillspin.tune.groups import group_of
from stillspin.tune.messages import Message, shown_unit

if TYPE_CHECKING:
    from stillspin.tune.workbench import Workbench


def describe(bench: Workbench) -> Message:
    """Everything that does not change: the drive's table, for a page that has just been opened."""
    table = bench.drive.table
    return {
        "t": "hello",
        "version": bench.drive.version,
        "crc": table.crc,
        "where": bench.drive.link.transport.name,
        "parameters": [_parameter(entry) for entry in table.parameters],
        "signals": [_signal(entry) for entry in table.signals],
        "derived": [_signal(entry) for entry in derived.available(table)],
        "words": choices.of_signals(bench.drive),
        "values": bench.drive.parameters(),
        "plotted": bench.plotted,
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
