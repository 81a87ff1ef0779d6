"""What the host refuses before it erases, and the kernel whatever the host asks."""

from __future__ import annotations

import random

import flash_files as make
import pytest
from desk import needs_board
from flash_bench import KERNEL, NEW_IMAGE, OLD, OLD_IMAGE, flash_of, nothing

from stillspin.flash import kernel as kernel_requests
from stillspin.flash import layout
from stillspin.flash.files import drive_image
from stillspin.flash.line import drop
from stillspin.flash.program import Block
from stillspin.flash.update import connect, update
from stillspin.link.errors import DriveError, RefusedError
from stillspin.link.records import Record, to_wire

pytestmark = needs_board


def refused(board, image, blamed):
    with pytest.raises(DriveError, match=blamed):
        update(make.BoardLine(board), KERNEL, image, nothing)
    assert flash_of(board) == board.first, "nothing was erased"


def test_image_with_other_boot_code_is_refused():
    boot = (Block(0x3F4000, (0x561F, 0x7029, 0x761F, 0x0002)), make.BOOT[1])
    with make.board(make.image_blocks(1, boot=boot)) as board:
        refused(board, NEW_IMAGE, "sector A .* differs from the board's")


def resident_part(seed):
    noise = random.Random(seed)
    return Block(0x3F4020, tuple(noise.randrange(0x10000) for _ in range(16200)))


def image_with(tmp_path, seed, resident):
    file = tmp_path / f"{seed}.bin"
    file.write_bytes(make.boot_binary(make.image_blocks(seed, boot=(*make.BOOT, resident)), 0x3F4000))
    return drive_image(file)


def test_image_whose_resident_part_is_the_boards_is_taken(tmp_path):
    resident = resident_part(7)
    with make.board(make.image_blocks(1, boot=(*make.BOOT, resident))) as board:
        image = image_with(tmp_path, 2, resident)
        update(make.BoardLine(board), KERNEL, image, nothing)
        new = flash_of(board)
        assert new != board.first
        assert new == make.cells(make.image_blocks(2, boot=(*make.BOOT, resident)))


@pytest.mark.parametrize("place", [0, 7777, 16199])
def test_image_with_one_other_word_in_its_resident_part_is_refused(tmp_path, place):
    resident = resident_part(7)
    words = list(resident.words)
    words[place] ^= 1
    with make.board(make.image_blocks(1, boot=(*make.BOOT, resident))) as board:
        refused(
            board,
            image_with(tmp_path, 2, Block(resident.address, tuple(words))),
            "sector A .* differs from the board's",
        )


def test_board_without_boot_code_is_refused():
    with make.board(make.image_blocks(1, boot=())) as board:
        refused(board, NEW_IMAGE, "no boot code in sector A")


def test_locked_board_is_refused():
    with make.board([*OLD, Block(0x3F7FF8, tuple(range(1, 9)))]) as board:
        refused(board, NEW_IMAGE, "locked by passwords")


def test_another_chip_is_refused(monkeypatch):
    monkeypatch.setattr(layout, "PART", 0x0034)
    with make.board(OLD) as board:
        refused(board, NEW_IMAGE, "the chip is no")


def test_kernel_that_is_damaged_in_ram_is_refused(monkeypatch):
    monkeypatch.setattr("stillspin.flash.update.crc_of", lambda _words: 0)
    with make.board(OLD) as board:
        refused(board, OLD_IMAGE, "differs from the file")


@pytest.fixture
def kernel():
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), KERNEL, nothing)
        kernel.board = board
        yield kernel
        assert flash_of(board)[make.UPDATE_END - make.START :] == board.first[make.UPDATE_END - make.START :]


A, D = layout.Sector("A", 0, layout.SECTOR_A), layout.SECTORS[0]


