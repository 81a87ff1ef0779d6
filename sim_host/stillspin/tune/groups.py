"""Headings for the parameters: their numbers are given out in blocks, and a number never changes."""

from __future__ import annotations

_BLOCKS = [
    (range(1, 20), "Machine"),
    (range(20, 40), "Inverter"),
    (range(40, 60), "Modulation and sampling"),
    (range(60, 80), "Position and speed"),
    (range(80, 100), "Control"),
    (range(100, 110), "Start"),
    (range(110, 130), "Saturation"),
    (range(130, 150), "Commissioning"),
    (range(150, 160), "Start"),
    (range(160, 170), "Supervision"),
    (range(170, 180), "Encoder and hysteresis"),
    (range(200, 220), "Serial port"),
    (range(220, 240), "CAN"),
    (range(240, 260), "Store and scope"),
    (range(520, 521), "Machine"),
    (range(521, 530), "Supervision"),
]


def group_of(number: int) -> str:
    """The heading for a parameter's number."""
    return next((title for block, title in _BLOCKS if number in block), "Others")
