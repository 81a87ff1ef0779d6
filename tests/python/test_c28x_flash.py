"""TI's flash library in a program that is executed: its functions work on the virtual chip's cells, as they return."""

import pytest
from c28x_chip import MILLISECOND, ask, program, put, words

SECTOR = 0x3E8000
UP = 8 * MILLISECOND
CALLED = 658_300
"""Ticks: the PLL has locked, and the kernel calls the library."""
ERASE, WORD = 1_000_000_000, 5_000
TABLE = [0x1234, 0xFFFF, 0, 0xA5A5, 1, 2, 3, 4, *(10 * k + j for k in (1, 2, 3) for j in range(1, 9))]
FUNCTIONS = ("Flash2808_Erase", "Flash2808_Program", "Flash2808_Verify", "Flash_CPUScaleFactor")


def run(patch=(), before=(), until=UP + ERASE + 40 * WORD, moved=None):
    """Statuses, and what the flash holds, when the kernel has had its time."""
    made = program("flash")
    at = made.symbols
    places = [at[name.upper()] for name in FUNCTIONS]
    answers = ask([
        *put({**made.words, **dict(patch)}), *before, "library " + " ".join(f"{place:x}" for place in moved or places),
        f"run {until:x}", f"get {at['ERASED']:x} 6", f"get {at['STATUS']:x} 4", f"get {SECTOR:x} 28", "cycles",
        f"get {SECTOR + 0x3FFF:x} 2",
    ])  # fmt: skip
    there = [words(answer) for answer in answers[:3]]
    return at, *there, int(answers[3].split()[0]), words(answers[4])


DIRTY = [f"put {SECTOR:x} " + " ".join(["0"] * 40), f"put {SECTOR + 0x3FFF:x} 0 77"]


def test_the_kernel_erases_programs_and_verifies():
    _, statuses, failed, cells, cycles, around = run(before=DIRTY)
    assert statuses == [0, 0, 0, 4, (SECTOR + 32) & 0xFFFF, SECTOR >> 16]
    assert failed == [0, 0, 0, 0]
    assert cells[:32] == TABLE
    assert cells[32:] == [0xFFFF] * 8
    assert around == [0xFFFF, 0x77], "the sector to its end, and no word of the next"
    assert cycles > ERASE + 32 * WORD - MILLISECOND, "erasing and programming take the cells' time"


def test_it_takes_the_time_of_its_cells():
    _, statuses, _, cells, _, _ = run(before=DIRTY, until=CALLED + ERASE + 10 * WORD)
    assert statuses[0] == 0
    assert statuses[3] == 1, "eight of ten words' times are over, and the next eight are on their way"
    assert cells[:8] == TABLE[:8]
    assert cells[16:24] == [0xFFFF] * 8


def test_without_an_erase_zeros_stay():
    made = program("flash")
    at = made.symbols
    begin, call = at["KERNEL"], at["FLASH2808_ERASE"]
    (place,) = [
        address for address in range(begin, begin + 40)
        if made.words[address] == 0x7640 | call >> 16 and made.words[address + 1] == call & 0xFFFF
    ]  # fmt: skip
    skipped = {place: 0x9A00, place + 1: 0x7700}  # MOVB AL,#0; NOP
    _, statuses, failed, _, _, _ = run(patch=skipped, before=DIRTY, until=UP + 40 * WORD)
    assert statuses[1] == 31, "a bit that is 0 and should be 1"
    assert failed[:2] == [SECTOR & 0xFFFF, SECTOR >> 16]
    assert failed[2:] == [0x1234, 0]
    assert statuses[3] == 0


@pytest.mark.parametrize(("place", "statuses"), [(0x3F8000, 12), (0x3DFFF0, 12)])
def test_outside_of_the_flash_nothing_is_programmed(place, statuses):
    made = program("flash")
    load = [address for address in made.words if made.words[address] == 0x8F3E and made.words[address + 1] == 0x8000]
    assert len(load) == 1, "MOVL XAR4,#SECTOR"
    elsewhere = {load[0]: 0x8F00 | place >> 16, load[0] + 1: place & 0xFFFF}
    assert run(patch=elsewhere)[1][1] == statuses


def test_a_library_that_was_left_in_the_flash_is_refused():
    made = program("flash")
    places = [made.symbols[name.upper()] for name in FUNCTIONS]
    with pytest.raises(AssertionError, match="not copied to RAM"):
        run(moved=[made.symbols["MAIN"], *places[1:]])


def test_the_wrong_scale_is_refused():
    made = program("flash")
    high = [address for address in made.words if made.words[address] == 0x0140]
    assert len(high) == 1
    with pytest.raises(AssertionError, match="Flash_CPUScaleFactor"):
        run(patch={high[0]: 0x0141})
