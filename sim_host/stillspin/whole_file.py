"""Writing a file that appears whole or not at all: beside its place first, which it then takes."""

from __future__ import annotations

import tempfile
from pathlib import Path

from stillspin.errors import InputError


def write(path: Path, content: str | bytes, option: str = "") -> None:
    """Write a file, or replace it as a whole.

    Args:
        path: of the file.
        content: text goes as UTF-8.
        option: of the command line that names the file, for the complaint.

    Raises:
        InputError: it cannot be written.
    """
    octets = content.encode() if isinstance(content, str) else content
    try:
        with tempfile.NamedTemporaryFile(dir=path.absolute().parent, delete=False) as file:
            beside = Path(file.name)
        try:
            beside.write_bytes(octets)
            beside.chmod(0o644)
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{option} {path}: cannot be written ({error.strerror})".lstrip()) from error
