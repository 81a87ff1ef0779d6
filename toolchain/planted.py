"""Copies of the sources with planted defects, for checks that have to show that they can fail."""

import shutil
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

Change = tuple[str, str, str]  # file, what is right, what is wrong


def copy(tree: Path, parts: Iterable[str]) -> None:
    """Copies folders and files of the repository."""
    shutil.rmtree(tree, ignore_errors=True)
    for part in parts:
        if (ROOT / part).is_dir():
            shutil.copytree(ROOT / part, tree / part)
        else:
            (tree / part).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / part, tree / part)


def change(tree: Path, changes: Iterable[Change]) -> list[str]:
    """Plants defects in a copy; complaints where a file does not have what a defect replaces."""
    complaints = []
    for file, right, wrong in changes:
        path = tree / file
        text = path.read_text(encoding="utf-8")
        complaints += [] if right in text else [f"{file} has no {right!r}"]
        path.write_text(text.replace(right, wrong), encoding="utf-8")
    return complaints


def plant(tree: Path, folders: tuple[str, ...], changes: Iterable[Change]) -> list[str]:
    """Both."""
    copy(tree, folders)
    return change(tree, changes)
