"""The image's own start, hal/f2808/image/boot.asm, assembled by the project's assembler and run on the C28x core."""

import pytest
from c28x_desk import ROOT, ask, put, state

from stillspin.c28x.program import assemble
from stillspin.errors import InputError

SOURCE = (ROOT / "hal/f2808/image/boot.asm").read_text()
CODE_START = 0x3F7FF6
IDENTITY, GLOBALS, COUNT = 0x3F0020, 0x8800, 300
RUN_TIME = 0x3F1000
MARK = 0x5AA5
WDCR, WATCHDOG_OFF = 0x7029, 0x68
NEIGHBOUR = 0x1234
SECTIONS = {"codestart": CODE_START, "boot": 0x3F4000, "appentry": 0x3F0000}
"""The drive's entry is where the desk has memory; the linker's places are in c28x/f2808_flash.cmd."""
SYMBOLS = {
    **{"_c_int00": RUN_TIME, "_image_identity": IDENTITY},
    **{"_image_globals_start": GLOBALS, "_image_globals_size": COUNT},
}


@pytest.fixture(scope="module")
def program():
    return assemble(SOURCE, sections=SECTIONS, symbols=SYMBOLS)


def run(program, mark):
    """How it ended, the registers, the watchdog's register and the globals with a word on either side."""
    filled = " ".join([f"{NEIGHBOUR:x}"] * (COUNT + 2))
    commands = [
        *("fresh", *put(program.words), f"put {RUN_TIME:x} 7625", f"put {IDENTITY:x} {mark:x}"),
        *(f"put {GLOBALS - 1:x} {filled}", "put 7028 aaaa 0 bbbb"),
        *("set objmode 0", "set intm 0", "set xar5 12345678", f"set pc {CODE_START:x}", "go 10000", "state"),
        *("get 7028 3", f"get {GLOBALS - 1:x} {COUNT + 2:x}"),
    ]
    end, registers, watchdog, memory = ask(commands)
    return (
        end,
        state(registers),
        [int(word, 16) for word in watchdog.split()],
        [int(word, 16) for word in memory.split()],
    )


def test_a_complete_image_is_started_with_its_globals_zeroed(program):
    end, registers, watchdog, memory = run(program, MARK)
    assert (end, registers["pc"]) == ("breakpoint", RUN_TIME)
    assert watchdog == [0xAAAA, WATCHDOG_OFF, 0xBBBB]
    assert memory == [NEIGHBOUR, *[0] * COUNT, NEIGHBOUR]
    assert {name: registers[name] for name in ("objmode", "amode", "intm", "eallow")} == {
        **{"objmode": 1, "amode": 0, "intm": 1, "eallow": 0}
    }


@pytest.mark.parametrize("mark", [0xFFFF, 0, MARK ^ 1])
def test_an_incomplete_image_is_never_started(program, mark):
    end, registers, watchdog, memory = run(program, mark)
    assert end == "cycles"
    assert 0 <= registers["pc"] - program.symbols["NO_IMAGE"] < 3
    assert watchdog[1] == WATCHDOG_OFF
    assert memory == [NEIGHBOUR] * (COUNT + 2)


def test_the_entry_of_the_boot_rom_has_room_for_two_words(program):
    assert [address for address in program.words if address >= CODE_START] == [CODE_START, CODE_START + 1]


def test_a_section_without_a_place_and_a_name_without_a_value_are_refused():
    with pytest.raises(InputError, match="nobody says where section APPENTRY is"):
        assemble(SOURCE, sections={"codestart": CODE_START, "boot": 0x3F4000}, symbols=SYMBOLS)
    with pytest.raises(InputError, match="'_C_INT00' has no value"):
        assemble(SOURCE, sections=SECTIONS, symbols={name: 0 for name in SYMBOLS if name != "_c_int00"})
