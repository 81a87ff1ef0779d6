"""Which state of the sources a result belongs to."""

from __future__ import annotations

import subprocess

from stillspin import __version__
from stillspin.resources import PACKAGE

WRITTEN = PACKAGE / "revision.txt"
"""What the wheel was made from (toolchain/wheel.py); a source tree has none."""


def _git(*arguments: str) -> str | None:
    try:
        done = subprocess.run(
            ["git", "-C", str(PACKAGE), *arguments], capture_output=True, text=True, timeout=10, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def revision() -> str:
    """`git describe` of the source tree that this package runs from or was made from, else the version of the package.

    A package installed into an environment that happens to lie inside somebody else's repository is not described by
    that repository: only a tree that tracks this very file is.
    """
    if _git("ls-files", "--error-unmatch", "revision.py") is None:
        return WRITTEN.read_text(encoding="utf-8").strip() if WRITTEN.exists() else __version__
    return _git("describe", "--always", "--dirty", "--tags") or __version__
