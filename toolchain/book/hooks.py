"""What mkdocs does for the book beside its own work.

Abbreviations are explained, the search needs no server, figures of older sources than those of the book are said to
be that, and what links to a source, which the book does not hold, is the name alone.
"""

from __future__ import annotations

import json
import re
import shutil
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from book import figures, records  # noqa: E402

ROOT = HERE.parents[1]
GLOSSARY = HERE.parents[1] / "docs/glossary.md"
_ROW = re.compile(r"^\| \*\*(?P<term>[^*]+)\*\* \| (?P<words>.+?) \|$", re.MULTILINE)
_END = re.compile(r"^<!-- end of (?P<name>[\w-]+) -->$", re.MULTILINE)
_LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
_SOURCE = re.compile(r"\[([^\]]*)\]\(\.\./[^)]*\)")


def abbreviations(text: str | None = None) -> dict[str, str]:
    """The glossary's terms and what they mean, without links."""
    known = GLOSSARY.read_text(encoding="utf-8") if text is None else text
    return {match["term"]: _LINK.sub(r"\1", match["words"]).replace("`", "") for match in _ROW.finditer(known)}


@cache
def _outdated() -> dict[str, str]:
    return records.outdated(ROOT)


def aged(markdown: str, outdated: Mapping[str, str]) -> str:
    """Behind every piece whose records are of older sources: that it is so, and which command renews it."""

    def words(match: re.Match[str]) -> str:
        commands = sorted({outdated[name] for name in figures.drawn_from(ROOT, match["name"]) if name in outdated})
        said = " and ".join(f"`{command}`" for command in commands)
        return match[0] + (f"\n\n*Of an older state of the sources; {said} renews it.*\n" if commands else "")

    return _END.sub(words, markdown)


def without_sources(markdown: str, page: str) -> str:
    """Links of a page that leave the book's folder as their words alone."""
    return markdown if "/" in page else _SOURCE.sub(r"\1", markdown)


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Behind every page but the glossary what its abbreviations mean; the extension `abbr` puts it where they stand."""
    markdown = without_sources(markdown, page.file.src_uri)
    if page.file.src_uri == GLOSSARY.name:
        return markdown
    return (
        aged(markdown, _outdated())
        + "\n\n"
        + "\n".join(f"*[{term}]: {words}" for term, words in abbreviations().items())
    )


def on_post_build(*, config: Any, **_: Any) -> None:
    """A page that was opened as a file may neither fetch the index nor start a worker: both become a plain script."""
    folder = Path(config.site_dir) / "search"
    index = json.loads((folder / "search_index.json").read_text(encoding="utf-8"))
    script = f"var searchIndex = {json.dumps(index, ensure_ascii=False)};\n"
    (folder / "search_index.js").write_text(script, encoding="utf-8")
    shutil.copy(HERE / "search.js", folder / "main.js")
    for unused in ("worker.js", "search_index.json"):
        (folder / unused).unlink()
