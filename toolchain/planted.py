"""Copies of the sources with planted defects, for checks that have to show that they can fail."""

import shutil
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

Change = tuple[str, str, str]  # file, what is right, what is wrong


def plant(tree: Path, folders: tuple[str, ...], changes: Iterable[Change]) -> list[str]:
    """Makes the copy; complaints where a file does not have what a defect replaces."""
    shutil.rmtree(tree, ignore_errors=True)
    for folder in folders:
        shutil.copytree(ROOT / folder, tree / folder)
    complaints = []
    for file, right, wrong in changes:
        path = tree / file
        text = path.read_text(encoding="utf-8")
        complaints += [] if right in text else [f"{file} has no {right!r}"]
        path.write_text(text.replace(right, wrong), encoding="utf-8")
    return complaints