@pytest.mark.parametrize("number", [0, 4, 255])
def test_kernel_erases_no_other_sector(kernel, number):
    with pytest.raises(RefusedError) as caught:
        kernel.erase(layout.Sector("?", number, range(0)))
    assert caught.value.status == kernel_requests.Status.RANGE
    assert flash_of(kernel.board) == kernel.board.first, "not even the mark"


@pytest.mark.parametrize(
    ("address", "words"),
    [
        (0x3F4000, (0,)),
        (0x3F3FFF, (0, 0)),
        (0x3F7FF8, (0,) * 8),
        (0x3E7FFF, (0, 0)),
        (0x000480, (0,)),
        (0xFFFFFFFF, (0, 0)),
        (make.IDENTITY, (make.MARK,)),
        (make.IDENTITY - 3, (1, 2, 3, make.MARK)),
    ],
)
def test_kernel_writes_nowhere_else_and_no_mark(kernel, address, words):
    kernel.erase(D)
    with pytest.raises(RefusedError) as caught:
        kernel.write(address, words)
    assert caught.value.status == kernel_requests.Status.RANGE


def test_kernel_writes_nothing_while_the_image_is_sealed(kernel):
    with pytest.raises(RefusedError) as caught:
        kernel.write(0x3E9000, (1,))
    assert caught.value.status == kernel_requests.Status.STATE


def test_kernel_says_where_a_zero_should_be_a_one(kernel):
    kernel.erase(D)
    kernel.write(0x3E9000, (0xFFFF, 0x00FF))
    with pytest.raises(RefusedError, match=r"0x3E9001 \(code 31"):
        kernel.write(0x3E9000, (0xFFFF, 0xFF00))


def test_kernel_seals_only_what_has_the_right_sum(kernel):
    kernel.erase(D)
    with pytest.raises(RefusedError) as caught:
        kernel.seal(0x12345678)
    assert caught.value.status == kernel_requests.Status.STATE
    assert kernel.info().mark == make.ERASED


def test_kernel_does_a_request_that_comes_twice_once(kernel):
    kernel.erase(D)
    kernel.write(0x3E9000, (1, 2, 3))
    kernel.write(0x3E9000, (1, 2, 3))
    assert flash_of(kernel.board)[0x1000:0x1003] == [1, 2, 3]


@pytest.mark.parametrize(
    ("kind", "body", "status"),
    [
        (0x30, b"x", 4),
        (0x31, b"", 4),
        (0x31, b"\3\3", 4),
        (0x32, bytes(4), 4),
        (0x32, bytes(7), 4),
        (0x32, bytes(230), 4),
        (0x33, bytes(7), 4),
        (0x33, bytes(8), 2),
        (0x33, (0x3F7FFF).to_bytes(4, "little") + b"\2\0\0\0", 2),
        (0x34, bytes(3), 4),
        (0x35, b"x", 4),
        (0x36, b"", 1),
        (0x01, b"", 1),
    ],
)
def test_kernel_refuses_what_it_does_not_know(kernel, kind, body, status):
    class Kind(int):
        name = "?"

    with pytest.raises(RefusedError) as caught:
        kernel._ask(Kind(kind), body)
    assert caught.value.status == status
    assert flash_of(kernel.board) == kernel.board.first


def test_kernel_stands_any_octets_and_records(kernel):
    noise = random.Random(5)
    line = make.BoardLine(kernel.board)
    for _ in range(300):
        line.write(noise.randbytes(noise.randrange(1, 80)))
        kind = noise.choice((0x30, 0x31, 0x32, 0x33, 0x34, noise.randrange(0x36, 0x40)))
        line.write(to_wire(Record(kind, noise.randrange(256), noise.randbytes(noise.choice((0, 1, 4, 6, 8, 40))))))
        line.read(512, 0.05)
    drop(line)
    assert kernel.info().part & 0xFF == 0x3C
    # Whatever was erased or written, the mark is only there when the image is.
    found = flash_of(kernel.board)
    assert found == kernel.board.first or found[make.IDENTITY - make.START] != make.MARK
