"""What mkdocs does for the book beside its own work: abbreviations are explained, the search needs no server."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
GLOSSARY = HERE.parents[1] / "docs/glossary.md"
_ROW = re.compile(r"^\| \*\*(?P<term>[^*]+)\*\* \| (?P<words>.+?) \|$", re.MULTILINE)
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")


def abbreviations(text: str | None = None) -> dict[str, str]:
    """The glossary's terms and what they mean, without links."""
    known = GLOSSARY.read_text(encoding="utf-8") if text is None else text
    return {match["term"]: _LINK.sub(r"\1", match["words"]).replace("`", "") for match in _ROW.finditer(known)}


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Behind every page but the glossary what its abbreviations mean; the extension `abbr` puts it where they stand."""
    if page.file.src_uri == GLOSSARY.name:
        return markdown
    return markdown + "\n\n" + "\n".join(f"*[{term}]: {words}" for term, words in abbreviations().items())


def on_post_build(*, config: Any, **_: Any) -> None:
    """A page that was opened as a file may neither fetch the index nor start a worker: both become a plain script."""
    folder = Path(config.site_dir) / "search"
    index = json.loads((folder / "search_index.json").read_text(encoding="utf-8"))
    script = f"var searchIndex = {json.dumps(index, ensure_ascii=False)};\n"
    (folder / "search_index.js").write_text(script, encoding="utf-8")
    shutil.copy(HERE / "search.js", folder / "main.js")
    for unused in ("worker.js", "search_index.json"):
        (folder / unused).unlink()
