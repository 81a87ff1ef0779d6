"""The directory of results: it appears whole, or not at all."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from stillspin.errors import InputError

RUNS = "runs"
"""Sub-directory of the records."""

MARK = "metrics.json"
"""The file by which an earlier result is known; nothing else is ever replaced."""


@contextmanager
def fresh_directory(target: Path) -> Iterator[Path]:
    """A directory to write results into; when all went well it takes the place of `target`, else it vanishes.

    Raises:
        InputError: the target cannot be written, or holds something that is not an earlier result.
    """
    target = target.absolute()
    _check(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        partial = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as error:
        raise InputError(f"--out {target}: cannot be written ({error.strerror})") from error
    try:
        (partial / RUNS).mkdir()
        yield partial
        partial.chmod(0o755)
        _put_in_place(partial, target)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _check(target: Path) -> None:
    if target.exists() and not target.is_dir():
        raise InputError(f"--out {target}: is a file, must be a directory")
    if target.is_dir() and target.samefile(Path.cwd()):
        raise InputError(f"--out {target}: is the current directory, which results would replace; name another one")
    if target.is_dir() and any(target.iterdir()) and not (target / MARK).is_file():
        raise InputError(f"--out {target}: holds other things than results of stillspin; name a new or empty one")


def _put_in_place(partial: Path, target: Path) -> None:
    """Swap by renaming, so that at no time half a result can be seen."""
    if not target.exists():
        partial.rename(target)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{target.name}-old-", dir=target.parent))
    target.rename(old / "replaced")
    partial.rename(target)
    shutil.rmtree(old, ignore_errors=True)
