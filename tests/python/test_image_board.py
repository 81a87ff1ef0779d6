"""Machine code on the virtual board, with its plant and its plugs, and from the command line."""

import os
import re
import select
import subprocess
import sys
import time

import pytest
from c28x_chip import MILLISECOND, blocks, program
from flash_files import coff, intel_hex
from in_process import stillspin

from stillspin import core
from stillspin.board.image import blocks_of
from stillspin.errors import InputError
from stillspin.flash.program import Block, Program

PLANT = {"solver": {"method": "rk4"}}


def file_blocks(name):
    return [Block(first, tuple(words)) for first, words in blocks(program(name).words)]


@pytest.fixture
def board():
    made = []

    def make(name):
        made.append(core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1, image=blocks(program(name).words)))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_the_serial_plug_is_the_boards(board):
    desk = board("echo")
    desk.advance(8 * MILLISECOND)
    desk.serial_write(b"stillspin")
    desk.advance(3 * MILLISECOND)
    assert desk.serial_read() == b"STILLSPIN"
    assert desk.serial_counts()["drive_rate"] == pytest.approx(115200, rel=0.01)
    assert desk.statistics()["lost_writes"] == 0


def test_a_program_finds_the_registers_that_the_boot_rom_leaves(board):
    """TI's boot ROM ends with all of them cleared, OBJMODE, M0M1MAP and VMAP set, interrupts masked, SP at M1."""
    desk = board("echo")
    desk.stop_at([0x3F7FF6])
    desk.advance(8 * MILLISECOND)
    assert desk.halted
    left = {name: value for name, value in desk.registers().items() if value}
    assert left == {"PC": 0x3F7FF6, "SP": 0x0400, "ST1": 0x0A0B}
    watchdog, pll, pie = (desk.inspect(address) for address in (0x7029, 0x7021, 0x0CE0))
    assert (watchdog & 0x40, pll & 0xF, pie & 1) == (0, 0, 0), "watchdog on, PLL bypassed, PIE off"


def test_the_converter_sees_the_plant(board):
    desk = board("control")
    desk.advance(20 * MILLISECOND)
    at = program("control").symbols
    sample = desk.inspect(at["LAST"])
    assert 2000 < sample < 2100, "a phase current of zero is the middle of the converter's range"
    code = desk.code()
    assert code["cycles"] == pytest.approx(20 * MILLISECOND, rel=0.3), "of which the start ran at a tenth of the clock"
    assert code["instructions"] < code["cycles"]


def test_a_power_cycle_by_the_watchdog_begins_again():
    """A program that never serves the watchdog is reset by it and says so each time."""
    words = {0x3F7FF6: 0x6F00}  # SB to itself
    desk = core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1, image=blocks(words))
    try:
        desk.advance(40 * MILLISECOND)
        assert desk.statistics()["resets"] == 6, "each 6.55 ms of the watchdog's counter"
    finally:
        desk.close()


def test_native_boards_have_no_code():
    desk = core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1)
    try:
        with pytest.raises(RuntimeError, match="no image"):
            desk.code()
    finally:
        desk.close()


def test_words_that_are_in_no_memory_are_refused():
    with pytest.raises(ValueError, match="neither flash nor RAM"):
        core.load().VirtualBoard(plant=PLANT, parameters={}, seed=1, image=[(0x100000, [1])])


def test_a_program_without_a_boot_entry_gets_a_branch():
    made = blocks_of(Program((Block(0x3F4000, (0x7700,)),), 0x3F4000), "x")
    assert made == [(0x3F4000, [0x7700]), (0x3F7FF6, [0x007F, 0x4000])]
    with pytest.raises(InputError, match="no entry point"):
        blocks_of(Program((Block(0x3F4000, (0x7700,)),)), "x")
    assert blocks_of(Program((Block(0, (0x6F00,)),)), "x")[-1] == (0x3F7FF6, [0x0040, 0x0000]), "in RAM"
    with pytest.raises(InputError, match="0x3F5000 is in none of its sections"):
        blocks_of(Program((Block(0x3F4000, (0x7700,)),), 0x3F5000), "x")


@pytest.mark.parametrize(
    ("first", "words"), [(0x3D7800, "0x3D7800 to 0x3D7802 3 words"), (0x3FBFFE, "0x3FBFFE to 0x3FC000 1 word")]
)
def test_words_for_no_memory_of_the_board_are_said_by_their_place(first, words):
    with pytest.raises(InputError, match=f"x: of {words} lie in neither flash nor RAM"):
        blocks_of(Program((Block(0x3F7FF6, (0x6F00,)), Block(first, (1, 2, 3)))), "x")


@pytest.mark.parametrize(
    ("name", "encode", "said", "answer"),
    [
        ("echo", coff, b"abc", rb"ABC"),
        ("echo", intel_hex, b"abc", rb"ABC"),
        ("control", coff, b"\x40", rb"[\x7c-\x84]"),  # the converter's middle, in sixteens of codes
    ],
)
def test_the_board_runs_a_file_behind_a_port(tmp_path, name, encode, said, answer):
    image, port = tmp_path / f"{name}.out", tmp_path / "port"
    image.write_bytes(encode(file_blocks(name)))
    command = [sys.executable, "-m", "stillspin", "board", "--image", image, "--serial-link", port, "--for", "20"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        try:
            assert f"executes {name}.out" in process.stdout.readline()
            deadline = time.monotonic() + 30
            while not port.exists() and time.monotonic() < deadline:
                time.sleep(0.02)
            line = os.open(port, os.O_RDWR | os.O_NOCTTY)
            heard = b""
            while not re.search(answer, heard) and time.monotonic() < deadline:
                os.write(line, said)
                while select.select([line], [], [], 0.3)[0]:
                    heard += os.read(line, 64)
            os.close(line)
            assert re.search(answer, heard)
        finally:
            process.terminate()
            process.wait(timeout=20)


def test_an_image_has_its_own_parameters(tmp_path):
    image = tmp_path / "echo.out"
    image.write_bytes(coff(file_blocks("echo")))
    done = stillspin("board", "--image", image, "--set", "can_timeout=1")
    assert done.exit_code == 2
    assert "--image" in done.stderr
