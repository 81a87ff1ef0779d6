"""Trees in which something is wrong on purpose."""

from pathlib import Path


def plant(root: Path, path: str, text: str = "") -> Path:
    """Writes ``text`` to ``path`` under ``root``."""
    file = root / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return file
