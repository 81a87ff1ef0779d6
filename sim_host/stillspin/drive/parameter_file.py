"""Parameter files: TOML with a table [parameters], as `run --params` reads and `commission` writes them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from stillspin import toml_table
from stillspin.drive.drive import Drive
from stillspin.drive.table import Parameter, Table
from stillspin.errors import InputError
from stillspin.link.errors import RefusedError


def text(values: Mapping[str, float], table: Table, about: Sequence[str]) -> str:
    """A parameter file.

    Args:
        values: by name, in the table's units.
        table: of the drive, for units and meanings.
        about: lines of comment at its head.
    """
    lines = [*(f"# {line}" for line in about), "", "[parameters]"]
    for name, value in values.items():
        parameter = table.parameter(name)
        unit = f"{parameter.unit}; " if parameter.unit else ""
        lines.append(f"{name} = {number(parameter, value)}  # {unit}{parameter.meaning}".rstrip(" #;"))
    return "\n".join(lines) + "\n"


def number(parameter: Parameter, value: float) -> str:
    """A value with all digits that make it this value, and at least the table's decimals."""
    short = f"{value:.{parameter.decimals}f}"
    return short if float(short) == value else repr(value)


def read(path: Path, table: Table, now: Mapping[str, float]) -> dict[str, float]:
    """The values of a file, every one checked against the drive's table.

    Args:
        path: of the file.
        table: of the drive.
        now: its values, of which the scales count where the file does not say them.

    Raises:
        InputError: unreadable, an unknown parameter, or a value that it does not take.
    """
    document = toml_table.read(path)
    values = document.table("parameters").items()
    document.finish()
    if not values:
        raise InputError(f"{path}: has no [parameters]")
    stated = {name: float(value) for name, value in values.items() if isinstance(value, int | float)}
    table = table.with_scales(now, stated)
    found = {}
    for name, value in values.items():
        try:
            parameter = table.parameter(name)
            if isinstance(value, str):
                raise InputError(f"{name}: {value!r} is text, no number; {parameter.range}")
            found[name] = parameter.to_user(parameter.to_raw(value))
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
    return found


Difference = tuple[Parameter, float | None, float | None]


def differences(
    one: Mapping[str, float], other: Mapping[str, float], table: Table, names: Iterable[str] | None = None
) -> list[Difference]:
    """What differs between two sets; None where a set says nothing.

    Args:
        one: by name.
        other: by name.
        table: of the drive.
        names: only these.
    """
    chosen = dict.fromkeys(names if names is not None else [*one, *other])
    rows = [(table.parameter(name), one.get(name), other.get(name)) for name in chosen]
    return [row for row in rows if row[1] != row[2]]


def put(drive: Drive, rows: Sequence[Difference]) -> list[str]:
    """Change parameters one by one. What does not fit yet is tried again when the others are in.

    Returns:
        What the drive says about those that it refused, or about the whole when it would not start with it.
    """
    waiting = [(parameter.name, value) for parameter, _, value in rows if value is not None]
    while True:
        again, refused, conflict = [], [], ""
        for name, value in waiting:
            try:
                conflict = drive.change(name, value).conflict
            except RefusedError as error:
                again.append((name, value))
                refused.append(str(error))
        if not again:
            return [conflict] if conflict else []
        if len(again) == len(waiting):
            return refused
        waiting = again
