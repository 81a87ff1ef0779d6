"""What commands that execute an image say of the run: that the program used what the virtual chip has not."""

import csv
import struct
import subprocess
import sys
import time
from pathlib import Path

import pytest
from c28x_chip import linked_file
from typer.testing import CliRunner

from stillspin import cli
from stillspin.hil import boards
from stillspin.image import opened, peripherals

READS_ROM = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  MOVL XAR7,#0x3FF000
        MOV AL,*XAR7
stay:   NOP
        B stay,UNC
"""
READS_RAM = READS_ROM.replace("0x3FF000", "0x3F8000")
SAID = "warning: the boot ROM was read 1 time, first 0x3FF000 at 0x3F4002 start+2 (rom.asm:6). "
USES_MUCH = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  MOVL XAR7,#0x7070
        LCR twice
        LCR twice
        MOVL XAR7,#0x7750
        MOV AL,*XAR7
        MOVL XAR7,#0x6B40
        MOV *XAR7,AL
        MOVL XAR7,#0x7046
        RPT #7
     || MOV *XAR7,#3
        MOVL XAR7,#0x7800
        MOV AL,*XAR7
        MOVL XAR7,#0x012345
        MOV *XAR7,AL
        MOVL XAR7,#0x005000
        MOV AL,*XAR7
stay:   NOP
        B stay,UNC
twice:  MOV *XAR7,#5
        MOV AL,*XAR7
        LRETR
"""
NAMED = [
    "XINT (external interrupts) is not modelled (XINT1CR); it was read 2 times and written 2 times, first XINT1CR at "
    "0x3F401D twice (rom.asm:23). ",
    "SCI-B is not modelled (SCICCR); it was read 1 time, first SCICCR at 0x3F4008 start+8 (rom.asm:9). ",
    "eQEP2 is not modelled (QPOSCNT); it was written 1 time, first QPOSCNT at 0x3F400B start+11 (rom.asm:11). ",
    "SPI-A is not modelled (SPIRXEMU); it was written 8 times, first SPIRXEMU at 0x3F400F start+15 (rom.asm:14). ",
    "no register is known at 0x007800; it was read 1 time, first 0x007800 at 0x3F4013 start+19 (rom.asm:16). ",
    "the chip has no memory at 0x012345, 0x005000; it was read 1 time and written 1 time, first 0x012345 at 0x3F4016 "
    "start+22 (rom.asm:18). ",
]
TABLE = Path(__file__).parents[2] / "toolchain/f2808/registers.csv"


@pytest.fixture
def image(tmp_path):
    def make(text=READS_ROM):
        source = tmp_path / "rom.asm"
        source.write_text(text)
        return str(linked_file(tmp_path, "rom", [source]))

    return make


def ask(*arguments):
    done = CliRunner().invoke(cli.app, ["image", *arguments])
    return done.exit_code, [line for line in done.stdout.splitlines() if line.startswith("warning: ")]


def commands(image, recording):
    """Each with its exit status: these programs take no sample, so a recording of theirs compares nothing."""
    return (
        (("time", image, "--for", "0.001"), 0),
        (("trace", image, "--instructions", "5"), 0),
        (("record", recording, "--image", image, "--for", "0.001"), 0),
        (("replay", image, recording), 1),
    )


def test_an_access_to_what_is_not_modelled_is_said(image, tmp_path):
    for command, status in commands(image(), str(tmp_path / "recording")):
        ended, said = ask(*command)
        assert ended == status, command
        assert [line[: len(SAID)] for line in said] == [SAID], command


INTERRUPTED = (
    READS_ROM.replace("stay:", "        OR IER,#0x1000\n        CLRC INTM\nstay:") + "        .org 0x5A\n        IRET\n"
)


@pytest.mark.parametrize(("text", "ends"), [(INTERRUPTED, 0), (READS_ROM, 1)], ids=["ends well", "is broken off"])
def test_interrupts_on_purpose_say_it_however_they_end(image, text, ends):
    status, said = ask("inject", image(text), "--interrupt", "INT13", "--from", "stay")
    assert (status, [line[: len(SAID)] for line in said if "a debugger loads" not in line]) == (ends, [SAID])


