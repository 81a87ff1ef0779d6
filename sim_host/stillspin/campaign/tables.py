"""What the schemas of spread and fault files are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stillspin.errors import InputError
from stillspin.json_schema import Json

TEXT: Json = {"type": "string"}
NUMBER: Json = {"type": "number"}
NAME: Json = {"type": "string", "pattern": "^[a-z0-9_]+$", "words": "lower case letters, digits and '_'"}


def table(keys: Mapping[str, Json], *required: str) -> Json:
    """A table that has these keys and no others."""
    return {"type": "object", "additionalProperties": False, "properties": dict(keys), "required": list(required)}


def rows(item: Json) -> Json:
    """An array of tables with at least one."""
    return {"type": "array", "items": item, "minItems": 1}


def pair(number: Json) -> Json:
    """Two numbers."""
    return {"type": "array", "items": [number, number], "minItems": 2, "maxItems": 2, "words": "[from, to]"}


def unique(names: Sequence[str], where: str) -> None:
    """Complain when a name stands twice.

    Raises:
        InputError: it does.
    """
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{where}: the name '{name}' is used twice")
