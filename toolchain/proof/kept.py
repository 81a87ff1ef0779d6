"""What was read of a part is kept until something changes that decides it.

So a run that was broken off goes on, and after a change only the parts that have it in them are read anew.
"""

import hashlib
import json
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any


def key_of(command: Sequence[str], sources: Iterable[str], preprocess: Sequence[str], tree: Path, out: Path) -> str:
    """A sum over how Frama-C is called, its version, and the text of all files that it gets to see.

    Paths below `out`, where the build's own files are, count by what is behind it; the others are seen from `tree`.
    """
    named = list(sources)
    rule = subprocess.run(["gcc", "-MM", *preprocess, *named], cwd=tree, capture_output=True, text=True, check=True)
    files = {word for word in rule.stdout.replace("\\\n", " ").split() if not word.endswith(":")}
    version = subprocess.run(["frama-c", "-version"], capture_output=True, text=True, check=True).stdout
    total = hashlib.sha256("\0".join([version, *command]).replace(str(out), "").encode())
    for file in sorted(files):
        total.update(b"\0" + file.replace(str(out), "").encode() + b"\0" + (tree / file).read_bytes())
    return total.hexdigest()


def load(folder: Path, name: str, key: str) -> dict[str, Any] | None:
    """What was kept of a part under that key, or None."""
    file = folder / f"{name}.json"
    content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    return content if content.get("key") == key else None


def save(folder: Path, name: str, key: str, content: dict[str, Any]) -> None:
    """Keep it; what was kept of the part before goes."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps({"key": key, **content}, indent=1) + "\n", encoding="utf-8")
