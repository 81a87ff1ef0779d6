"""The packages that sim_host/pyproject.toml installs are those that there are.

An editable installation imports any folder, an installed one only what is listed: what is forgotten is missed by users
first.
"""

import tomllib
from pathlib import Path

from checks import Finding

PYPROJECT = "sim_host/pyproject.toml"


def check(root: Path) -> list[Finding]:
    """Findings for every folder with code that is not listed, and every listed package that has no folder."""
    settings = tomllib.loads((root / PYPROJECT).read_text())["tool"]["setuptools"]
    base = root / "sim_host"
    code = {".".join(path.parent.relative_to(base).parts) for path in (base / "stillspin").rglob("__init__.py")}
    listed, data = set(settings["packages"]), set(settings["package-dir"])
    forgotten = [Finding(PYPROJECT, 0, f"{name} is not among the packages") for name in sorted(code - listed)]
    gone = [Finding(PYPROJECT, 0, f"package {name} has no folder") for name in sorted(listed - code - data)]
    return forgotten + gone
