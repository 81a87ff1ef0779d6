"""What the tests of the flash kernel share: two images and a kernel, as read from files of three formats."""

from pathlib import Path
from tempfile import TemporaryDirectory

import flash_files as make

from stillspin.flash.files import drive_image, kernel_program

OLD, NEW = make.image_blocks(1), make.image_blocks(2)

with TemporaryDirectory(prefix="flash-") as _name:
    _where = Path(_name)
    (_where / "old").write_bytes(make.coff(OLD))
    (_where / "new").write_bytes(make.intel_hex(NEW))
    (_where / "kernel").write_bytes(make.boot_ascii(make.kernel_blocks(), make.KERNEL_ENTRY))
    OLD_IMAGE, NEW_IMAGE = drive_image(_where / "old"), drive_image(_where / "new")
    KERNEL = kernel_program(_where / "kernel")


def nothing(_what, _share):
    """A progress that nobody watches."""


def flash_of(board):
    return list(board.native.flash)
