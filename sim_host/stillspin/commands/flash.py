"""`stillspin flash`: the firmware onto the chip, over the serial port."""

from __future__ import annotations

import shlex
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from stillspin import resources
from stillspin.called import called
from stillspin.counted import counted
from stillspin.errors import InputError
from stillspin.exit_codes import ExitCode
from stillspin.flash import demonstration, layout
from stillspin.flash.broken_off import BrokenOffError
from stillspin.flash.files import DriveImage, drive_image, kernel_program
from stillspin.flash.kernel import Info, Kernel
from stillspin.flash.line import SerialLine
from stillspin.flash.update import Outcome, Progress, update, verify, words_to_write
from stillspin.link import address
from stillspin.link.errors import DriveError
from stillspin.report.progress import PhaseBar

KERNEL_NAMES = ("stillspin_flash_kernel.out", demonstration.KERNEL_NAME)
"""Beside the image, unless --kernel says otherwise; the first that is there."""


def flash(
    *,
    image_file: Annotated[
        Path, typer.Argument(metavar="IMAGE", help="COFF (.out), Intel hex or hex2000's boot stream.")
    ],
    port: Annotated[
        str, typer.Option("--port", metavar="PORT", help="The board's serial port, such as /dev/ttyUSB0.")
    ] = "",
    kernel_file: Annotated[
        Path | None,
        typer.Option("--kernel", metavar="FILE", help=f"The flash kernel [default: {KERNEL_NAMES[0]} beside IMAGE]."),
    ] = None,
    only_verify: Annotated[
        bool, typer.Option("--verify", help="Compare only; exit status 4 when they differ.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Check the files and say what would be done; opens no port.")
    ] = False,
) -> None:
    """Load the flash kernel through the boot ROM, then erase, write and verify sectors B to D; never sector A.

    The board has to be in serial boot: jumpers set, then a reset. An update that broke off is repeated the same way.
    Exit status 0 when the board has the image.
    """
    image = drive_image(image_file)
    print(f"image:  {image.identity.text}, {counted(image.size, 'word')} in sectors B to D")
    if not image.summed:
        print("note:   the image has no check sum: the board's self-test will not know whether its flash is right")
    kernel = kernel_program(kernel_file or kernel_beside(image_file))
    print(f"kernel: {counted(kernel.size, 'word')}, {kernel.kind}")
    if dry_run:
        _tell_plan(image)
        return
    with SerialLine(_port(port)) as line:
        action = verify if only_verify else update
        try:
            with PhaseBar(Console(stderr=True)) as bar:
                outcome = action(line, kernel, image, _shown(bar))
        except BrokenOffError as error:
            raise error.with_remedy(_command(image_file, port, kernel_file)) from error
        with suppress(DriveError):
            Kernel(line).restart()
    if outcome.before:
        print(f"before: {_state(outcome.before)}")
    if only_verify:
        _tell_comparison(outcome)
    else:
        _tell_update(outcome)


def demo_image(
    *, directory: Annotated[Path, typer.Argument(metavar="DIRECTORY", help="Where the two files go; made if need be.")]
) -> None:
    """Make an image and a flash kernel to try `stillspin flash` on a virtual board; other boards are refused."""
    image, kernel = demonstration.write(directory)
    print(f"image:  {image}\nkernel: {kernel}")
    print(
        f"try:    {called()} loader {directory / 'flash.bin'}  # a virtual board in serial boot, which names its port"
    )
    print(f"        {called()} flash {image} --port PORT")


def _command(image_file: Path, port: str, kernel_file: Path | None) -> str:
    """The command line of an update, as a shell takes it."""
    kernel = ["--kernel", str(kernel_file)] if kernel_file else []
    return shlex.join([called(), "flash", str(image_file), *kernel, "--port", port])


def kernel_beside(file: Path) -> Path:
    """The kernel that lies beside a file.

    Raises:
        InputError: there is none.
    """
    for name in KERNEL_NAMES:
        if (file.parent / name).exists():
            return file.parent / name
    missing = file.parent / KERNEL_NAMES[0]
    raise InputError(f"there is no flash kernel {missing}; give --kernel FILE ({resources.page('flash')})")


def _port(text: str) -> str:
    if not text:
        raise InputError("no port is given: --port /dev/ttyUSB0")
    parsed = address.parse(text)
    if parsed.kind != "serial":
        raise InputError(f"--port {text}: must be a serial port; the boot ROM loads over nothing else")
    return parsed.channel


def _shown(bar: PhaseBar) -> Progress:
    def show(phase: str, share: float) -> None:
        bar.show(share, phase)

    return show


def _state(info: Info) -> str:
    chip = f"{layout.PART_NAME} revision {info.revision}"
    if info.mark == layout.MARK and info.identity:
        return f"{chip}, {info.identity.text}"
    return f"{chip}, no complete image"


def _tell_plan(image: DriveImage) -> None:
    for sector in layout.SECTORS:
        words = words_to_write(image, sector)
        print(f"sector {sector.name}: erase, then {counted(words, 'word')}")
    kept = sum(len(block.words) for block in image.resident)
    print(f"sector A: not written; {counted(kept, 'word')} of boot code and resident part to compare with the board's")
    print("dry run: nothing was sent")


def _tell_comparison(outcome: Outcome) -> None:
    if outcome.same:
        print("the board has this image")
        return
    where = f"sectors {', '.join(outcome.erased)} differ" if outcome.erased else "only its mark is missing"
    print(f"the board has not this image: {where}")
    raise typer.Exit(ExitCode.DIFFERS)


def _tell_update(outcome: Outcome) -> None:
    if outcome.same:
        print("the board has this image already: nothing was erased or written")
    else:
        erased = f"sectors {', '.join(outcome.erased)} erased" if outcome.erased else "nothing erased"
        print(f"{erased}, {counted(outcome.written, 'word')} written and verified, image complete")
    print("set the jumpers back (GPIO18, GPIO29, GPIO34 high: boot from flash) and reset the board")
