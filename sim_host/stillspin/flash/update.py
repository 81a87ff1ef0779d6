"""The whole way of an image onto a chip: loader, kernel, comparison, erase, write, verify, mark.

Whatever is wrong with files or board is found before the first sector is erased. After that the order makes the board
safe: the kernel takes the mark away first and puts it back last, and the boot code runs nothing without it. An update
that broke off is repeated as a whole; sectors that are already right are left alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from stillspin import resources
from stillspin.errors import InputError
from stillspin.flash import demonstration, layout, rom, virtual
from stillspin.flash import kernel as kernel_requests
from stillspin.flash.broken_off import BrokenOffError, Stage
from stillspin.flash.files import DriveImage
from stillspin.flash.image_sum import crc_of
from stillspin.flash.kernel import Info, Kernel
from stillspin.flash.layout import Sector
from stillspin.flash.line import Line, drop
from stillspin.flash.program import Program
from stillspin.link.errors import DifferentError, DriveError, NoAnswerError, RefusedError

_LETTERS = 3
_START_WAIT = 0.1
"""Seconds from the ROM's jump until the kernel hears: the PLL locks in 7 ms."""
_PROBES = 3

Progress = Callable[[str, float], None]
"""What is being done, and how much of it, 0 to 1."""


@dataclass(frozen=True)
class Outcome:
    """How an update or a comparison ended."""

    same: bool
    """The board had the image before anything was done."""
    erased: tuple[str, ...] = ()
    written: int = 0
    before: Info | None = None


def check_demonstration(line: Line, program: Program, image: DriveImage) -> None:
    """Refuse what no chip can run to everything but a virtual board; the first on a line.

    Raises:
        InputError: this is a demonstration, and no virtual board is there.
        LinkError: the port is lost.
    """
    if (image.identity.demonstration or demonstration.is_kernel(program)) and not virtual.is_at(line):
        raise InputError(
            f"{line.name}: no virtual board is there, and a demonstration image is for nothing else: a chip would run "
            "words that are no program. Nothing was loaded; stillspin loader starts a virtual board"
        )


def connect(line: Line, program: Program, progress: Progress) -> Kernel:
    """A kernel that runs and is what the file says, loaded by the boot ROM if it is not there yet.

    Raises:
        DriveError: neither ROM nor kernel answers, or something on the way is wrong.
    """
    line.set_rate(rom.RATE)
    progress("boot ROM", 0.0)
    if rom.locks(line, _LETTERS):
        rom.load(line, program, lambda done, total: progress("loading the kernel", done / total))
        line.set_rate(kernel_requests.RATE)
        drop(line, _START_WAIT)
    else:
        line.set_rate(kernel_requests.RATE)
        drop(line)
    kernel = Kernel(line)
    _check_kernel(kernel, line, program)
    return kernel


def _check_kernel(kernel: Kernel, line: Line, program: Program) -> None:
    try:
        info = kernel.info(_PROBES)
    except NoAnswerError:
        raise NoAnswerError(
            f"{line.name}: neither boot ROM nor flash kernel answers: set the jumpers to serial boot (GPIO18 and "
            "GPIO29 high, GPIO34 low), reset the board and repeat, also after an update that was interrupted"
        ) from None
    if info.protocol != kernel_requests.PROTOCOL:
        raise DifferentError(
            f"{line.name}: the kernel speaks protocol {info.protocol}, this program {kernel_requests.PROTOCOL}: build "
            "both from one commit"
        )
    for block in program.blocks:
        if kernel.crc(block.address, len(block.words)) != crc_of(block.words):
            raise DifferentError(
                f"{line.name}: the kernel in RAM differs from the file: reset the board and repeat; the flash "
                "was not touched"
            )


