#!/usr/bin/env python3
"""Builds two wheels: `stillspin`, pure Python, and `stillspin_virtual`, the native module of this machine.

The first is the client, for people without a compiler: it runs on every system that Python runs on. Its extra `virtual`
asks for the second, which needs this system's SUNDIALS and Python. Nothing is fetched; `make build` comes before.

Usage: toolchain/wheel.py DIRECTORY
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "sim_host"
FOLDERS = ("stillspin", "faults", "motors", "profiles", "scenarios", "schemes", "spreads")
_BUILD = "import sys; from setuptools import build_meta; print(build_meta.build_wheel(sys.argv[1]))"
TABLES = ("chip/c28x",)  # of the virtual chip: their tables alone
_NOT_COPIED = shutil.ignore_patterns("_core*", "boards", "__pycache__", "*.pyc")

# The native module has no sources here that setuptools could compile; it is data of a package of one machine.
_VIRTUAL = """\
from setuptools import Distribution, setup

class OfThisMachine(Distribution):
    def has_ext_modules(self):
        return True

setup(name="stillspin-virtual", version="{version}", description="The virtual drive of stillspin, compiled",
      license="BSD-3-Clause", python_requires=">=3.11", packages=["stillspin_virtual"], distclass=OfThisMachine,
      package_data={{"stillspin_virtual": ["_core*"]}})
"""


def _wheel(staged: Path, out: Path) -> Path:
    """Builds what lies in a directory; quiet unless it fails."""
    done = subprocess.run(
        [sys.executable, "-c", _BUILD, str(out)], cwd=staged, capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(f"wheel: {done.stderr.strip()}")
    return out / done.stdout.split()[-1]


def client(out: Path, work: Path) -> Path:
    """The wheel of the client: the sources, the firmware's own parameter table, the book, the schemas."""
    from stillspin import core, revision  # noqa: PLC0415 - the package is looked for only where a wheel is wanted
    from stillspin.commands import schema  # noqa: PLC0415

    for folder in FOLDERS:
        shutil.copytree(SOURCE / folder, work / folder, ignore=_NOT_COPIED)
    for folder in TABLES:
        (work / folder).mkdir(parents=True)
        for table in sorted((SOURCE / folder).glob("*.csv")):
            shutil.copy(table, work / folder)
    book = work / "stillspin" / "docs"  # what the page in the browser links to
    shutil.copytree(ROOT / "docs" / "images", book / "images")
    for page in sorted((ROOT / "docs").glob("*.md")):
        shutil.copy(page, book)
    shutil.copy(SOURCE / "pyproject.toml", work)
    shutil.copy(ROOT / "LICENSE", work)
    table = json.dumps(core.load().parameters(), indent=1, default=list)
    (work / "stillspin" / core.PARAMETERS).write_text(table + "\n", encoding="utf-8")
    (work / "stillspin" / revision.WRITTEN.name).write_text(revision.revision() + "\n", encoding="utf-8")
    schemas = work / "stillspin" / schema.SHIPPED
    schemas.mkdir()
    for kind in schema.KINDS:
        (schemas / f"{kind}.json").write_text(schema.made(kind), encoding="utf-8")
    return _wheel(work, out)


def virtual(out: Path, work: Path) -> Path:
    """The wheel of the native module, for the Python and the system that it was built with."""
    from stillspin import __version__  # noqa: PLC0415

    package = work / "stillspin_virtual"
    package.mkdir()
    (package / "__init__.py").write_text('"""The native module of stillspin."""\n', encoding="utf-8")
    for module in (SOURCE / "stillspin").glob("_core*.so"):
        shutil.copy(module, package)
    (work / "setup.py").write_text(_VIRTUAL.format(version=__version__), encoding="utf-8")
    return _wheel(work, out)


def main() -> None:
    """Builds both into the directory named."""
    out = Path(sys.argv[1]).absolute()
    out.mkdir(parents=True, exist_ok=True)
    os.environ.setdefault("SOURCE_DATE_EPOCH", "315532800")  # the same sources, the same octets
    for build in (client, virtual):
        with tempfile.TemporaryDirectory(prefix="wheel-") as work:
            print(os.path.relpath(build(out, Path(work))))


if __name__ == "__main__":
    main()
