"""Holds what a file says against a JSON schema, and tells in one line what is wrong: place, value, what is allowed."""

from __future__ import annotations

import functools
import math
from typing import Any

from stillspin import extras
from stillspin.errors import InputError, did_you_mean
from stillspin.quantity import Range

Json = dict[str, Any]
DIALECT = "http://json-schema.org/draft-07/schema#"
"""The one that every editor knows."""


def check(data: object, schema: Json, where: str) -> None:
    """Complain about the first thing that the schema does not allow.

    Args:
        data: as TOML or JSON has it.
        schema: of it. Two keywords are of this house: `unit` is said with a number's bounds, `words` instead of them.
        where: what to call it in the complaint, such as the file.

    Raises:
        InputError: the data does not fit.
    """
    error = next(_validators()(schema).iter_errors(data), None)
    if error is not None:
        place = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in error.absolute_path)
        raise _complaint(error, ": ".join(filter(None, (where, place.lstrip(".")))))


@functools.cache
def _validators() -> Any:
    validators = extras.need("jsonschema.validators")
    types = validators.Draft7Validator.TYPE_CHECKER.redefine("number", _is_number)
    return validators.extend(validators.Draft7Validator, type_checker=types)


def _is_number(_checker: object, value: object) -> bool:
    """JSON has no infinity, and TOML has."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _complaint(error: Any, here: str) -> InputError:
    value, schema = error.instance, error.schema
    if error.validator == "required":
        missing = next(key for key in error.validator_value if key not in value)
        return InputError(f"{here}: '{missing}' is missing")
    if error.validator == "additionalProperties":
        known = schema.get("properties", {})
        unknown = next(key for key in value if key not in known)
        return InputError(f"{here}: unknown key '{unknown}'{did_you_mean(unknown, known)}")
    number = number_range(schema)
    if number is not None and isinstance(value, int | float) and not isinstance(value, bool):
        try:
            number.read(value, here)
        except InputError as words:
            return words
    choices = _choices(schema)
    if choices and isinstance(value, str):
        return InputError(f"{here} = '{value}': not a choice{did_you_mean(value, choices)}")
    return InputError(f"{here} = {value!r}: must be {allowed(schema)}")


def _parts(schema: Json) -> list[Json]:
    return list(schema.get("anyOf", [schema]))


def number_range(schema: Json) -> Range | None:
    """The range of a number, if it may be one."""
    for part in _parts(schema):
        if part.get("type") in {"number", "integer"}:
            whole = part["type"] == "integer"
            return Range(part.get("minimum"), part.get("maximum"), part.get("unit", ""), whole)
    return None


def _choices(schema: Json) -> list[str]:
    return [choice for part in _parts(schema) for choice in part.get("enum", [])]


def allowed(schema: Json) -> str:
    """What a value may be, in words that go on behind "must be"."""
    if "words" in schema:
        return str(schema["words"])
    if "anyOf" in schema:
        return " or ".join(map(allowed, schema["anyOf"]))
    if "enum" in schema:
        return "one of " + ", ".join(map(str, schema["enum"]))
    number = number_range(schema)
    if number:
        bounds = "" if number.low is None and number.high is None else f", {number}"
        return f"{'a whole number' if number.whole else 'a number'}{bounds}"
    items = schema.get("items", {})
    if isinstance(items, list):
        return f"[{', '.join(map(allowed, items))}]"
    least = schema.get("minItems", 0)
    several = f"a list of {'at least ' + str(least) if least else 'any number'} of {allowed(items)}" if items else ""
    kind = {"boolean": "true or false", "string": "text", "object": "a table", "array": several or "a list"}
    return kind.get(schema.get("type", ""), "something else")
