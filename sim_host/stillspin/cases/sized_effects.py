"""A profile's effects on a motor of another size: what was stated for the reference's board, as shares of it."""

from __future__ import annotations

import math
from collections.abc import Mapping

from stillspin import core
from stillspin import scales as boards
from stillspin.cases import similarity
from stillspin.entry import Entry, Value

_LIKE = {"F": "A/V"}  # units of the plant that the drive has none of


def of_size(stated: core.Plant, machine: core.Plant, scales: Mapping[str, float], schema: core.Schema) -> core.Plant:
    """What a profile made for the reference's board adds to another machine on its own, within the plant's ranges.

    Volts and amperes are taken in units of the board's size, as the drive's formats have them, and a torque by the
    machine's own: a switch that drops 1 V on 300 V drops 60 mV on 12 V.

    Args:
        stated: by the profile.
        machine: what the motor's file states.
        scales: of the drive on this board.
        schema: what the plant can be told.
    """
    size, pair = similarity.of(machine), boards.of(scales)
    torque = similarity.power_of_two(size.torque / similarity.REFERENCE.torque) if size else 1.0

    def sized(entry: Entry, value: Value) -> Value:
        factor = torque if entry.unit == "Nm" else 2.0 ** boards.exponent(_LIKE.get(entry.unit, entry.unit), pair)
        if factor == 1.0 or isinstance(value, str):
            return value
        return min(max(value * factor, entry.minimum or 0.0), entry.maximum or math.inf)

    return {
        section: {key: sized(schema[section][key], value) for key, value in keys.items()}
        for section, keys in stated.items()
    }
