"""Reading TOML with every key accounted for: a misspelt key is an error, never silently ignored."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from stillspin.errors import InputError, did_you_mean
from stillspin.quantity import Range


def read(path: Path) -> Table:
    """The file as a table.

    Raises:
        InputError: unreadable, or not TOML; with the line.
    """
    try:
        return Table(tomllib.loads(path.read_text(encoding="utf-8")), str(path))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text ({error.reason} at byte {error.start})") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not valid TOML: {error}") from error


class Table:
    """A TOML table whose keys are taken one by one; `finish` complains about those that nobody took."""

    def __init__(self, data: dict[str, Any], where: str) -> None:
        self._data = data
        self._known: list[str] = []
        self.where = where

    def fail(self, key: str, message: str) -> InputError:
        """An error about the value of `key`."""
        return InputError(f"{self.where}: {key} = {self._data.get(key)!r}: {message}")

    def raw(self, key: str, default: Any = None) -> Any:
        """The value as TOML has it, or the default."""
        self._known.append(key)
        return self._data.get(key, default)

    def has(self, key: str) -> bool:
        """Whether the table says anything about `key`."""
        self._known.append(key)
        return key in self._data

    def text(self, key: str, default: str | None = None) -> str:
        """A string; required when there is no default."""
        value = self.raw(key, default)
        if value is None:
            raise InputError(f"{self.where}: '{key}' is missing")
        if not isinstance(value, str):
            raise self.fail(key, "must be text")
        return value

    def number(self, key: str, default: float | None = None, minimum: float | None = None) -> float:
        """A finite number; required when there is no default."""
        value = self.raw(key, default)
        if value is None:
            raise InputError(f"{self.where}: '{key}' is missing")
        return Range(minimum).read(self._untyped(key, value), f"{self.where}: {key}")

    def _untyped(self, key: str, value: Any) -> Any:
        if isinstance(value, str):
            raise self.fail(key, "must be a number, without quotes")
        return value

    def switch(self, key: str) -> bool:
        """True or false; false where nothing is said."""
        value = self.raw(key, False)
        if not isinstance(value, bool):
            raise self.fail(key, "must be true or false")
        return value

    def table(self, key: str) -> Table:
        """A sub-table, empty when it is not given."""
        value = self.raw(key, {})
        if not isinstance(value, dict):
            raise self.fail(key, "must be a table")
        return Table(value, f"{self.where}: {key}")

    def tables(self, key: str) -> list[Table]:
        """An array of tables, empty when it is not given."""
        value = self.raw(key, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.fail(key, "must be an array of tables")
        return [Table(item, f"{self.where}: {key}[{number}]") for number, item in enumerate(value)]

    def texts(self, key: str) -> list[str]:
        """A string or a list of strings, empty when it is not given."""
        value = self.raw(key, [])
        items = [value] if isinstance(value, str) else value
        if not isinstance(items, list) or not all(isinstance(item, str) for item in items):
            raise self.fail(key, "must be text or a list of texts")
        return list(items)

    def items(self) -> dict[str, Any]:
        """Everything in the table; the caller checks the keys."""
        self._known.extend(self._data)
        return self._data

    def finish(self) -> None:
        """Complain about keys that mean nothing here."""
        for key in self._data:
            if key not in self._known:
                raise InputError(f"{self.where}: unknown key '{key}'{did_you_mean(key, set(self._known))}")


def as_number(value: Any) -> float | None:
    """A finite float from a TOML integer or float, else None."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    number = float(value)
    return number if abs(number) < float("inf") else None
