"""An update on the virtual chip as it should be: boot ROM, kernel, flash."""

from __future__ import annotations

import flash_files as make
import pytest
from desk import needs_board
from flash_bench import KERNEL, NEW, NEW_IMAGE, OLD, OLD_IMAGE, flash_of, nothing

from stillspin.flash import rom
from stillspin.flash.files import kernel_program
from stillspin.flash.program import Block
from stillspin.flash.update import connect, update, verify
from stillspin.link.errors import DriveError, LinkError, NoAnswerError

pytestmark = needs_board


def test_image_replaces_another_and_boots():
    with make.board(OLD) as board:
        assert board.boots() == "drive"
        board.cycle(serial=True)
        phases = []
        done = update(make.BoardLine(board), KERNEL, NEW_IMAGE, lambda what, share: phases.append((what, share)))
        assert not done.same
        assert done.erased == ("D", "C", "B")
        assert flash_of(board) == make.cells(NEW)
        assert done.before.identity.text.startswith("0.1.1")
        assert all(0.0 <= share <= 1.0 for _, share in phases)
        words = [what for what, _ in phases]
        assert sorted(set(words), key=words.index) == [
            "boot ROM",
            "loading the kernel",
            "comparing",
            "erasing sector D",
            "erasing sector C",
            "erasing sector B",
            "writing",
            "verifying",
        ]
        assert board.boots() == "drive"


def test_image_that_is_there_is_left_alone():
    with make.board(OLD) as board:
        done = update(make.BoardLine(board), KERNEL, OLD_IMAGE, nothing)
        assert done.same
        assert done.written == 0
        assert flash_of(board) == board.first


def test_only_sectors_that_differ_and_the_marks_own_are_erased():
    with make.board([*OLD[:3], Block(0x3EC010, (1, 2, 3)), *OLD[4:]]) as board:
        done = update(make.BoardLine(board), KERNEL, OLD_IMAGE, nothing)
        assert done.erased == ("D", "C")
        assert flash_of(board) == make.cells(OLD)


def test_image_that_lacks_its_mark_gets_it_and_nothing_else():
    unsealed = [Block(make.IDENTITY, (make.ERASED, *NEW[1].words[1:])) if b is NEW[1] else b for b in NEW]
    with make.board(unsealed) as board:
        assert board.boots() == "waiting"
        board.cycle(serial=True)
        done = update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
        assert (done.erased, done.written) == ((), 0)
        assert board.boots() == "drive"


def test_verify_compares_and_changes_nothing():
    with make.board(OLD) as board:
        assert verify(make.BoardLine(board), KERNEL, OLD_IMAGE, nothing).same
        assert verify(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing).erased == ("D", "C", "B")
        assert flash_of(board) == board.first


def test_kernel_that_runs_is_used_again_and_can_reset_the_chip():
    with make.board(OLD) as board:
        line = make.BoardLine(board)
        kernel = connect(line, KERNEL, nothing)
        assert board.native.running == "kernel"
        assert connect(line, KERNEL, nothing).info() == kernel.info()
        board.native.set_serial_boot(False)
        kernel.restart()
        board.native.advance(make.TICKS_PER_SECOND // 10)
        assert board.native.running == "drive"


# ---- boot ROM


def test_wrong_echo_is_noticed_at_its_octet():
    class Wrong(make.BoardLine):
        def read(self, most, timeout):
            octets = super().read(most, timeout)
            return octets.replace(b"\xaa", b"\xab", 1)

    with make.board(OLD) as board:
        line = Wrong(board)
        line.set_rate(rom.RATE)
        assert rom.locks(line, 1)
        with pytest.raises(LinkError, match=r"octet 1 of \d+ was 0xAA and came back as 0xAB"):
            rom.load(line, KERNEL, lambda _done, _all: None)


def test_rate_that_the_rom_cannot_make_is_no_answer():
    with make.board(OLD) as board:
        line = make.BoardLine(board)
        line.set_rate(115200)
        with pytest.raises(DriveError):
            connect_at_its_rate(line)


def connect_at_its_rate(line):
    """As `connect` does, but with the rate as it is."""
    if not rom.locks(line, 2):
        raise NoAnswerError("no echo")
    rom.load(line, KERNEL, lambda _done, _all: None)


def test_board_in_flash_boot_is_told_apart():
    with make.board(OLD) as board:
        board.cycle(serial=False)
        with pytest.raises(NoAnswerError, match="neither boot ROM nor flash kernel answers: set the jumpers"):
            update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
        assert flash_of(board) == board.first


def test_program_that_is_not_the_kernel_does_not_run(tmp_path):
    other = [Block(0x3FA000, (0x464B, 1, 5, 5, 5, 5))]
    (tmp_path / "other").write_bytes(make.boot_binary(other, make.KERNEL_ENTRY))
    with make.board(OLD) as board:
        with pytest.raises(NoAnswerError):
            update(make.BoardLine(board), kernel_program(tmp_path / "other"), NEW_IMAGE, nothing)
        assert board.native.running == "unknown"
        assert flash_of(board) == board.first
