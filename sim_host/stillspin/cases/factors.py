"""Entries of the plant times something: what has grown or shrunk, whatever the profile says it is."""

from __future__ import annotations

from collections.abc import Mapping

from stillspin import core, toml_table
from stillspin.cases.profile import merged
from stillspin.errors import InputError

_ERROR = "parameter_error"

Factors = Mapping[str, Mapping[str, float]]
"""By section and entry."""


def read(stated: Mapping[str, Mapping[str, object]], schema: core.Schema, where: str) -> Factors:
    """The factors in a table `factor` of a file.

    Raises:
        InputError: an entry that the plant has not, or no number above 0.
    """
    factors: dict[str, dict[str, float]] = {}
    for section, keys in stated.items():
        core.section_known(schema, section, where)
        for key, value in keys.items():
            factor = toml_table.as_number(value)
            if key not in schema[section] or factor is None or factor <= 0.0:
                raise InputError(f"{where}: factor.{section}.{key}: must be a plant entry and a number above 0")
            factors.setdefault(section, {})[key] = factor
    return factors


def multiplied(plant: core.Plant, factors: Factors, schema: core.Schema, where: str) -> core.Plant:
    """The plant with its entries multiplied. Where it states an error of the entry, that takes the change.

    Raises:
        InputError: what comes of it is out of the entry's range.
    """

    def entry(section: str, key: str) -> float:
        return float(plant.get(section, {}).get(key, schema[section][key].default))

    result: core.Plant = merged(plant)
    for section, keys in factors.items():
        for key, factor in keys.items():
            if key in schema[_ERROR]:
                to, value = _ERROR, (1.0 + entry(_ERROR, key)) * factor - 1.0
            else:
                to, value = section, entry(section, key) * factor
            result.setdefault(to, {})[key] = core.plant_entry(schema, to, key, value, where)
    return result
