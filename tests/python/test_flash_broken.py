"""Updates that something breaks off: noise, the cable pulled at every octet, the supply."""

from __future__ import annotations

import flash_files as make
import pytest
from desk import needs_board
from flash_bench import KERNEL, NEW, NEW_IMAGE, OLD, flash_of, nothing

from stillspin.flash import kernel as kernel_requests
from stillspin.flash import layout
from stillspin.flash.broken_off import BrokenOffError, Stage
from stillspin.flash.files import DriveImage
from stillspin.flash.image_sum import crc_of
from stillspin.flash.kernel import Kernel
from stillspin.flash.program import Block
from stillspin.flash.update import connect, update
from stillspin.link.errors import DriveError, LinkError

pytestmark = needs_board

ERASE_WAIT = 11 * make.TICKS_PER_SECOND


class NoisyLine(make.BoardLine):
    """Every seventh request to the kernel is damaged, and every fifth answer."""

    def __init__(self, board):
        super().__init__(board)
        self._at_kernel = False
        self.requests = self.answers = 0

    def set_rate(self, rate):
        super().set_rate(rate)
        self._at_kernel = rate == kernel_requests.RATE

    def write(self, octets):
        self.requests += self._at_kernel
        damaged = self._at_kernel and self.requests % 7 == 0
        super().write(octets[:-3] + b"\x55" + octets[-2:] if damaged else octets)

    def read(self, most, timeout):
        octets = super().read(most, timeout)
        if self._at_kernel and len(octets) > 4:
            self.answers += 1
            if self.answers % 5 == 0:
                return octets[:3] + bytes((octets[3] ^ 0x10,)) + octets[4:]
        return octets


def test_noise_costs_time_and_nothing_else():
    with make.board(OLD) as board:
        line = NoisyLine(board)
        update(line, KERNEL, NEW_IMAGE, nothing)
        assert line.requests > 14
        assert line.answers > 10
        assert flash_of(board) == make.cells(NEW)
        assert board.boots() == "drive"


# ---- the cable


def octets_in_all(image: DriveImage) -> int:
    """How many octets pass in an update that nothing disturbs."""
    with make.board(OLD) as board:
        line = make.CutLine(board, 1 << 30)
        update(line, KERNEL, image, nothing)
        return line.passed


def broken_off(board, image, cut_at):
    """An update whose cable is pulled; what the chip is doing comes to its end."""
    phase = [""]
    line = make.CutLine(board, cut_at)
    with pytest.raises(DriveError):
        update(line, KERNEL, image, lambda what, _share: phase.__setitem__(0, what))
    if phase[0].startswith("erasing") and line.whole:
        board.native.advance_until_heard(ERASE_WAIT)
    board.native.advance(make.TICKS_PER_SECOND // 100)  # words of a request are written within 6 ms
    return phase[0]


def check_broken_off(board):
    """Old image, new image, or none that would run; sector A as it was."""
    found = flash_of(board)
    assert found[make.UPDATE_END - make.START :] == board.first[make.UPDATE_END - make.START :]
    runs = board.boots()
    assert runs in {"drive", "waiting"}
    if runs == "drive":
        assert found in (board.first, make.cells(NEW))
    return runs


def test_cable_pulled_at_every_octet():
    total = octets_in_all(NEW_IMAGE)
    seen = set()
    for cut_at in range(total):
        with make.board(OLD) as board:
            phase = broken_off(board, NEW_IMAGE, cut_at)
            seen.add((phase, check_broken_off(board)))
            board.cycle(serial=True)
            update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
            assert flash_of(board) == make.cells(NEW), cut_at
            assert board.boots() == "drive", cut_at
    assert ("comparing", "drive") in seen
    assert ("erasing sector D", "waiting") in seen
    assert ("writing", "waiting") in seen
    assert ("verifying", "waiting") in seen
    assert ("verifying", "drive") in seen


def test_cable_pulled_and_put_back_without_a_reset():
    """The boot ROM has no time-out: then only a reset helps, and the words say so. A kernel just goes on."""
    total = octets_in_all(NEW_IMAGE)
    ends = set()
    for cut_at in range(0, total, 29):
        with make.board(OLD) as board:
            broken_off(board, NEW_IMAGE, cut_at)
            try:
                update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
                ends.add("goes on")
            except DriveError as error:
                assert "reset the board" in str(error)
                assert flash_of(board) == board.first
                ends.add("reset")
                board.cycle(serial=True)
                update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
            assert flash_of(board) == make.cells(NEW), cut_at
    assert ends == {"goes on", "reset"}


def unheard(board, ask):
    """A request whose answer nobody waits for."""
    line = make.CutLine(board, 1 << 30)
    line.read = lambda _most, _timeout: (_ for _ in ()).throw(LinkError("gone"))
    with pytest.raises(LinkError):
        ask(Kernel(line))


@pytest.mark.parametrize("share", [0.02, 0.3, 0.5, 0.9])
@pytest.mark.parametrize("sector", [0, 1, 2])
def test_power_that_fails_during_an_erase_leaves_a_board_that_waits(sector, share):
    """Of the model: the sector holds something, the mark is gone, a repeated update recovers. Chips: docs/flash.md."""
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), KERNEL, nothing)
        for done in layout.SECTORS[:sector]:
            kernel.erase(done)
        unheard(board, lambda kernel: kernel.erase(layout.SECTORS[sector]))
        board.native.advance(round(share * 10 * make.TICKS_PER_SECOND))
        assert check_broken_off(board) == "waiting"
        board.cycle(serial=True)
        update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
        assert flash_of(board) == make.cells(NEW)


