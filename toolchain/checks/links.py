"""Links of the book and the pages beside it: a relative link leads to a file, and a path named in the text exists.

mkdocs checks the links between the book's own pages (with --strict); this check covers README.md and CONTRIBUTING.md,
and what mkdocs cannot see: names of files and folders of this repository, written as code, and links of functions, such
as [`drive_estimate`](../firmware/drive/position.c), whose file has to have that word.
"""

import re
from pathlib import Path

from checks import Finding

_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)[^)]*\)")
_FUNCTION = re.compile(r"\[`(\w+)`\]\(([^)\s#]+\.[\w]+)\)")
_CODE = re.compile(r"`([^`\n]+)`")
_TOP = ("firmware", "hal", "estimators", "control", "svpwm", "sim_host", "tests", "toolchain", "docs")
_PATH = re.compile(rf"(?:{'|'.join(_TOP)})/[\w./*-]*")


def pages(root: Path) -> list[Path]:
    """README.md, CONTRIBUTING.md and the pages of the book."""
    beside = (root / name for name in ("README.md", "CONTRIBUTING.md"))
    return [*(page for page in beside if page.is_file()), *sorted((root / "docs").rglob("*.md"))]


def prose(text: str) -> list[tuple[int, str]]:
    """Numbered lines outside fenced code blocks."""
    kept, fenced = [], False
    for number, line in enumerate(text.splitlines(), start=1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            kept.append((number, line))
    return kept


def _dead_links(page: Path, line: str) -> list[str]:
    # Code first: brackets and parentheses in it are not a link.
    targets = (match[1].split("#")[0] for match in _LINK.finditer(_CODE.sub("", line)))
    return [t for t in targets if t and "://" not in t and not (page.parent / t).exists()]


def _lost_functions(page: Path, line: str) -> list[str]:
    found = ((match[1], page.parent / match[2]) for match in _FUNCTION.finditer(line))
    files = ((name, file) for name, file in found if file.is_file())
    return [
        f"{name} is not in {file.name}"
        for name, file in files
        if not re.search(rf"\b{name}\b", file.read_text(encoding="utf-8"))
    ]


def _dead_paths(root: Path, line: str) -> list[str]:
    named = (match[1] for match in _CODE.finditer(line))
    # Only what is a path and nothing else: `hal/qmath/`, not `cmake --build build`. Built files are not in the tree.
    paths = (name for name in named if _PATH.fullmatch(name))
    return [path for path in paths if not any(root.glob(path.rstrip("/")))]


def check(root: Path) -> list[Finding]:
    """Findings for every dead link, every function that is not where its link leads, every path that does not exist."""
    findings = []
    for page in pages(root):
        name = page.relative_to(root).as_posix()
        for number, line in prose(page.read_text(encoding="utf-8")):
            findings += [Finding(name, number, f"dead link to {target}") for target in _dead_links(page, line)]
            findings += [Finding(name, number, lost) for lost in _lost_functions(page, line)]
            findings += [Finding(name, number, f"{path} does not exist") for path in _dead_paths(root, line)]
    return findings
