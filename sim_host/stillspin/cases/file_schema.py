"""JSON schemas of the files that say what is run: the loaders check by them, and editors where they are shipped to."""

from __future__ import annotations

from collections.abc import Mapping

from stillspin import core, resources
from stillspin.cases import vocabulary
from stillspin.cases.scenario import COMMANDS, RATIO
from stillspin.entry import Entry
from stillspin.json_schema import DIALECT, Json

KINDS = ("motor", "profile", "scenario")


def schema(kind: str, entries: core.Schema, known: Mapping[str, Entry]) -> Json:
    """The schema of a kind of file, one of KINDS.

    Args:
        kind: of file.
        entries: of the plant.
        known: the firmware's parameters.
    """
    return scenario(entries, known) if kind == "scenario" else plant(kind, entries, known)


def plant(kind: str, entries: core.Schema, known: Mapping[str, Entry]) -> Json:
    """Of a motor or a profile; both have the same sections and keys."""
    keys = {
        "description": _TEXT,
        "commission": _SWITCH | {"description": "A campaign lets the drive measure itself first."},
        **({"sized": _SWITCH | {"description": _SIZED}} if kind == "profile" else {}),
        **_sections(entries),
        "parameters": _parameters(known) | {"description": "Of the drive; they go before what follows from the rest."},
    }
    return _file(kind, _table(keys))


def _sections(entries: core.Schema) -> dict[str, Json]:
    return {name: _table({key: entry.schema for key, entry in keys.items()}) for name, keys in entries.items()}


def _parameters(known: Mapping[str, Entry]) -> Json:
    return _table({name: entry.schema for name, entry in known.items()})


# ---- building blocks


def _file(kind: str, table: Json, **more: Json) -> Json:
    return {"$schema": DIALECT, "title": f"stillspin {kind} file", **more, **table}


def _table(keys: Mapping[str, Json], *required: str) -> Json:
    return {"type": "object", "additionalProperties": False, "properties": dict(keys), "required": list(required)}


def _number(unit: str = "", minimum: float | None = None) -> Json:
    bound = {} if minimum is None else {"minimum": minimum}
    return {"type": "number", **bound, **({"unit": unit} if unit else {})}


def _list(item: Json, least: int = 0) -> Json:
    return {"type": "array", "items": item, "minItems": least}


def _row(*items: Json) -> Json:
    return {"type": "array", "items": list(items), "minItems": len(items), "maxItems": len(items)}


def _one_or_more(item: Json) -> Json:
    """A single one needs no brackets."""
    return {"if": {"type": "array"}, "then": _list(item, 1), "else": item}


_SIZED = "Volts, amperes and torques are those of motor A on its board; another has them in units of its own size."
_TEXT: Json = {"type": "string"}
_SWITCH: Json = {"type": "boolean"}
_NAME: Json = {"type": "string", "pattern": "^[a-z0-9_]+$", "words": "lower case letters, digits and '_'"}
_WINDOW: Json = _row(_number("s", 0), _number("s", 0)) | {"words": "[from, to] in s"}


# ---- scenarios


def scenario(entries: core.Schema, known: Mapping[str, Entry]) -> Json:
    """Of a scenario. What relates one place of a file to another is not in it; the loader says that."""
    words: Json = {"enum": [*COMMANDS, *(f"set:{name}" for name in known)], "words": "a command"}
    run = _run(words)
    keys = {
        "id": _TEXT | {"description": "The name of the file."},
        "title": _TEXT,
        "motor": {"enum": resources.names("motors")},
        "description": _TEXT,
        "on_demand": _SWITCH | {"description": "It takes long, and runs only where it is named."},
        "paper": _table({"figure": _TEXT, "says": _TEXT}),
        "defaults": _table(run) | {"description": "What the runs have in common; a run that says otherwise wins."},
        "runs": _list(_table({"name": _NAME, **run}, "name"), 1),
        "figures": _list(_figure(), 1),
        "plots": _list(_plot()),
    }
    found = _table(keys, "id", "title", "motor", "runs", "figures")
    found["allOf"] = [_stated_somewhere("duration"), _stated_somewhere("reached")]
    shared = {"plant": _table(_sections(entries)), "factor": _factors(entries), "parameters": _parameters(known)}
    return _file("scenario", found, definitions=shared)


