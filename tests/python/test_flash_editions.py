"""An update over the serial port that brings another edition: what is stored stays, and the image says which it is.

The virtual board's flash holds an image of words that no compiler made; what it is switched on with afterwards is the
virtual drive of the edition that the identity in the flash names, with the memory that the board had before.
"""

from pathlib import Path

import flash_files as make
import pytest
from by_edition import SAVED, has, switch_on
from desk import needs_board
from flash_bench import KERNEL, flash_of, nothing

from stillspin.flash.files import DriveImage, drive_image
from stillspin.flash.program import Block
from stillspin.flash.update import connect, update
from stillspin.link.errors import DifferentError

pytestmark = needs_board

RESIDENT = Block(0x3F4020, tuple(range(0x1000, 0x1000 + 13000)))
"""In the place of what is the same in every edition (make image-check compares it)."""
SECTOR_A = make.UPDATE_END - make.START


PATCH = {"lab": 1, "drive": 2, "hil": 3}
"""Of each one's version, and what its own words are drawn by."""


def blocks_of(edition: str, resident: Block = RESIDENT) -> list[Block]:
    """An image's words."""
    return [*make.image_blocks(PATCH[edition], edition=edition), resident]


def image_of(edition: str, folder: Path, resident: Block = RESIDENT) -> DriveImage:
    file = folder / f"{edition}.out"
    file.write_bytes(make.coff(blocks_of(edition, resident)))
    return drive_image(file)


@pytest.mark.parametrize(("old", "new"), [("drive", "hil"), ("hil", "lab"), ("lab", "drive")])
def test_an_update_to_another_edition_keeps_what_is_stored(old: str, new: str, tmp_path: Path) -> None:
    memory = tmp_path / "eeprom"
    assert switch_on(old, memory, "set speed_ramp 600", "set can_node 5", "save")[-1] == SAVED
    with make.board(blocks_of(old)) as board:
        sector_a = flash_of(board)[SECTOR_A:]
        done = update(make.BoardLine(board), KERNEL, image_of(new, tmp_path), nothing)
        assert done.before and done.before.identity
        assert (done.before.identity.edition, done.erased) == (old, ("D", "C", "B"))
        assert flash_of(board)[SECTOR_A:] == sector_a, "the resident part is the board's"
        assert board.boots() == "drive"
        board.cycle(serial=True)
        after = connect(make.BoardLine(board), KERNEL, nothing).info()
    assert after.identity
    assert after.identity.text.startswith(f"0.1.{PATCH[new]} (edition {new}, commit c0ffee00")
    assert switch_on(after.identity.edition, memory, "version")[-1].endswith(f"edition {new}")
    assert has(after.identity.edition, memory, speed_ramp="600", can_node="5")


def test_an_edition_with_another_resident_part_is_refused_before_anything_is_erased(tmp_path: Path) -> None:
    other = Block(RESIDENT.address, (*RESIDENT.words[:-1], 0))
    with make.board(blocks_of("drive")) as board:
        with pytest.raises(DifferentError, match="sector A"):
            update(make.BoardLine(board), KERNEL, image_of("hil", tmp_path, other), nothing)
        assert flash_of(board) == make.cells(blocks_of("drive"))
