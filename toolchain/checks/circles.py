"""No circle among the modules of sim_host/stillspin, and no folder of it that imports one above it.

Each can be read, tried and moved without what is built on it. Every import counts, also one inside a function, and one
that only a type checker sees. What points up still stands in LEFT, which only shrinks.
"""

import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp

from checks import Finding, left

# From the ground up; what is not named here lies below all of them and imports none.
FLOORS = (
    *("link", "flash", "c28x", "cases", "catalogue", "board", "drive", "measure", "image", "runs", "hil", "report"),
    *("studies", "campaign", "type_test", "tune", "commands", "cli", "__main__"),
)
LEFT = "toolchain/imports_left.txt"  # lines `folder: folders above it that it imports`


def check(root: Path) -> list[Finding]:
    """Findings for circles, one at a time for each: without one of its imports the next one shows."""
    sys.path.insert(0, str(root / "sim_host"))
    try:
        graph = grimp.build_graph("stillspin", cache_dir=None)
    finally:
        sys.path.pop(0)
    imports = {module: set(graph.find_modules_directly_imported_by(module)) for module in sorted(graph.modules)}
    findings = list(_up(imports, root))
    while circle := _circle(imports):
        findings.append(Finding(_file(circle[0]), 0, f"a circle of imports: {' -> '.join(circle)}"))
        imports[circle[0]].discard(circle[1])
    return findings


def _up(imports: dict[str, set[str]], root: Path) -> Iterator[Finding]:
    known = left(root / LEFT)
    needed = set()
    for module, others in imports.items():
        for other in sorted(others):
            arrow = _folder(module), _folder(other)
            if _floor(arrow[0]) >= _floor(arrow[1]) or arrow[0] == arrow[1]:
                continue
            needed.add(arrow)
            if arrow not in known:
                yield Finding(_file(module), 0, f"{arrow[0]} must not import {arrow[1]}, which lies above it: {other}")
    for arrow in sorted(known.keys() - needed):
        yield Finding(LEFT, known[arrow], f"{arrow[0]} does not import {arrow[1]} any more; take it out")


def _folder(module: str) -> str:
    """Of the package, or the module beside the folders."""
    return module.split(".")[1] if "." in module else ""


def _floor(folder: str) -> int:
    return FLOORS.index(folder) if folder in FLOORS else -1


def _circle(imports: dict[str, set[str]]) -> list[str]:
    """Modules each of which imports the next one, the last being the first; empty when there is no circle."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return list(reversed(error.args[1]))
    return []


def _file(module: str) -> str:
    return f"sim_host/{module.replace('.', '/')}.py"
