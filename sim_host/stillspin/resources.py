"""Where scenarios, profiles, motors and the book are: inside the installed package, or beside it in the source tree."""

from __future__ import annotations

from pathlib import Path

from stillspin.errors import InputError, did_you_mean

PACKAGE = Path(__file__).resolve().parent

DEFAULT_MOTOR = "A"
"""Where nothing is said. Only the files of the motors know what it is."""

CATALOGUE = "motors/catalogue"
_FURTHER = {"motors": CATALOGUE, "profiles": "motors/profiles"}
"""Where more of a kind is, known by name: other people's motors, and for each of them a profile of its name."""


def directory(name: str) -> Path:
    """The directory `name` ("motors", "profiles", "scenarios", "schemes", or in one of them) of this package.

    Raises:
        FileNotFoundError: the installation is damaged.
    """
    for candidate in (PACKAGE / name, PACKAGE.parent / name):
        if candidate.is_dir():
            return candidate
    raise FileNotFoundError(f"the directory '{name}' is missing from the installation of stillspin at {PACKAGE}")


def book() -> Path:
    """The folder of the book's pages.

    Raises:
        FileNotFoundError: the installation is damaged.
    """
    for candidate in (PACKAGE / "docs", PACKAGE.parents[1] / "docs"):
        if (candidate / "index.md").is_file():
            return candidate
    raise FileNotFoundError(f"the book's pages are missing from the installation of stillspin at {PACKAGE}")


def page(name: str) -> str:
    """Where a page of the book is, for people: its path, from where they are when it lies below."""
    try:
        found, here = book() / f"{name}.md", Path.cwd()
    except FileNotFoundError:  # of these, or of the folder that they are in: what is said beside it matters more
        return f"{name}.md"
    return str(found.relative_to(here) if found.is_relative_to(here) else found)


def names(kind: str) -> list[str]:
    """Names (file stems) of what ships in directory `kind`, in natural order: A9 before A10."""
    return sorted((path.stem for path in directory(kind).glob("*.toml")), key=natural_key)


def find(kind: str, name_or_path: str) -> Path:
    """The file of something that is given by name or by path.

    Args:
        kind: "profiles", "motors" or "schemes".
        name_or_path: one of those that ship, or the path of a TOML file.

    Raises:
        InputError: there is no such thing or file.
    """
    word = kind.removesuffix("s")
    if name_or_path.endswith(".toml") or "/" in name_or_path:
        path = Path(name_or_path)
        if not path.is_file():
            raise InputError(f"{word} '{name_or_path}': there is no such file")
        return path
    folders = [kind, *([_FURTHER[kind]] if kind in _FURTHER else [])]
    known = {name: directory(folder) / f"{name}.toml" for folder in folders for name in names(folder)}
    if name_or_path not in known:
        hint = did_you_mean(name_or_path, known)
        path_too = " Or give a path" if hint.endswith("?") else ", or give a path"
        raise InputError(f"there is no {word} '{name_or_path}'{hint}{path_too} to a .toml file")
    return known[name_or_path]


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