def check_board(kernel: Kernel, line: Line, image: DriveImage) -> Info:
    """Refuse a board that may not get this image, before anything is erased.

    Raises:
        DifferentError: another chip, one without boot code or with another sector A.
        RefusedError: a locked one.
    """
    info = kernel.info()

    def other(words: str) -> DifferentError:
        return DifferentError(f"{line.name}: {words}; nothing was erased")

    if info.part & 0xFF != layout.PART:
        raise other(f"the chip is no {layout.PART_NAME} (part 0x{info.part & 0xFF:02X}, wanted 0x{layout.PART:02X})")
    if info.locked:
        words = f"{line.name}: the chip is locked by passwords: open it over JTAG; nothing was erased"
        raise RefusedError(words, kernel_requests.Status.LOCKED)
    if not info.has_boot_entry:
        raise other(f"the board has no boot code in sector A: program it once over JTAG, see {resources.page('flash')}")
    for block in image.resident:
        if kernel.crc(block.address, len(block.words)) != crc_of(block.words):
            raise other(
                f"the image's sector A (boot code and resident part, from 0x{block.address:06X}) differs from the "
                "board's, and sector A is never written here: program the whole image over JTAG, see "
                f"{resources.page('flash')}"
            )
    return info


def differing(kernel: Kernel, image: DriveImage, info: Info) -> list[Sector]:
    """The sectors that have to be erased, so that all of them can be what they shall be."""
    sealed = info.mark == layout.MARK
    wrong = []
    for sector in layout.SECTORS:
        want = crc_of(image.piece(sector.words, sealed=sealed))
        if kernel.crc(sector.words.start, len(sector.words)) != want:
            wrong.append(sector)
    first = layout.SECTORS[0]
    if wrong and sealed and first not in wrong:
        wrong.insert(0, first)  # its mark goes first, and comes back only on erased words
    return wrong


def pieces(image: DriveImage, sector: Sector) -> Iterator[tuple[int, tuple[int, ...]]]:
    """What is written into an erased sector: address and words, without what stays erased at their ends."""
    words = image.piece(sector.words, sealed=False)
    used = np.flatnonzero(np.array(words) != layout.ERASED)
    while used.size:
        first = int(used[0])
        count = int(np.searchsorted(used, first + kernel_requests.WORDS_MAX))
        yield sector.words.start + first, words[first : int(used[count - 1]) + 1]
        used = used[count:]


def words_to_write(image: DriveImage, sector: Sector) -> int:
    """How many words of a sector are sent to it when it is erased."""
    return sum(len(words) for _, words in pieces(image, sector))


def verify(line: Line, program: Program, image: DriveImage, progress: Progress) -> Outcome:
    """Compare, and change nothing.

    Raises:
        InputError: see check_demonstration.
        DriveError: the board cannot be asked.
    """
    check_demonstration(line, program, image)
    kernel = connect(line, program, progress)
    info = check_board(kernel, line, image)
    progress("comparing", 0.0)
    wrong = differing(kernel, image, info)
    return Outcome(not wrong and info.mark == layout.MARK, tuple(s.name for s in wrong), before=info)


def update(line: Line, program: Program, image: DriveImage, progress: Progress) -> Outcome:
    """Bring an image onto the board, unless it is there already.

    Raises:
        InputError: see check_demonstration.
        DriveError: it is not there.
        BrokenOffError: after the first erase was asked for, or by Ctrl-C; it says what is on the chip.
    """
    check_demonstration(line, program, image)
    try:
        kernel = connect(line, program, progress)
        info = check_board(kernel, line, image)
        progress("comparing", 0.0)
        wrong = differing(kernel, image, info)
    except KeyboardInterrupt as error:
        raise BrokenOffError(error, Stage.BEFORE) from error
    if not wrong and info.mark == layout.MARK:
        return Outcome(True, before=info)
    written = _carry_out(kernel, image, wrong, progress)
    return Outcome(False, tuple(sector.name for sector in wrong), written, info)


def _carry_out(kernel: Kernel, image: DriveImage, wrong: list[Sector], progress: Progress) -> int:
    stage = Stage.BEGINNING if wrong else Stage.SEALING
    try:
        for index, sector in enumerate(wrong):
            progress(f"erasing sector {sector.name}", index / len(wrong))
            kernel.erase(sector)
            stage = Stage.ERASED
        todo = [piece for sector in wrong for piece in pieces(image, sector)]
        for index, (address, words) in enumerate(todo):
            kernel.write(address, words)
            progress("writing", (index + 1) / len(todo))
        progress("verifying", 0.0)
        stage = Stage.SEALING
        kernel.seal(crc_of(image.words))
    except (DriveError, KeyboardInterrupt) as error:
        raise BrokenOffError(error, stage) from error
    return sum(len(words) for _, words in todo)
