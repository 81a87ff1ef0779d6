"""Signals that are computed from what the drive streams; each says its formula.

They are as good as their parts: samples of one control interrupt, 50 a second, with the parameters in force.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from stillspin.counted import counted
from stillspin.drive.table import Table
from stillspin.errors import InputError

Values = Mapping[str, float]
MOST = 8
"""Signals of the drive in one stream."""


@dataclass(frozen=True)
class Derived:
    """A signal that the drive does not have."""

    name: str
    unit: str
    needs: tuple[str, ...]
    """Signals of the drive."""
    parameters: tuple[str, ...]
    meaning: str
    value: Callable[[Values, Values], float]
    """Of signals and parameters, in their units."""


def _phase_c(signals: Values, _: Values) -> float:
    return -signals["current_a"] - signals["current_b"]


def _torque(signals: Values, parameters: Values) -> float:
    if signals["speed_known"] == 0:  # the currents are those of a frame that need not be the rotor's, as in a start
        return math.nan
    saliency = (parameters["inductance_d"] - parameters["inductance_q"]) * 1e-3
    flux = parameters["magnet_flux"] + saliency * signals["current_d"]
    return 1.5 * parameters["pole_pairs"] * flux * signals["current_q"]


def _power(signals: Values, _: Values) -> float:
    return 1.5 * (signals["voltage_d"] * signals["current_d"] + signals["voltage_q"] * signals["current_q"])


def _share(signals: Values, parameters: Values) -> float:
    return 100 * math.hypot(signals["current_d"], signals["current_q"]) / parameters["current_limit"]


_DQ = ("current_d", "current_q")
_TORQUE = ("pole_pairs", "inductance_d", "inductance_q", "magnet_flux")
DERIVED = {
    entry.name: entry
    for entry in (
        Derived(
            "current_c",
            "A",
            ("current_a", "current_b"),
            (),
            "current of phase c, -(current_a + current_b); above 25 Hz too few samples to show its wave: use the scope",
            _phase_c,
        ),
        Derived(
            "torque",
            "Nm",
            (*_DQ, "speed_known"),
            _TORQUE,
            "torque of the magnet and the saliency: 1.5 p (magnet_flux + (L_d - L_q) i_d) i_q, saturation not counted; "
            "empty while the rotor's angle is unknown",
            _torque,
        ),
        Derived(
            "power",
            "W",
            (*_DQ, "voltage_d", "voltage_q"),
            (),
            "electrical power into the motor: 1.5 (v_d i_d + v_q i_q), with the commanded voltage",
            _power,
        ),
        Derived(
            "current_share",
            "%",
            _DQ,
            ("current_limit",),
            "share of current_limit that flows: sqrt(i_d^2 + i_q^2) / current_limit",
            _share,
        ),
    )
}


def available(table: Table) -> list[Derived]:
    """Those that can be computed from what a drive has."""
    signals = {signal.name for signal in table.signals}
    return [
        entry
        for entry in DERIVED.values()
        if signals.issuperset(entry.needs) and all(table.has_parameter(name) for name in entry.parameters)
        if entry.name not in signals
    ]


class Choice:
    """What is plotted, of the drive's signals and the derived ones."""

    def __init__(self, names: list[str], table: Table) -> None:
        """Take the names.

        Raises:
            InputError: no such signal, or more signals of the drive than it streams at once.
        """
        own = {entry.name: entry for entry in available(table)}
        self.names = list(dict.fromkeys(names))
        self._derived = {name: own[name] for name in self.names if name in own}
        plain = [name for name in self.names if name not in self._derived]
        units = {signal.name: signal.unit for signal in table.chosen(plain)}
        self.units = {name: units[name] if name in units else own[name].unit for name in self.names}
        needed = [need for entry in self._derived.values() for need in entry.needs]
        self.streamed = list(dict.fromkeys([*plain, *needed]))
        if not 1 <= len(self.streamed) <= MOST:
            raise InputError(
                f"these need {counted(len(self.streamed), 'signal')} of the drive ({', '.join(self.streamed)}); "
                f"1 … {MOST} can be plotted at once"
            )

    @property
    def parameters(self) -> list[str]:
        """Names of the parameters that are needed."""
        return list(dict.fromkeys(name for entry in self._derived.values() for name in entry.parameters))

    def row(self, streamed: tuple[float, ...], parameters: Values) -> list[float]:
        """The values of `names`; NaN where one of its parts is unknown."""
        signals = dict(zip(self.streamed, streamed, strict=True))
        own = self._derived
        return [own[name].value(signals, parameters) if name in own else signals[name] for name in self.names]
