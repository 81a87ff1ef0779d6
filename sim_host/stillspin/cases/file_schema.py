"""JSON schema of motor and profile files, for editors; made of the declarations that the loader checks them by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stillspin import core

Json = dict[str, Any]
DIALECT = "https://json-schema.org/draft/2020-12/schema"
KINDS = ("motor", "profile")


def schema(kind: str, plant: core.Schema, parameters: Mapping[str, core.Entry]) -> Json:
    """The schema of a kind of file, one of KINDS; both have the same sections and keys."""
    sections = {name: _table({key: _entry(entry) for key, entry in keys.items()}) for name, keys in plant.items()}
    named = _table({name: _entry(entry) for name, entry in parameters.items()})
    named["description"] = "Parameters of the drive; they go before what follows from the other sections."
    about = {
        "description": {"type": "string"},
        "commission": {"type": "boolean", "description": "A campaign lets the drive measure itself first."},
    }
    head = {"$schema": DIALECT, "title": f"stillspin {kind} file"}
    return {**head, **_table({**about, **sections, "parameters": named})}


def _table(keys: Mapping[str, Json]) -> Json:
    return {"type": "object", "additionalProperties": False, "properties": dict(keys)}


def _entry(entry: core.Entry) -> Json:
    """One value; its unit stands in the description, as editors show it."""
    words: Json = {"description": f"{entry.help} [{entry.unit}]" if entry.unit else entry.help}
    if isinstance(entry.default, bool):
        return {**words, "type": "boolean"}
    if isinstance(entry.default, str):
        return {**words, "type": "string", **({"enum": list(entry.choices)} if entry.choices else {})}
    number: Json = {"type": "integer" if entry.whole else "number"}  # an integer of JSON may be written 2.0
    number |= {
        key: bound for key, bound in (("minimum", entry.minimum), ("maximum", entry.maximum)) if bound is not None
    }
    others: list[Json] = [{"enum": list(entry.choices)}] if entry.choices else []
    others += [{"type": "boolean"}] if entry.access else []  # a parameter takes true for 1
    return {**words, "anyOf": [number, *others]} if others else {**words, **number}
