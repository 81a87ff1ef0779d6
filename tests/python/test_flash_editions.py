"""An update over the serial port that brings another edition: what is stored stays.

The virtual board's flash holds an image of words that no compiler made, of each edition others; what it is switched on
with afterwards is the virtual drive of the edition whose words are in the flash, with the memory that the board had
before.
"""

from pathlib import Path

import flash_files as make
import pytest
from desk import needs_board
from flash_bench import KERNEL, flash_of, nothing
from test_editions import SAVED, has, switch_on

from stillspin.flash.files import DriveImage, drive_image
from stillspin.flash.program import Block
from stillspin.flash.update import update
from stillspin.link.errors import DifferentError

pytestmark = needs_board

RESIDENT = Block(0x3F4020, tuple(range(0x1000, 0x1000 + 13000)))
"""In the place of what is the same in every edition (make image-check compares it)."""


PATCH = {"lab": 1, "drive": 2, "hil": 3}
"""Of each one's version, and what its own words are drawn by."""


def blocks_of(edition: str, resident: Block = RESIDENT) -> list[Block]:
    """An image's words."""
    return [*make.image_blocks(PATCH[edition]), resident]


def image_of(edition: str, folder: Path, resident: Block = RESIDENT) -> DriveImage:
    file = folder / f"{edition}.out"
    file.write_bytes(make.coff(blocks_of(edition, resident)))
    return drive_image(file)


def in_flash(board: make.Board) -> str:
    """The edition whose image the flash holds, word for word."""
    return next(edition for edition in PATCH if flash_of(board) == make.cells(blocks_of(edition)))


@pytest.mark.parametrize(("old", "new"), [("drive", "hil"), ("hil", "lab"), ("lab", "drive")])
def test_an_update_to_another_edition_keeps_what_is_stored(old: str, new: str, tmp_path: Path) -> None:
    memory = tmp_path / "eeprom"
    with make.board(blocks_of(old)) as board:
        assert switch_on(in_flash(board), memory, "set speed_ramp 600", "set can_node 5", "save")[-1] == SAVED
        done = update(make.BoardLine(board), KERNEL, image_of(new, tmp_path), nothing)
        assert done.erased == ("D", "C", "B"), "sector A, with the resident part, is the board's"
        assert board.boots() == "drive"
        now = in_flash(board)
    assert now == new
    assert switch_on(now, memory, "version")[-1].endswith(f"edition {new}")
    assert has(now, memory, speed_ramp="600", can_node="5")


def test_an_edition_with_another_resident_part_is_refused_before_anything_is_erased(tmp_path: Path) -> None:
    other = Block(RESIDENT.address, (*RESIDENT.words[:-1], 0))
    with make.board(blocks_of("drive")) as board:
        with pytest.raises(DifferentError, match="sector A"):
            update(make.BoardLine(board), KERNEL, image_of("hil", tmp_path, other), nothing)
        assert flash_of(board) == make.cells(blocks_of("drive"))
