"""The whole protocol on the virtual chip: boot ROM, kernel, flash; the cable pulled at every octet."""

from __future__ import annotations

import random

import flash_files as make
import pytest
from desk import needs_board

from stillspin.flash import kernel as kernel_requests
from stillspin.flash import layout, rom
from stillspin.flash.files import DriveImage, drive_image, kernel_program
from stillspin.flash.image_sum import crc_of
from stillspin.flash.kernel import Kernel
from stillspin.flash.line import drop
from stillspin.flash.program import Block
from stillspin.flash.update import connect, update, verify
from stillspin.link.errors import DriveError, LinkError, NoAnswerError, RefusedError
from stillspin.link.records import Record, to_wire

pytestmark = needs_board

OLD, NEW = make.image_blocks(1), make.image_blocks(2)
ERASE_WAIT = 11 * make.TICKS_PER_SECOND


def nothing(_what, _share):
    """A progress that nobody watches."""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Old and new image and the kernel, as read from files."""
    where = tmp_path_factory.mktemp("flash")
    (where / "old").write_bytes(make.coff(OLD))
    (where / "new").write_bytes(make.intel_hex(NEW))
    (where / "kernel").write_bytes(make.boot_ascii(make.kernel_blocks(), make.KERNEL_ENTRY))
    return drive_image(where / "old"), drive_image(where / "new"), kernel_program(where / "kernel")


@pytest.fixture
def old(files):
    return files[0]


@pytest.fixture
def new(files):
    return files[1]


@pytest.fixture
def program(files):
    return files[2]


def flash_of(board):
    return list(board.native.flash)


# ---- the way as it should be


def test_image_replaces_another_and_boots(new, program):
    with make.board(OLD) as board:
        assert board.boots() == "drive"
        board.cycle(serial=True)
        phases = []
        done = update(make.BoardLine(board), program, new, lambda what, share: phases.append((what, share)))
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


def test_image_that_is_there_is_left_alone(old, program):
    with make.board(OLD) as board:
        done = update(make.BoardLine(board), program, old, nothing)
        assert done.same
        assert done.written == 0
        assert flash_of(board) == board.first


def test_only_sectors_that_differ_and_the_marks_own_are_erased(old, program):
    with make.board([*OLD[:3], Block(0x3EC010, (1, 2, 3)), *OLD[4:]]) as board:
        done = update(make.BoardLine(board), program, old, nothing)
        assert done.erased == ("D", "C")
        assert flash_of(board) == make.cells(OLD)


def test_image_that_lacks_its_mark_gets_it_and_nothing_else(new, program):
    unsealed = [Block(make.IDENTITY, (make.ERASED, *NEW[1].words[1:])) if b is NEW[1] else b for b in NEW]
    with make.board(unsealed) as board:
        assert board.boots() == "waiting"
        board.cycle(serial=True)
        done = update(make.BoardLine(board), program, new, nothing)
        assert (done.erased, done.written) == ((), 0)
        assert board.boots() == "drive"


def test_verify_compares_and_changes_nothing(old, new, program):
    with make.board(OLD) as board:
        assert verify(make.BoardLine(board), program, old, nothing).same
        assert verify(make.BoardLine(board), program, new, nothing).erased == ("D", "C", "B")
        assert flash_of(board) == board.first


def test_kernel_that_runs_is_used_again_and_can_reset_the_chip(new, program):
    with make.board(OLD) as board:
        line = make.BoardLine(board)
        kernel = connect(line, program, nothing)
        assert board.native.running == "kernel"
        assert connect(line, program, nothing).info() == kernel.info()
        board.native.set_serial_boot(False)
        kernel.restart()
        board.native.advance(make.TICKS_PER_SECOND // 10)
        assert board.native.running == "drive"


# ---- boot ROM


def test_wrong_echo_is_noticed_at_its_octet(program):
    class Wrong(make.BoardLine):
        def read(self, most, timeout):
            octets = super().read(most, timeout)
            return octets.replace(b"\xaa", b"\xab", 1)

    with make.board(OLD) as board:
        line = Wrong(board)
        line.set_rate(rom.RATE)
        assert rom.locks(line, 1)
        with pytest.raises(LinkError, match=r"octet 1 of \d+ was 0xAA and came back as 0xAB"):
            rom.load(line, program, lambda _done, _all: None)


def test_rate_that_the_rom_cannot_make_is_no_answer(program):
    with make.board(OLD) as board:
        line = make.BoardLine(board)
        line.set_rate(115200)
        with pytest.raises(DriveError):
            connect_at_its_rate(line, program)


def connect_at_its_rate(line, program):
    """As `connect` does, but with the rate as it is."""
    if not rom.locks(line, 2):
        raise NoAnswerError("no echo")
    rom.load(line, program, lambda _done, _all: None)


def test_board_in_flash_boot_is_told_apart(new, program):
    with make.board(OLD) as board:
        board.cycle(serial=False)
        with pytest.raises(NoAnswerError, match="neither boot ROM nor flash kernel answers: set the jumpers"):
            update(make.BoardLine(board), program, new, nothing)
        assert flash_of(board) == board.first


def test_program_that_is_not_the_kernel_does_not_run(files, tmp_path, new):
    other = [Block(0x3FA000, (0x464B, 1, 5, 5, 5, 5))]
    (tmp_path / "other").write_bytes(make.boot_binary(other, make.KERNEL_ENTRY))
    with make.board(OLD) as board:
        with pytest.raises(NoAnswerError):
            update(make.BoardLine(board), kernel_program(tmp_path / "other"), new, nothing)
        assert board.native.running == "unknown"
        assert flash_of(board) == board.first


# ---- what the host refuses before it erases, and the kernel whatever the host asks


def refused(board, program, image, blamed):
    with pytest.raises(DriveError, match=blamed):
        update(make.BoardLine(board), program, image, nothing)
    assert flash_of(board) == board.first, "nothing was erased"


def test_image_with_other_boot_code_is_refused(new, program):
    boot = (Block(0x3F4000, (0x561F, 0x7029, 0x761F, 0x0002)), make.BOOT[1])
    with make.board(make.image_blocks(1, boot=boot)) as board:
        refused(board, program, new, "other boot code")


def test_board_without_boot_code_is_refused(new, program):
    with make.board(make.image_blocks(1, boot=())) as board:
        refused(board, program, new, "no boot code in sector A")


def test_locked_board_is_refused(new, program):
    with make.board([*OLD, Block(0x3F7FF8, tuple(range(1, 9)))]) as board:
        refused(board, program, new, "locked by passwords")


def test_another_chip_is_refused(new, program, monkeypatch):
    monkeypatch.setattr(layout, "PART", 0x0034)
    with make.board(OLD) as board:
        refused(board, program, new, "the chip is no")


def test_kernel_that_is_damaged_in_ram_is_refused(old, program, monkeypatch):
    monkeypatch.setattr("stillspin.flash.update.crc_of", lambda _words: 0)
    with make.board(OLD) as board:
        refused(board, program, old, "not the one of the file")


@pytest.fixture
def kernel(program):
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), program, nothing)
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


def test_kernel_seals_only_what_has_the_right_sum(kernel, old):
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


def test_noise_costs_time_and_nothing_else(new, program):
    with make.board(OLD) as board:
        line = NoisyLine(board)
        update(line, program, new, nothing)
        assert line.requests > 14
        assert line.answers > 10
        assert flash_of(board) == make.cells(NEW)
        assert board.boots() == "drive"


# ---- the cable


def octets_in_all(image: DriveImage, program) -> int:
    """How many octets pass in an update that nothing disturbs."""
    with make.board(OLD) as board:
        line = make.CutLine(board, 1 << 30)
        update(line, program, image, nothing)
        return line.passed


def broken_off(board, program, image, cut_at):
    """An update whose cable is pulled; what the chip is doing comes to its end."""
    phase = [""]
    line = make.CutLine(board, cut_at)
    with pytest.raises(DriveError):
        update(line, program, image, lambda what, _share: phase.__setitem__(0, what))
    if phase[0].startswith("erasing") and line.whole:
        board.native.advance_until_heard(ERASE_WAIT)
    board.native.advance(make.TICKS_PER_SECOND // 50)
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


def test_cable_pulled_at_every_octet(new, program):
    total = octets_in_all(new, program)
    seen = set()
    for cut_at in range(total):
        with make.board(OLD) as board:
            phase = broken_off(board, program, new, cut_at)
            seen.add((phase, check_broken_off(board)))
            board.cycle(serial=True)
            update(make.BoardLine(board), program, new, nothing)
            assert flash_of(board) == make.cells(NEW), cut_at
            assert board.boots() == "drive", cut_at
    assert ("comparing", "drive") in seen
    assert ("erasing sector D", "waiting") in seen
    assert ("writing", "waiting") in seen
    assert ("verifying", "waiting") in seen
    assert ("verifying", "drive") in seen


def test_cable_pulled_and_put_back_without_a_reset(new, program):
    """The boot ROM has no time-out: then only a reset helps, and the words say so. A kernel just goes on."""
    total = octets_in_all(new, program)
    ends = set()
    for cut_at in range(0, total, 29):
        with make.board(OLD) as board:
            broken_off(board, program, new, cut_at)
            try:
                update(make.BoardLine(board), program, new, nothing)
                ends.add("goes on")
            except DriveError as error:
                assert "reset the board" in str(error)
                assert flash_of(board) == board.first
                ends.add("reset")
                board.cycle(serial=True)
                update(make.BoardLine(board), program, new, nothing)
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
def test_power_that_fails_during_an_erase_leaves_a_board_that_waits(new, program, sector, share):
    """Of the model: the sector holds something, the mark is gone, a repeated update recovers. Chips: docs/flash.md."""
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), program, nothing)
        for done in layout.SECTORS[:sector]:
            kernel.erase(done)
        unheard(board, lambda kernel: kernel.erase(layout.SECTORS[sector]))
        board.native.advance(round(share * 10 * make.TICKS_PER_SECOND))
        assert check_broken_off(board) == "waiting"
        board.cycle(serial=True)
        update(make.BoardLine(board), program, new, nothing)
        assert flash_of(board) == make.cells(NEW)


@pytest.mark.parametrize("milliseconds", [21.0, 22.3, 24.7, 26.9, 40.0])
def test_power_that_fails_while_words_are_written_leaves_a_board_that_waits(new, program, milliseconds):
    with make.board(OLD) as board:
        kernel = connect(make.BoardLine(board), program, nothing)
        for sector in layout.SECTORS:
            kernel.erase(sector)
        erased = flash_of(board)
        unheard(board, lambda kernel: kernel.write(0x3EC000, tuple(range(112))))
        board.native.advance(round(milliseconds * make.TICKS_PER_SECOND / 1000))
        assert flash_of(board) != erased
        assert check_broken_off(board) == "waiting"
        board.cycle(serial=True)
        update(make.BoardLine(board), program, new, nothing)
        assert flash_of(board) == make.cells(NEW)


def test_power_that_fails_while_the_mark_is_written_leaves_all_or_nothing(new, program):
    unsealed = [Block(make.IDENTITY, (make.ERASED, *NEW[1].words[1:])) if b is NEW[1] else b for b in NEW]
    marks = set()
    for microseconds in range(2900, 3000, 8):
        with make.board(unsealed) as board:
            connect(make.BoardLine(board), program, nothing)
            unheard(board, lambda kernel: kernel.seal(crc_of(new.words)))
            board.native.advance(microseconds * make.TICKS_PER_SECOND // 1_000_000)
            mark = flash_of(board)[make.IDENTITY - make.START]
            marks.add(mark)
            assert check_broken_off(board) == ("drive" if mark == make.MARK else "waiting")
            board.cycle(serial=True)
            update(make.BoardLine(board), program, new, nothing)
            assert flash_of(board) == make.cells(NEW)
            assert board.boots() == "drive"
    assert {make.ERASED, make.MARK} < marks, "and something between"