@pytest.mark.parametrize("milliseconds", [21.0, 22.3, 24.7, 26.9, 40.0])
def test_power_that_fails_while_words_are_written_leaves_a_board_that_waits(milliseconds):
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), KERNEL, nothing)
        for sector in layout.SECTORS:
            kernel.erase(sector)
        erased = flash_of(board)
        unheard(board, lambda kernel: kernel.write(0x3EC000, tuple(range(112))))
        board.native.advance(round(milliseconds * make.TICKS_PER_SECOND / 1000))
        assert flash_of(board) != erased
        assert check_broken_off(board) == "waiting"
        board.cycle(serial=True)
        update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
        assert flash_of(board) == make.cells(NEW)


def test_power_that_fails_while_the_mark_is_written_leaves_all_or_nothing():
    unsealed = [Block(make.IDENTITY, (make.ERASED, *NEW[1].words[1:])) if b is NEW[1] else b for b in NEW]
    marks = set()
    for microseconds in range(2900, 3000, 8):
        with make.board(unsealed) as board:
            connect(make.BoardLine(board), KERNEL, nothing)
            unheard(board, lambda kernel: kernel.seal(crc_of(NEW_IMAGE.words)))
            board.native.advance(microseconds * make.TICKS_PER_SECOND // 1_000_000)
            mark = flash_of(board)[make.IDENTITY - make.START]
            marks.add(mark)
            assert check_broken_off(board) == ("drive" if mark == make.MARK else "waiting")
            board.cycle(serial=True)
            update(make.BoardLine(board), KERNEL, NEW_IMAGE, nothing)
            assert flash_of(board) == make.cells(NEW)
            assert board.boots() == "drive"
    assert {make.ERASED, make.MARK} < marks, "and something between"


# ---- what is said of it


def chip_runs(board):
    """What the chip does after a reset with the jumpers set back."""
    board.native.advance(make.TICKS_PER_SECOND // 100)
    return check_broken_off(board)


@pytest.mark.parametrize(
    ("phase", "stage", "runs"),
    [
        ("loading the kernel", Stage.BEFORE, "drive"),
        ("comparing", Stage.BEFORE, "drive"),
        ("erasing sector D", Stage.BEGINNING, "drive"),
        ("erasing sector C", Stage.ERASED, "waiting"),
        ("writing", Stage.ERASED, "waiting"),
        ("verifying", Stage.ERASED, "waiting"),
    ],
)
def test_ctrl_c_says_what_is_on_the_chip(phase, stage, runs):
    def stop_at(what, _share):
        if what == phase:
            raise KeyboardInterrupt

    with make.board(OLD) as board:
        with pytest.raises(BrokenOffError) as caught:
            update(make.BoardLine(board), KERNEL, NEW_IMAGE, stop_at)
        assert str(caught.value) == f"interrupted; {stage.value}"
        assert caught.value.exit_code == 130
        assert chip_runs(board) == runs


def test_a_pulled_cable_never_promises_an_image_that_is_not_there():
    """Sampled over the whole update: what is said fits what the chip does."""
    total = octets_in_all(NEW_IMAGE)
    said = set()
    for cut_at in range(0, total, 41):
        with make.board(OLD) as board:
            line = make.CutLine(board, cut_at)
            with pytest.raises(DriveError) as caught:
                update(line, KERNEL, NEW_IMAGE, nothing)
            assert caught.value.exit_code == 3
            stage = caught.value.stage if isinstance(caught.value, BrokenOffError) else None
            said.add(stage)
            board.native.advance_until_heard(ERASE_WAIT)
            runs = chip_runs(board)
            if stage is None:
                assert runs == "drive", cut_at
            elif stage is Stage.ERASED:
                assert runs == "waiting", cut_at
    assert {None, Stage.ERASED} <= said
