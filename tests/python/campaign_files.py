"""Spreads that the tests of campaigns draw from, and how they are written."""

from stillspin import core

HARMLESS = """
[[departures]]
name = "warm"
unit = "K"
uniform = [-20.0, 40.0]
factor = { machine = { resistance = 0.0039, magnet_flux = -0.0011 } }

[[departures]]
name = "gain"
unit = "%"
normal = 0.3
add = { sensor = { gain_a = 0.01 } }

[[departures]]
name = "angle"
unit = "°"
uniform = [0.0, 360.0]
add = { initial = { angle = 0.017453292519943295 } }
"""
HEAVY = """
[[departures]]
name = "heavy"
unit = "% of rated"
uniform = [0.0, 110.0]
load = 0.01
"""
"""Beyond what the current limit holds for most of it: the shaft cannot follow, and stalls."""


def schema():
    return core.plant_schema(core.load())


def written(folder, text, name="mine.toml"):
    (folder / name).write_text(text)
    return str(folder / name)
