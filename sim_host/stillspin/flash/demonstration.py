"""An image and a kernel to try `stillspin flash` with before TI's tools are there: for a virtual board alone.

Their words are noise that no compiler made. A real chip would jump into it, so both say what they are in a place where
every host looks, and `update.py` gives them to nothing but a board that proves to be virtual (`virtual.py`).
"""

from __future__ import annotations

import random
from pathlib import Path

from stillspin import __version__
from stillspin.errors import InputError
from stillspin.flash import boot_stream, image_sum, layout
from stillspin.flash.program import Block, Program, assemble

IMAGE_NAME = "stillspin_demonstration.bin"
KERNEL_NAME = "stillspin_flash_kernel.bin"
_WORDS = 3000
"""In each sector; an update takes about as long as that of a drive that is a fifth as large."""
_KERNEL_WORDS = 2000


def image() -> Program:
    """A program in all sectors of an update, with identity and check sum; the same every time."""
    noise = random.Random(0xF2808)
    version = tuple(int(part) for part in __version__.split("."))
    identity = (layout.MARK, layout.IDENTITY_FORMAT, *version, 0, 0, layout.DEMONSTRATION, 0, 0)
    code = [Block(sector.words.start + 0x100, _words(noise, _WORDS)) for sector in layout.SECTORS]
    end = code[-1].end
    unsummed = [*code, Block(layout.IDENTITY, (*identity, end & 0xFFFF, end >> 16, layout.ERASED, layout.ERASED))]
    total = image_sum.computed(assemble(unsummed, None, "", IMAGE_NAME), end)
    summed = Block(layout.IDENTITY, (*unsummed[-1].words[:-2], total & 0xFFFF, total >> 16))
    return assemble([*code, summed], layout.BOOT_ENTRY, "boot stream", IMAGE_NAME)


def kernel() -> Program:
    """A program in the kernel's RAM; the virtual board runs the kernel's C in its place."""
    words = (layout.KERNEL_DEMONSTRATION, *_words(random.Random(0x464B), _KERNEL_WORDS))
    return assemble([Block(layout.KERNEL_RAM.start, words)], layout.KERNEL_RAM.start + 0x20, "boot stream", KERNEL_NAME)


def write(directory: Path) -> tuple[Path, Path]:
    """Both as files, of the form that hex2000 --boot --sci8 --binary gives.

    Raises:
        InputError: they cannot be written.
    """
    files = directory / IMAGE_NAME, directory / KERNEL_NAME
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for file, program in zip(files, (image(), kernel()), strict=True):
            file.write_bytes(boot_stream.to_octets(program))
    except OSError as error:
        raise InputError(f"{directory}: cannot be written ({error.strerror})") from error
    return files


def is_kernel(program: Program) -> bool:
    """Whether a kernel is a demonstration's."""
    return program.word(layout.KERNEL_RAM.start) == layout.KERNEL_DEMONSTRATION


def _words(noise: random.Random, count: int) -> tuple[int, ...]:
    return tuple(noise.randrange(1 << 16) for _ in range(count))
