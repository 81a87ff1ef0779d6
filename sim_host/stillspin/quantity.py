"""Numbers as people type them, read by one rule everywhere: digits, one point, an exponent; no comma, no space.

What is whole stays whole: 2.5 pole pairs are refused, 2.0 and 1e1 are whole numbers. The unit may stand behind a number
where it is the right one. Of a switch, and of nothing else, files and programs may say true for 1 and false for 0.
Every complaint names the value as it was typed, the range that holds, and what sets it.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from stillspin.errors import InputError

_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(?![0-9.,])\s*((?![0-9\s]).*?)\s*")
_PARTED = re.compile(r"\s*[+-]?[0-9.]*[, ][0-9., ]*[0-9].*")


@dataclass(frozen=True)
class Range:
    """What a number may be.

    Attributes:
        low: smallest and high: largest value, None where there is no bound.
        unit: that may stand behind it.
        whole: no fraction.
        decimals: to show of the bounds, None for as many as they have.
        set_by: what sets the range where it is not fixed, such as the name of a parameter.
    """

    low: float | None = None
    high: float | None = None
    unit: str = ""
    whole: bool = False
    decimals: int | None = None
    set_by: str = ""

    def __str__(self) -> str:
        """For people, such as "0.50 … 16.00 A (trip_current)"."""
        low = "-∞" if self.low is None else self._shown(self.low)
        high = "∞" if self.high is None else self._shown(self.high)
        source = f" ({self.set_by})" if self.set_by else ""
        return f"{low} … {high} {self.unit}".rstrip() + source

    def _shown(self, bound: float) -> str:
        return shown(bound) if self.decimals is None else f"{bound:.{self.decimals}f}"

    @property
    def is_switch(self) -> bool:
        """Whether it is 0 or 1, for which a file and a program may say false or true."""
        return self.whole and (self.low, self.high) == (0, 1)

    def read(self, typed: object, name: str) -> float:
        """The number that somebody typed, or that a program gives, in `unit`.

        Args:
            typed: text, or a number.
            name: of what it is for, for the complaint.

        Raises:
            InputError: no number, another unit, out of range, or a fraction of what is whole.
        """
        if isinstance(typed, str):
            number, unit = self._split(typed, name)
            words = typed.strip() if unit else f"{typed.strip()} {self.unit}".rstrip()
        else:
            number, words = self._given(typed, name), f"{shown(typed)} {self.unit}".rstrip()
        if not math.isfinite(number):
            raise InputError(f"{name}: {words} is no number; {self}")
        if self.whole and not number.is_integer():
            raise InputError(f"{name}: {words} is not a whole number; {self}")
        if (self.low is not None and number < self.low) or (self.high is not None and number > self.high):
            raise InputError(f"{name}: {words} is out of range; {self}")
        return number

    def read_whole(self, typed: object, name: str) -> int:
        """The same of a range of whole numbers."""
        return int(self.read(typed, name))

    def _split(self, typed: str, name: str) -> tuple[float, str]:
        match = _NUMBER.fullmatch(typed)
        if not match:
            why = ": no comma or space within it, decimals come after a point" if _PARTED.fullmatch(typed) else ""
            raise InputError(f"{name}: '{typed.strip()}' is no number{why}; {self}")
        number, unit = match.groups()
        if unit and unit.casefold() != self.unit.casefold():  # as at the console
            wanted = f"is in {self.unit}" if self.unit else "has no unit"
            raise InputError(f"{name} {wanted}, not in {unit}: '{typed.strip()}'; {self}")
        return float(number), unit

    def _given(self, value: object, name: str) -> float:
        if not isinstance(value, int | float) or (isinstance(value, bool) and not self.is_switch):
            raise InputError(f"{name}: {value!r} is no number; {self}")
        return float(value)


ANY = Range()
COUNT = Range(1, whole=True)


def shown(value: object) -> str:
    """A number with all its digits, without a fraction where it has none."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return str(value)
