"""No circle among the modules of sim_host/stillspin: each can be read, tried and moved without what is built on it.

Every import counts, also one inside a function, and one that only a type checker sees.
"""

import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp

from checks import Finding


def check(root: Path) -> list[Finding]:
    """Findings for circles, one at a time for each: without one of its imports the next one shows."""
    sys.path.insert(0, str(root / "sim_host"))
    try:
        graph = grimp.build_graph("stillspin", cache_dir=None)
    finally:
        sys.path.pop(0)
    imports = {module: set(graph.find_modules_directly_imported_by(module)) for module in sorted(graph.modules)}
    findings = []
    while circle := _circle(imports):
        findings.append(Finding(_file(circle[0]), 0, f"a circle of imports: {' -> '.join(circle)}"))
        imports[circle[0]].discard(circle[1])
    return findings


def _circle(imports: dict[str, set[str]]) -> list[str]:
    """Modules each of which imports the next one, the last being the first; empty when there is no circle."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return list(reversed(error.args[1]))
    return []


def _file(module: str) -> str:
    return f"sim_host/{module.replace('.', '/')}.py"
