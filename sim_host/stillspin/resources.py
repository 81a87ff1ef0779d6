"""Where the scenario and profile files are: inside the installed package, or beside it in the source tree."""

from __future__ import annotations

from pathlib import Path

PACKAGE = Path(__file__).resolve().parent


def directory(name: str) -> Path:
    """The directory `name` ("profiles", "scenarios" or "schemes") that ships with this package.

    Raises:
        FileNotFoundError: the installation is damaged.
    """
    for candidate in (PACKAGE / name, PACKAGE.parent / name):
        if candidate.is_dir():
            return candidate
    raise FileNotFoundError(f"the directory '{name}' is missing from the installation of stillspin at {PACKAGE}")


def names(kind: str) -> list[str]:
    """Names (file stems) of what ships in directory `kind`, in natural order: A9 before A10."""
    return sorted((path.stem for path in directory(kind).glob("*.toml")), key=natural_key)


def natural_key(name: str) -> tuple[tuple[int, str], ...]:
    """Sort key in which digits count as numbers."""
    parts: list[tuple[int, str]] = []
    digits = ""
    for char in name + "\0":
        if char.isdigit():
            digits += char
            continue
        if digits:
            parts.append((int(digits), ""))
            digits = ""
        parts.append((-1, char.lower()))
    return tuple(parts)
