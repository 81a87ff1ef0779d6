"""Spread and fault files: how they are read, and what their schemas are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from stillspin import json_schema, resources, toml_table
from stillspin.errors import InputError
from stillspin.json_schema import Json

TEXT: Json = {"type": "string"}
NUMBER: Json = {"type": "number"}
NAME: Json = {"type": "string", "pattern": "^[a-z0-9_]+$", "words": "lower case letters, digits and '_'"}


def read(folder: str, name_or_path: str, schema: Json) -> tuple[Path, Json]:
    """What ships under a name, or is in a file, held against its schema.

    Raises:
        InputError: there is none, or the file is wrong.
    """
    path = resources.find(folder, name_or_path)
    data = toml_table.read(path).items()
    json_schema.check(data, schema, str(path))
    return path, data


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
