"""An image with its names, on a virtual board that stops where it is told to."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from stillspin import core
from stillspin.board import power
from stillspin.board.advancing import StoppedError, advancing
from stillspin.board.desk import TICKS_PER_SECOND
from stillspin.board.image import blocks_of
from stillspin.cases import profile
from stillspin.cases.profile import Profile
from stillspin.core import NativeCore, Plant
from stillspin.core_board import NativeBoard
from stillspin.counted import counted
from stillspin.errors import CampaignError, InputError
from stillspin.flash import layout, names, sections
from stillspin.flash.files import identity_of, read_boot_rom, read_program
from stillspin.flash.names import Names
from stillspin.flash.program import Program
from stillspin.image import foreign, remarks, runaway, unmodelled

SLICE = 1_000_000
"""Ticks between two looks at a board that runs to a place."""

WARNING = "warning: "
"""How what a user has to know of a run begins."""


@dataclass(frozen=True)
class Image:
    """A linked file."""

    file: Path
    program: Program
    names: Names
    remarks: Sequence[str] = ()
    """What a user has to know of the file, in words."""
    rom: core.Blocks = field(default_factory=list)
    """Words of the boot ROM."""
    foreign: str = ""
    """Why an F2808 does not run it, in words."""


def look(file: Path, rom: Path | None = None) -> Image:
    """A file with what it says of itself, and the file of the boot ROM's words that goes with it.

    Raises:
        InputError: it cannot be read.
    """
    program = sections.with_initial_values(file, read_program(file))
    there = names.read(file)
    blocks = [(block.address, list(block.words)) for block in read_boot_rom(rom)] if rom else []
    not_here = foreign.said(program, sections.read(file, program), there)
    return Image(file, program, there, [*there.damage, *remarks.of(file, program)], blocks, not_here)


def read(file: Path, rom: Path | None = None) -> Image:
    """The same of one that is to run.

    Raises:
        InputError: also where it has code for a C28x with more than an F2808 has.
    """
    image = look(file, rom)
    if image.foreign:
        raise InputError(f"{file}: {image.foreign}")
    return image


def identity(image: Image) -> str:
    """What an image of the drive says of itself; of another program, which does not, a sum over its words."""
    size = layout.IDENTITY_WORDS
    for block in image.program.blocks:
        at = layout.IDENTITY - block.address
        if not 0 <= at < len(block.words) or block.words[at] != layout.MARK:
            continue
        erased = (layout.ERASED,) * size  # what the file has not of it
        if found := identity_of((*block.words[at : at + size], *erased)[:size]):
            return found.text
    total = hashlib.sha256()
    for block in sorted(image.program.blocks, key=lambda block: block.address):
        total.update(b"".join(word.to_bytes(4, "little") for word in (block.address, *block.words)))
    return f"no identity, SHA-256 of its words {total.hexdigest()[:16]}"


def power_on(image: Image, profile_name: str, motor: str, seed: int) -> NativeBoard:
    """A virtual board that has just been switched on and executes the image.

    Raises:
        InputError: a plant that cannot be, or an image that begins nowhere.
    """
    native = core.load()
    chosen = profile.load(profile_name, core.plant_schema(native), core.parameters(native), motor)
    profile.say_not_stated(chosen)
    return power_with(native, image, chosen, seed)


def power_with(native: NativeCore, image: Image, chosen: Profile, seed: int) -> NativeBoard:
    """The same with a profile at hand."""
    board = power.power(native, chosen, profile.Changes(), seed, blocks_of(image.program, str(image.file)))
    _complete(board, image)
    return board


def power_plant(native: NativeCore, image: Image, plant: Plant, seed: int) -> NativeBoard:
    """The same with all of the plant at hand, as a run of a scenario has it.

    Raises:
        InputError: an image that begins nowhere.
        ValueError: the plant cannot be.
    """
    blocks = blocks_of(image.program, str(image.file))
    board = native.VirtualBoard(plant=plant, parameters={}, seed=seed, image=blocks)
    _complete(board, image)
    return board


def _complete(board: NativeBoard, image: Image) -> None:
    """Give it the boot ROM's words, and carry out TI's flash library on the model's cells, where the image has it."""
    board.load_rom(image.rom)

    def place(name: str) -> int:
        return image.names.of_name(name) or 0

    erase, program, verify = (place(f"Flash2808_{name}") for name in ("Erase", "Program", "Verify"))
    if erase or program or verify:
        board.replace_flash_library(erase, program, verify, place("Flash_CPUScaleFactor"))


def warnings(board: NativeBoard, image: Image) -> list[str]:
    """What a user of an image has to know of a run: that it ran away or was reset, what it used that is not there."""
    said = [f"{image.file.name}: {words}" for words in image.remarks]
    ran_away = runaway.said(board, image.names)
    said += [ran_away] if ran_away else []
    said += unmodelled.said(board, image.names)
    if resets := board.statistics()["resets"]:
        said.append(f"the watchdog reset the chip ({counted(resets, 'time')}), and the program began anew")
    return [f"{WARNING}{words}" for words in said]


def say(board: NativeBoard, image: Image) -> None:
    """Print them."""
    for words in warnings(board, image):
        print(words)


def placed(error: CampaignError, board: NativeBoard, image: Image) -> CampaignError:
    """The same error, of a board that stopped with where its program had come to."""
    if not isinstance(error, StoppedError):
        return error
    return CampaignError(f"{error}; the program had come to {image.names.place(board.registers()['PC'])}")


@contextmanager
def closing(board: NativeBoard, image: Image) -> Iterator[None]:
    """A board that is switched off at the end.

    Raises:
        CampaignError: as the block does; where a program that ran away has stopped the board, with where and why.
    """
    try:
        yield
    except CampaignError as error:
        for words in unmodelled.said(board, image.names):
            print(f"{WARNING}{words}")
        there = placed(error, board, image)
        if ran_away := runaway.said(board, image.names):
            raise CampaignError(f"{there}. Before that, {ran_away}") from error
        raise there from None
    finally:
        board.close()


def advance(board: NativeBoard, seconds: float) -> None:
    """Let time pass.

    Raises:
        CampaignError: the chip cannot go on.
    """
    with advancing():
        board.advance(round(seconds * TICKS_PER_SECOND))


def run_to(board: NativeBoard, places: Iterable[int], seconds: float) -> bool:
    """Let time pass until the core is about to execute the instruction at one of the places; false: it never was.

    Raises:
        CampaignError: the chip cannot go on.
    """
    board.stop_at(list(places))
    end = board.now + round(seconds * TICKS_PER_SECOND)
    try:
        with advancing():
            while board.now < end:
                board.advance(min(SLICE, end - board.now))
                if board.halted:
                    return True
    finally:
        board.stop_at([])
    return False


def step(board: NativeBoard, seconds: float) -> bool:
    """Execute one instruction; an interrupt that comes before it is entered first. False: the core sleeps for longer.

    Raises:
        CampaignError: the chip cannot go on.
    """
    board.stop_after(1)
    return run_to(board, (), seconds)