def _factors(entries: core.Schema) -> Json:
    """Numbers by section and entry; that they are above 0 says who reads them."""
    sections = {name: _table(dict.fromkeys(section, _number("", 0))) for name, section in entries.items()}
    return _table(sections) | {"description": "What entries of the plant are multiplied by, whatever the profile says."}


def _stated_somewhere(key: str) -> Json:
    """By the defaults, or else by every run."""
    stated = {"required": ["defaults"], "properties": {"defaults": {"required": [key]}}}
    return {"if": stated, "else": {"properties": {"runs": {"items": {"required": [key]}}}}}


def _run(words: Json) -> dict[str, Json]:
    reached = _table({"window": _WINDOW, "band": _number("rpm", 0), "speed": _number("rpm")}, "window", "band")
    whole: Json = {"type": "integer", "minimum": 1}
    return {
        "title": _TEXT,
        "duration": _number("s", 0.001) | {"description": "After the start procedure [s]"},
        "max_start": _number("s", 0) | {"description": "Longest start procedure [s]"},
        "commands": _list(_row(_number("s", 0), words, _number())),
        "reference": _reference(words),
        "load": _list(_row(_number("s"), _number("Nm"))) | {"description": "Corners of the load torque [s, Nm]"},
        "scheme": _TEXT | {"description": "Another scheme than the drive's own, such as paper; under the parameters."},
        "parameters": {"$ref": "#/definitions/parameters"},
        "plant": {"$ref": "#/definitions/plant"},
        "factor": {"$ref": "#/definitions/factor"},
        "reached": _list(reached, 1) | {"description": "Where the true shaft has to be, else the run does not count."},
        "record_every": whole | {"description": "PWM periods to a record"},
        "waveform": _table({"window": _WINDOW, "raster": whole | {"unit": "x 10 ns"}}, "window"),
        "may_be_lost": _SWITCH,
    }


def _reference(words: Json) -> Json:
    """A moving command as a sine or as straight lines."""
    common = {"what": words, "interval": _number("s", 1e-4)}
    time = {"start": _number("s", 0), "stop": _number("s", 0)}
    wave = {"amplitude": _number(), "frequency": _number("Hz")}
    sine = _table({"shape": _TEXT, **common, **time, **wave}, *time, *wave)
    points = _table({"shape": _TEXT, **common, "points": _list(_row(_number("s"), _number()), 2)}, "points")
    shape = {"type": "object", "required": ["shape"], "properties": {"shape": {"enum": ["sine", "points"]}}}
    return {**shape, **_by("shape", "sine", sine, points)}


def _by(key: str, value: str, then: Json, otherwise: Json) -> Json:
    return {"if": {"required": [key], "properties": {key: {"const": value}}}, "then": then, "else": otherwise}


def _figure() -> Json:
    """A ratio of two others, or measured; the name is the kind where that is not stated."""
    goal = {"if": {"type": "object"}, "then": {"additionalProperties": _number()}, "else": _number()}
    common = {
        "name": _NAME,
        "kind": _TEXT,
        "paper": _number(),
        "goal": goal,
        "note": _TEXT,
        "runs": _one_or_more(_TEXT),
    }
    ratio = _table({**common, "of": _row(_TEXT, _TEXT) | {"words": "the names of two figures"}}, "name", "of")
    several = {"if": {"type": "array", "items": {"type": "array"}}, "then": _list(_WINDOW, 1), "else": _WINDOW}
    measured = _table({**common, "window": several}, "name", "window")
    kinds = {"enum": [*vocabulary.KINDS]}
    stated = _by("kind", RATIO, {}, {"properties": {"kind": {"enum": [*vocabulary.KINDS, RATIO]}}})
    named = {"if": {"required": ["kind"]}, "then": stated, "else": {"properties": {"name": kinds}}}
    return {"type": "object", "allOf": [named], **_by("kind", RATIO, ratio, measured)}


def _plot() -> Json:
    keys = {"title": _TEXT, "runs": _one_or_more(_TEXT), "window": _WINDOW}
    return _table({**keys, "panels": _one_or_more({"enum": [*vocabulary.PANELS]})}, "panels")
