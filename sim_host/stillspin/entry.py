"""One settable number, switch or word: an entry of the plant or a firmware parameter."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from stillspin import json_schema
from stillspin import scales as scales_of_boards
from stillspin.json_schema import Json
from stillspin.quantity import Range
from stillspin.scales import Pair

Value = float | int | bool | str


@dataclass(frozen=True)
class Entry:
    """What it may be. `access` is empty for an entry of the plant; a parameter's default is always a number."""

    name: str
    unit: str
    minimum: float | None
    maximum: float | None
    default: Value
    help: str
    choices: tuple[str, ...] = ()
    access: str = ""
    number: int = 0
    decimals: int = 0
    whole: bool = False
    exponent: int = 0
    """Powers of two by which its range is moved (`at_scale`)."""

    def at_scale(self, scales: Pair) -> Entry:
        """A parameter in a drive with these scales."""
        exponent = scales_of_boards.exponent(self.unit, scales)
        if exponent == self.exponent or not self.access:
            return self
        factor = 2.0 ** (exponent - self.exponent)
        minimum, maximum = (None if bound is None else bound * factor for bound in (self.minimum, self.maximum))
        return replace(self, exponent=exponent, minimum=minimum, maximum=maximum, default=float(self.default) * factor)

    def at_some_scale(self, most: int) -> Entry:
        """A parameter with all that it may be in a drive whose scales are -most to most."""
        corners = [self.at_scale((current, voltage)) for current in (-most, most) for voltage in (-most, most)]
        low = [each.minimum for each in corners if each.minimum is not None]
        high = [each.maximum for each in corners if each.maximum is not None]
        return replace(self, minimum=min(low, default=None), maximum=max(high, default=None))

    @property
    def places(self) -> int:
        """Decimals that show what `decimals` show where both scales are 0."""
        return scales_of_boards.decimals(self.decimals, self.exponent)

    @property
    def range_text(self) -> str:
        """The allowed values in words, such as "0 … 450 V"."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        if isinstance(self.default, bool):
            return "true or false"
        return str(self.range)

    @property
    def range(self) -> Range:
        """Of a number."""
        return Range(self.minimum, self.maximum, self.unit, self.whole)

    @property
    def _takes_words(self) -> bool:
        """Whether true and false stand for 1 and 0."""
        return self.access != "" and self.range.is_switch

    @cached_property
    def schema(self) -> Json:
        """The JSON schema of its value; its unit stands in the description, too, as editors show that."""
        words: Json = {"description": f"{self.help} [{self.unit}]" if self.unit else self.help}
        if isinstance(self.default, bool):
            return {**words, "type": "boolean"}
        if isinstance(self.default, str):
            return {**words, "type": "string", **({"enum": list(self.choices)} if self.choices else {})}
        number: Json = {"type": "integer" if self.whole else "number"}  # an integer of JSON may be written 2.0
        given = (("minimum", self.minimum), ("maximum", self.maximum), ("unit", self.unit or None))
        number |= {key: value for key, value in given if value is not None}
        others: list[Json] = [{"enum": list(self.choices)}] if self.choices else []
        others += [{"type": "boolean"}] if self._takes_words else []
        return {**words, "anyOf": [number, *others]} if others else {**words, **number}

    def read(self, typed: str, where: str) -> Value:
        """What somebody typed, as the type of this entry.

        Raises:
            InputError: as `check`.
        """
        if typed in self.choices or isinstance(self.default, str):
            return self.check(typed, where)
        word = {"true": True, "false": False}.get(typed.lower())
        if isinstance(self.default, bool) or (word is not None and self._takes_words):
            return self.check(typed if word is None else word, where)
        if self.choices and not typed.lstrip("+-.")[:1].isdigit():
            return self.check(typed, where)
        return self.value(self.range.read(typed, where))

    def check(self, value: object, where: str) -> Value:
        """`value` as the type of this entry.

        Args:
            value: a bool, number or text, from TOML or from a program.
            where: how to name it in a message.

        Raises:
            InputError: the schema does not allow it.
        """
        json_schema.check(value, self.schema, where)
        return self.value(value)

    def value(self, checked: object) -> Value:
        """A value that the schema allows, as the type of this entry: a choice of a parameter is its index."""
        if isinstance(self.default, bool | str):
            return self.default.__class__(checked)
        number = self.choices.index(checked) if isinstance(checked, str) else float(checked)  # type: ignore[arg-type]
        # What is whole in the plant (poles, bits) has a whole default.
        return int(number) if isinstance(self.default, int) else float(number)
