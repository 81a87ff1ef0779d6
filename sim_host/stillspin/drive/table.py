"""The drive's own table of parameters and signals: names, units, formats, ranges, as it tells them itself."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from stillspin import core, scales
from stillspin.drive.protocol import StatusCode
from stillspin.errors import InputError, StillspinError, did_you_mean
from stillspin.link.errors import RefusedError
from stillspin.quantity import Range

TURN = "turn"
"""Unit of the signals that are binary angles."""
KNOWN_ROTOR, KNOWN_FRAME, KNOWN_HEAT_SINK = 1, 2, 4
"""What a drive knows: the rotor's angle and speed; the currents in the frame that its control uses; its temperature."""
KNOWN_ALL = KNOWN_ROTOR | KNOWN_FRAME | KNOWN_HEAT_SINK


@dataclass(frozen=True)
class Parameter:
    """A parameter as the drive describes it. Raw values have `q` fractional bits."""

    index: int
    id: int
    name: str
    unit: str
    q: int
    decimals: int
    always: bool
    """Whether it may be changed while the motor is energised."""
    flags: int
    minimum_raw: int
    maximum_raw: int
    initial_raw: int
    meaning: str

    @property
    def minimum(self) -> float:
        """Smallest value, in `unit`."""
        return self.to_user(self.minimum_raw)

    @property
    def maximum(self) -> float:
        """Largest value, in `unit`."""
        return self.to_user(self.maximum_raw)

    @property
    def initial(self) -> float:
        """Default, in `unit`."""
        return self.to_user(self.initial_raw)

    @property
    def range(self) -> Range:
        """What it may be. What has no fractional bits is whole."""
        return Range(self.minimum, self.maximum, self.unit, self.q == 0, self.decimals)

    @property
    def range_text(self) -> str:
        """Range and unit, for people."""
        return str(self.range)

    def to_user(self, raw: int) -> float:
        """The value in `unit`: the shortest number, of the table's decimals or more, that is this raw value again."""
        exact = raw / (1 << self.q)
        decimals = self.decimals
        while self._raw(round(exact, decimals)) != raw:
            decimals += 1
        return round(exact, decimals)

    def _raw(self, number: float) -> int:
        return math.floor(number * (1 << self.q) + 0.5)

    def text(self, raw: int) -> str:
        """The value with its unit, for people."""
        return f"{self._number(raw)} {self.unit}".rstrip()

    def _number(self, raw: int) -> str:
        return f"{raw / (1 << self.q):.{self.decimals}f}"

    def to_raw(self, value: float | str) -> int:
        """The raw value of a value in `unit`; text may have the unit behind the number.

        Raises:
            InputError: no number, another unit, out of range, or a fraction of what is whole; in words.
        """
        return self._raw(self.range.read(value, self.name))

    def moved(self, steps: scales.Pair) -> Parameter:
        """The same in a drive whose scales are so much larger."""
        up = scales.exponent(self.unit, steps)
        return replace(self, q=self.q - up, decimals=scales.decimals(self.decimals, up))


@dataclass(frozen=True)
class Signal:
    """A signal as the drive describes it: one value per control interrupt, `q` fractional bits."""

    index: int
    name: str
    unit: str
    q: int
    needs: int
    """Bits of KNOWN_ALL that must be there, or it says nothing."""
    meaning: str

    def to_user(self, raw: int, known: int = KNOWN_ALL) -> float:
        """The value in `unit`; angles are −0.5 … 0.5 turn. NaN where what it needs is not among the bits of `known`."""
        return math.nan if self.needs & ~known else float(raw / (1 << self.q))

    def to_raw(self, value: float | str) -> int:
        """The raw value next to `value`; text may have the unit behind the number.

        Raises:
            InputError: no number, a fraction of what counts or stands for something, or it does not fit into 32 bits.
        """
        least, step = -(2.0 ** (31 - self.q)), 2.0**-self.q
        whole = self.q == 0 and not self.unit
        held = Range(least, -least - step, self.unit, whole, decimals=0, set_by="all that the signal holds")
        return round(held.read(value, self.name) * (1 << self.q))


@dataclass(frozen=True)
class Table:
    """All parameters and signals of one firmware."""

    version: str
    crc: int
    """Of everything below, as the drive reckons it: the same number, the same table."""
    faults: int
    """Causes of faults that the drive knows."""
    parameters: tuple[Parameter, ...]
    signals: tuple[Signal, ...] = field(default=())
    edition: str = field(default="", compare=False)
    """What is in the firmware; empty where it does not say."""

    @cached_property
    def _parameters(self) -> dict[str, Parameter]:
        return {parameter.name: parameter for parameter in self.parameters}

    @cached_property
    def _signals(self) -> dict[str, Signal]:
        return {signal.name: signal for signal in self.signals}

    def parameter(self, name: str) -> Parameter:
        """The parameter of that name.

        Raises:
            InputError: there is none; names what is near.
            RefusedError: another edition of the firmware has it.
        """
        if name not in self._parameters:
            raise self._missing("parameter", name, self._parameters)
        return self._parameters[name]

    def has_parameter(self, name: str) -> bool:
        """Whether the drive has a parameter of that name."""
        return name in self._parameters

    def signal(self, name: str) -> Signal:
        """The signal of that name.

        Raises:
            InputError: there is none; names what is near.
            RefusedError: another edition of the firmware has it.
        """
        if name not in self._signals:
            raise self._missing("signal", name, self._signals)
        return self._signals[name]

    def _missing(self, kind: str, name: str, known: Iterable[str]) -> StillspinError:
        if self.edition not in ("", core.LAB) and name in core.known_names():
            words = f"{kind} '{name}' is not in this edition of the firmware, {self.edition}"
            return RefusedError(f"{words}: see 'Editions' in the book", StatusCode.EDITION)
        return InputError(f"no {kind} '{name}'{did_you_mean(name, known)}")

    def with_scales(self, now: Mapping[str, float], then: Mapping[str, float]) -> Table:
        """Formats and ranges of the parameters when the scales among the values `now` become those of `then`."""
        before, behind = scales.of(now), scales.of({**now, **then})
        if before == behind:
            return self
        steps = behind[0] - before[0], behind[1] - before[1]
        return replace(self, parameters=tuple(each.moved(steps) for each in self.parameters))

    def chosen(self, names: Iterable[str]) -> list[Signal]:
        """The signals of these names, in their order."""
        return [self.signal(name) for name in names]