def test_a_program_that_uses_what_there_is_is_not_warned_of(image, tmp_path):
    for command, status in commands(image(READS_RAM), str(tmp_path / "recording")):
        assert ask(*command) == (status, []), command


def test_the_board_says_it_when_it_is_switched_off(image):
    command = [sys.executable, "-m", "stillspin", "board", "--image", image(), "--for", "0.005", "--speed", "0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    *_, said, left = done.stdout.splitlines()
    assert said.startswith(SAID)
    assert left.startswith("switched off after")


def test_a_board_in_the_loop_says_it_too(image, capsys):
    with boards.Board(None, Path(image())) as board:
        board.wait("serial")
        time.sleep(0.5)  # of which the first milliseconds are enough
    assert capsys.readouterr().out.startswith("warning: the boot ROM was read ")


def test_parts_are_named_with_count_and_first_place(image):
    _, said = ask("time", image(USES_MUCH), "--for", "0.001")
    assert [line.removeprefix("warning: ")[: len(words)] for line, words in zip(said, NAMED, strict=True)] == NAMED


READS_FRAMES = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  EALLOW
        MOVW DP,#0x1C0
        MOV @0x29,#0x68
        MOV @0x1C,#0xFFFF
        MOV @0x1D,#0xFFFF
        EDIS
        MOVL XAR7,#FIRST
        MOVL XAR6,#LAST-FIRST
more:   MOV AL,*XAR7++
        BANZ more,AR6--
stay:   NOP
        B stay,UNC
"""
FRAMES = ((0x0800, 0x0CFF), (0x6000, 0x7FFF))


def chip_registers():
    """Every word of every register, by address, and the peripheral that it belongs to."""
    with TABLE.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["address"]]
    return {
        int(row["address"], 16) + copy * int(row["step"] or "0", 16) + word: (row["block"], row["register"])
        for row in rows
        for copy in range(int(row["count"]))
        for word in range(int(row["width"]) // 16)
    }


def test_a_register_that_a_modelled_peripheral_has_not_is_noted(image):
    """Each word of the frames is read once: noted is all but the registers of the chip that are modelled."""
    there = chip_registers()
    modelled = {address for address in there if peripherals.missing(address) is None}
    for first, last in FRAMES:
        made = opened.read(Path(image(READS_FRAMES.replace("FIRST", hex(first)).replace("LAST", hex(last)))))
        board = opened.power_on(made, "bench", "A", 1)
        with opened.closing(board, made):
            assert opened.run_to(board, [made.names.addresses["stay"]], 0.5)
            noted = set(board.unmodelled())
        assert {hex(address) for address in noted ^ (set(range(first, last + 1)) - modelled)} == set()


def test_a_part_of_a_peripheral_is_named_by_its_register(image):
    text = READS_RAM.replace("0x3F8000", "0x6B1E").replace("MOV AL,*XAR7", "MOV *XAR7,#1\n        MOV AL,*+XAR7[2]")
    _, (said, *more) = ask("time", image(text), "--for", "0.001")
    assert said.startswith(
        "warning: the edge capture of eQEP1 is not modelled (QCPRD, QCPRDLAT); it was read 1 time and written 1 time, "
        "first QCPRD at 0x3F4002 start+2 (rom.asm:6). "
    )
    assert not more
    named = {part.words.start + offset: name for part in peripherals.PARTS for offset, name in part.registers.items()}
    assert named == {address: name for address, (_, name) in chip_registers().items() if address in named}


def test_an_address_beside_the_registers_of_a_peripheral_is_said(image):
    _, (said, *_) = ask("time", image(READS_RAM.replace("0x3F8000", "0x7058")), "--for", "0.001")
    assert said.startswith("warning: no register is known at 0x007058; it was read 1 time, first 0x007058 at 0x3F4002 ")


def test_what_many_addresses_take_is_told_shortly(image):
    """A pointer that runs away through empty memory: the first places, and how many more, of as many as are kept."""
    text = READS_RAM.replace("MOV AL,*XAR7", "RPT #255\n     || MOV *XAR7++,#0").replace("0x3F8000", "0x012000")
    _, (said, *_) = ask("time", image(text), "--for", "0.001")
    assert "no memory at 0x012000, 0x012001, 0x012002, 0x012003 and 252 more; it was written 256 times, " in said


def test_what_came_behind_an_illegal_instruction_is_said_so(image):
    lost = READS_ROM.replace("start:  ", "start:  LB 0x3F7000\nagain:  ") + "        .org 0x66\n        LB again\n"
    _, said = ask("time", image(lost), "--for", "0.001")
    assert any(", behind the illegal instruction. " in line for line in said)


def test_the_names_of_missing_registers_are_those_of_the_chip():
    """Against toolchain/f2808/registers.csv, whose first copy of an eQEP, an SCI or an eCAN is at hand."""
    with TABLE.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["address"]]
    known = {(row["block"].upper(), row["register"]): int(row["address"], 16) for row in rows}
    first = {}
    for part in peripherals.MISSING:
        block = part.name.split(" ")[0].split("-")[0].rstrip("0123456789").upper()
        of_block = {name: address for (where, name), address in known.items() if where == block}
        start = first.setdefault(block, min(of_block.values()))
        assert {name: address - start for name, address in of_block.items() if name in part.registers.values()} == {
            name: offset for offset, name in part.registers.items()
        }, part.name


@pytest.fixture
def rom(tmp_path):
    """A table by a formula of this test, as files that a user may have."""
    words = [(k * 40503 + 7) & 0xFFFF for k in range(0xB50)]
    dump = tmp_path / "table.bin"
    dump.write_bytes(struct.pack(f"<{len(words)}H", *words))
    source = tmp_path / "table.asm"
    lines = [f" .word {', '.join(map(str, words[k : k + 8]))}" for k in range(0, len(words), 8)]
    source.write_text("\n".join([" .org 0x3FF000", *lines, " .org 0x3F7FF6", " LB 0x3F7FF6", ""]))
    linked = linked_file(tmp_path, "table", [source])
    return words, (str(dump), str(linked))


READS_TABLE = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  MOVL XAR7,#0x3FF010
        MOV AL,*XAR7++
        MOV AH,*XAR7++
        MOVL XAR6,*XAR7
        MOVL XAR5,#0x3FFB50
{beyond}
        MOVL XAR4,#0x3FF020
        MOVL XAR3,#0x8000
        RPT #3
     || PREAD *XAR3++,*XAR7
stay:   NOP
        B stay,UNC
"""


def test_tables_of_the_boot_rom_come_from_a_file(image, rom):
    words, files = rom
    for file in files:
        there = opened.read(Path(image(READS_TABLE.format(beyond=""))), Path(file))
        board = opened.power_on(there, "bench", "A", 1)
        with opened.closing(board, there):
            opened.advance(board, 0.001)
            registers = board.registers()
            assert registers["ACC"] == words[0x11] << 16 | words[0x10]
            assert registers["XAR6"] == words[0x13] << 16 | words[0x12]
            assert board.words(0x8000, 4) == words[0x12:0x16]
            assert opened.warnings(board, there) == []


def test_behind_the_end_of_the_table_nothing_is_known(image, rom):
    _, (dump, _) = rom
    _, said = ask("time", image(READS_TABLE.format(beyond="        MOV AL,*XAR5")), "--for", "0.001", "--rom", dump)
    assert [line[:58] for line in said] == ["warning: the boot ROM was read 1 time, first 0x3FFB50 at 0"]


def test_the_rom_takes_one_wait(image, rom):
    def cycles(address):
        there = opened.read(Path(image(READS_RAM.replace("0x3F8000", address))), Path(rom[1][0]))
        board = opened.power_on(there, "bench", "A", 1)
        with opened.closing(board, there):
            assert opened.run_to(board, [there.names.addresses["stay"]], 0.001)
            return board.code()["waited_for_data"]

    assert cycles("0x3FF000") == cycles("0x3F8000") + 1


def test_code_of_the_boot_rom_runs_and_is_timed(image, tmp_path):
    file = image(READS_RAM.replace("        MOV AL,*XAR7\n", "        LCR 0x3FF600\n"))
    dump = tmp_path / "code.bin"
    dump.write_bytes(struct.pack("<1538H", *[0] * 0x600, 0x9A05, 0x0006))  # MOVB AL,#5; LRETR
    there = opened.read(Path(file), dump)
    board = opened.power_on(there, "bench", "A", 1)
    with opened.closing(board, there):
        assert opened.run_to(board, [there.names.addresses["stay"]], 0.001)
        assert board.registers()["ACC"] == 5
    done = CliRunner().invoke(cli.app, ["image", "time", file, "--for", "0.001", "--rom", str(dump)])
    assert "(code without a name) " in done.stdout
    assert "(outside of the memories) " not in done.stdout


def test_every_command_takes_it(image, rom, tmp_path):
    for command, status in commands(image(), str(tmp_path / "recording")):
        assert ask(*command, "--rom", rom[1][0]) == (status, []), command


@pytest.mark.parametrize(
    ("content", "words"), [(b"\1\2\3", "3 octets are no dump"), (b"", "0 octets are no dump"), (None, "cannot be read")]
)
def test_a_file_that_is_no_rom_is_refused(image, tmp_path, content, words):
    file = tmp_path / "rom.bin"
    if content is not None:
        file.write_bytes(content)
    done = CliRunner().invoke(cli.app, ["image", "time", image(), "--rom", str(file)])
    assert done.exit_code == 2
    assert words in done.stderr


def test_a_linked_file_without_words_there_is_refused(image):
    done = CliRunner().invoke(cli.app, ["image", "time", image(), "--rom", image()])
    assert done.exit_code == 2
    assert "has nothing in the boot ROM (0x3FF000 to 0x3FFFFF)" in done.stderr


@pytest.mark.parametrize(
    "command",
    [
        ("run", "A10"),
        ("reproduce", "A10"),
        ("board",),
        ("hil", "A10"),
        ("image", "record", "RECORDING"),
    ],
    ids=" ".join,
)
def test_the_firmware_for_this_computer_takes_none(rom, command):
    done = CliRunner().invoke(cli.app, [*command, "--rom", rom[1][0]])
    assert done.exit_code == 2
    assert "--rom: goes with --image FILE alone" in " ".join(done.stderr.split())


def test_words_for_no_memory_are_said_in_a_scenario_too(image):
    file = image(READS_RAM + "        .org 0x3D7800\n        .word 1\n")
    done = CliRunner().invoke(cli.app, ["image", "time", file, "A10"])
    assert done.exit_code == 2
    assert "0x3D7800" in done.stderr


def test_resets_are_said(image):
    status, said = ask("time", image(READS_RAM), "--for", "0.02")
    assert status == 0
    assert said == ["warning: the watchdog reset the chip (3 times), and the program began anew"]


SHUT_OUT = """
        .org 0x3F7FF6
        LB start
        .org 0x3F4000
start:  MOVW DP,#0x7029>>6
        MOV @0x29,#0x68
        MOV @0x21,#10
        MOVL XAR4,#0x6804
        MOV AL,*XAR4
        EALLOW
        MOV @0x29,#0x68
        EDIS
stay:   NOP
        B stay,UNC
"""


def test_what_the_chip_does_not_let_through_is_said(image):
    """A write without EALLOW, and a peripheral whose clock nobody has switched on; looks from outside do not count."""
    said = ask("time", image(SHUT_OUT), "--for", "0.002")
    assert said == (
        0,
        [
            "warning: protected registers were written with EALLOW clear 2 times, first 0x007029 at 0x3F4002 start+2 "
            "(rom.asm:6). It has no effect, as on a chip",
            "warning: a peripheral whose clock is off (PCLKCR0, PCLKCR1) was accessed 1 time, first 0x006804 at "
            "0x3F4008 start+8 (rom.asm:9). It has no effect, as on a chip",
        ],
    )
