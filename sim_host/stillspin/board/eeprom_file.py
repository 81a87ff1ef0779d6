"""The EEPROM of the virtual board as a file: what was saved is there when the board is switched on again."""

from __future__ import annotations

from pathlib import Path

from stillspin import whole_file
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.errors import InputError


def insert(board: NativeBoard, file: Path) -> None:
    """Give a board that has just been switched on the content of a file; a file that does not exist is a new memory.

    Raises:
        InputError: it cannot be read, cannot be written later, or is of another size.
    """
    if not file.absolute().parent.is_dir():
        raise InputError(f"--eeprom {file}: there is no directory {file.parent}")
    if not file.exists():
        return
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InputError(f"--eeprom {file}: cannot be read ({error.strerror})") from error
    size = len(board.eeprom)
    if len(content) != size:
        raise InputError(f"--eeprom {file}: has {counted(len(content), 'octet')}, must have {size}")
    board.eeprom = content


def keep(board: NativeBoard, file: Path) -> None:
    """Write the content; the file is replaced as a whole.

    Raises:
        InputError: it cannot be written.
    """
    whole_file.write(file, board.eeprom, "--eeprom")
