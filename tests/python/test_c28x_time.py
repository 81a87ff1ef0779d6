"""What instructions cost beyond the cycles of their table: small programs, each counted by hand from docs/c28x.md."""

import c28x_speed
import pytest
from c28x_desk import ask, put

from stillspin.c28x.program import assemble

FLASH = "80 3 2 4 4 3 0"
"""Three waits: a 64-bit line takes four cycles, three lines are fetched ahead."""
RAM = "1 0 1 1 1 3 0"
OTHER_RAM = "2 0 1 1 1 3 0"
REGISTERS = "0 0 1 1 1 3 1"
"""A frame of peripherals: reads are after writes."""
CODE = 0x3F8000


class Time:
    """Cycles of a program up to its ESTOP0, which is one of them, and those of them that were waited."""

    def __init__(self, source, *, code=None, data=None, registers=(), at=CODE):
        program = assemble(f" .org {at:#x}\n" + source.replace("|", "\n"))
        commands = ["fresh", *put(program.words)]
        commands += [f"region 3f8000 400 {code}"] * bool(code) + [f"region 8000 400 {data}"] * bool(data)
        commands += [f"set {name} {value:x}" for name, value in {"dp": 0x200, "sp": 0x8100, **dict(registers)}.items()]
        commands += [f"set pc {at:x}", "go 10000", "cycles", "waits"]
        end, spent, waits = ask(commands)
        assert end == "breakpoint"
        self.cycles = int(spent.split()[0])
        self.registers, self.data, self.fetch = map(int, waits.split())


def between(first, count, then):
    return "|".join([f" {first}", *[" NOP"] * count, f" {then}", " ESTOP0"])


LATE = [
    ("MOVL XAR4,@0", "MOV AL,*XAR4++"),
    ("MOVL XAR4,@0", "MOV *+XAR4[2],AL"),
    ("MOVL XAR4,@0", "MOVL @2,XAR4"),
    ("MOVL XAR4,@0", "ADDB XAR4,#1"),
    ("MOVL XAR4,@0", "MOVB XAR4,#1"),
    ("MOVL XAR7,@0", "MAC P,@0,*XAR7"),
    ("MOVZ AR0,@1", "MOV AL,*+XAR4[AR0]"),
    ("MOVZ AR1,@1", "MOV AL,*+XAR4[AR1]"),
    ("MOV @AR4,AL", "MOV AL,*XAR4"),
    ("ADD @AR4,AL", "MOV AL,*--XAR4"),
    ("POP XAR4", "MOV AL,*XAR4"),
    ("POP AR3:AR2", "MOV AL,*XAR3"),
    ("MOV @SP,AL", "PUSH ACC"),
    ("MOV @SP,AL", "MOV AL,*-SP[1]"),
    ("POP DP", "MOV AL,@3"),
    ("MOVL XAR2,@0", "MOV AL,*"),
    ("MOVL XAR6,@0", "MOV AL,*AR6%++"),
]
EARLY = [
    ("MOVL XAR4,#0x8000", "MOV AL,*XAR4"),
    ("MOVB XAR4,#5", "MOV AL,*XAR4"),
    ("ADDB XAR4,#1", "MOV AL,*XAR4"),
    ("MOV AL,*XAR4++", "MOV AL,*XAR4++"),
    ("MOVW DP,#0x200", "MOV AL,@3"),
    ("ADDB SP,#2", "MOV AL,*-SP[1]"),
    ("MOVL XAR4,@0", "MOV AL,*XAR5"),
    ("MOVL XAR3,@0", "MOV AL,*"),
    ("MOV AL,@0", "ADD AL,@1"),
    ("MOVL XT,@0", "MOVL @2,XT"),
    ("MOVL XAR4,@0", "MOVL XAR4,@2"),
]


@pytest.mark.parametrize("apart", range(5))
@pytest.mark.parametrize(("first", "then"), LATE)
def test_an_address_waits_for_its_register(first, then, apart):
    """What is late is there three phases after addresses are made: each instruction between takes a cycle off."""
    spent = Time(between(first, apart, then), registers={"arp": 2})
    assert spent.registers == max(0, 3 - apart)
    none = Time(between("NOP", apart, then), registers={"arp": 2})
    assert spent.cycles == none.cycles + spent.registers + spent.data - none.data


@pytest.mark.parametrize(("first", "then"), EARLY)
def test_what_is_early_or_elsewhere_makes_nobody_wait(first, then):
    assert Time(between(first, 0, then), registers={"arp": 2}).registers == 0


def test_slow_instructions_take_off_as_many_cycles_as_they_last():
    assert Time(" MOVL XAR4,@0| IMPYL ACC,XT,@2| MOV AL,*XAR4| ESTOP0").registers == 1
    assert Time(" MOVL XAR4,@0| RPT #1| || NOP| MOV AL,*XAR4| ESTOP0").registers == 0


@pytest.mark.parametrize("apart", range(5))
@pytest.mark.parametrize(
    ("write", "read", "same"),
    [
        ("MOV @0,AL", "MOV AH,@0", True),
        ("MOV @0,AL", "MOV AH,@1", False),
        ("MOVL @0,ACC", "MOV AH,@1", True),
        ("MOV @1,AL", "MOVL ACC,@0", True),
        ("MOVL @0,ACC", "MOV AH,@2", False),
        ("INC @0", "INC @0", True),
        ("PUSH ACC", "POP ACC", True),
    ],
)
def test_a_read_waits_for_the_write_of_the_same_word(write, read, same, apart):
    spent = Time(between(write, apart, read))
    assert spent.data == (max(0, 3 - apart) if same else 0)
    assert spent.cycles == 3 + apart + spent.data


@pytest.mark.parametrize("apart", range(5))
def test_registers_of_peripherals_are_read_in_the_order_of_the_program(apart):
    spent = Time(between("MOV @0,AL", apart, "MOV AH,@7"), data=REGISTERS)
    assert spent.data == max(0, 3 - apart)


@pytest.mark.parametrize(("apart", "waits"), [(0, 0), (1, 0), (2, 1), (3, 0)])
def test_a_block_of_ram_writes_before_it_reads(apart, waits):
    assert Time(between("MOV @0,AL", apart, "MOV AH,@7"), data=RAM).data == waits


def test_flash_keeps_up_with_short_instructions():
    spent = Time("| NOP" * 40 + "| ESTOP0", code=FLASH)
    assert (spent.cycles, spent.fetch) == (3 + 41, 3)


def test_flash_brings_two_long_instructions_in_four_cycles():
    """Line 0 is there after 3 waits, each line takes two cycles to execute and four to come: two waits a line."""
    spent = Time("| MOV @0,#1234" * 8 + "| NOP" * 3 + "| ESTOP0", code=FLASH)
    assert (spent.cycles, spent.fetch) == (3 + 8 + 4 * 2 + 4, 3 + 4 * 2)


def test_a_slow_instruction_lets_the_flash_get_ahead():
    """Line 1 is entered at 26. Lines 1 to 3 came at 7, 11 and 15 and filled the buffers, lines 4, 5, 6 and 7 come from
    30 on; they are entered at 32, 34, 36 and, after the wait of line 6, 40: two late by two cycles each."""
    spent = Time(" RPT #19| || NOP| NOP| NOP" + "| MOV @0,#1234" * 12 + "| ESTOP0", code=FLASH)
    assert spent.fetch == 3 + 2 + 2
    assert spent.cycles == 3 + 1 + 20 + 2 + 12 + 2 + 2 + 1


@pytest.mark.parametrize(("odd", "waits"), [(0, 3), (1, 3), (2, 3 + 2), (3, 3 + 3)])
def test_a_branch_into_flash_begins_anew(odd, waits):
    """The first line comes after the waits, the one after it four cycles later: too late where the
    target is one of the last words of its line."""
    spent = Time(" B go,UNC" + "| NOP" * (2 + odd) + "|go: NOP| NOP| ESTOP0", code=FLASH)
    assert spent.fetch == 3 + waits
    assert spent.cycles == 7 + 3 + spent.fetch


def test_a_loop_in_flash_pays_at_each_turn():
    taken = Time(" MOVB XAR0,#9|loop: BANZ loop,AR0--| ESTOP0", code=FLASH)
    assert taken.fetch == 3 + 9 * 3
    assert taken.cycles == 1 + 9 * 4 + 2 + taken.fetch + 1
    ram = Time(" MOVB XAR0,#9|loop: BANZ loop,AR0--| ESTOP0", code=RAM)
    assert (ram.cycles, ram.fetch) == (1 + 9 * 4 + 2 + 1, 0)


def test_a_branch_that_is_not_taken_goes_on_with_what_was_fetched():
    spent = Time("| NOP| B there,NEQ| NOP| NOP| NOP|there: ESTOP0", code=FLASH, registers={"z": 1})
    assert (spent.cycles, spent.fetch) == (3 + 1 + 4 + 3 + 1, 3)


def test_data_of_the_flash_has_all_waits_after_the_line_that_is_coming():
    """The read is asked for at 3; line 1 comes at 7, the word at 11, line 2 at 15, after the four NOPs of line 1 and
    two of line 0 were executed at 17."""
    spent = Time(" MOV AL,@0" + "| NOP" * 7 + "| ESTOP0", code=FLASH, registers={"dp": CODE >> 6})
    assert (spent.fetch, spent.data) == (3, 4 + 3)
    assert spent.cycles == 3 + 1 + 7 + 7 + 1


def test_code_in_ram_reads_the_flash_with_its_waits_alone():
    spent = Time("| MOV AL,@0" * 5 + "| ESTOP0", data=FLASH)
    assert (spent.cycles, spent.data) == (5 * 4 + 1, 5 * 3)


def test_code_and_data_in_one_block_share_its_cycles():
    """Two instructions a fetch, each with an access of its own: three accesses in two cycles. Unit 1 came while the
    pipeline was filled; each unit from the third on is a cycle late."""
    source = "| MOV AL,@0" * 12 + "| ESTOP0"
    here = {"dp": CODE >> 6}
    assert Time(source, code=RAM, registers=here).fetch == 5
    assert Time(source, code=RAM, data=OTHER_RAM).fetch == 0
    writes = Time("| MOV @32,AL" * 12 + "| ESTOP0", code=RAM, registers=here)
    assert writes.fetch == 5


def test_an_instruction_without_an_access_lets_the_fetches_through():
    source = "| MOV AL,@0| NOP" * 6 + "| ESTOP0"
    assert Time(source, code=RAM, registers={"dp": CODE >> 6}).fetch == 0


def test_repeating_needs_no_fetches():
    spent = Time(" RPT #15| || ADD ACC,@0| ESTOP0", code=RAM, registers={"dp": CODE >> 6})
    assert (spent.cycles, spent.fetch) == (1 + 16 + 1, 0)


def test_an_interrupt_begins_anew_as_a_branch_does():
    source = " IDLE| NOP| NOP| ESTOP0"
    program = assemble(f" .org {CODE:#x}\n" + source.replace("|", "\n"))
    handler = assemble(f" .org {CODE + 0x100:#x}\n IRET")
    commands = ["fresh", *put(program.words), *put(handler.words), f"region 3f8000 400 {FLASH}"]
    commands += ["put 3fffc2 8100 3f", "set vmap 1", "set intm 0", "set ier 1", "set sp 8000", f"set pc {CODE:x}"]
    commands += ["go 1000", "cycles", "request 1", "go 1000", "cycles", "waits"]
    idle, before, end, after, waits = ask(commands)
    assert (idle, end) == ("idle", "breakpoint")
    taken = int(after.split()[0]) - int(before.split()[0])
    assert taken == 8 + 3 + 8 + 3 + 3, (before, after, waits)


@pytest.mark.parametrize(("speed", "ends"), [(29.9, 1), (30.0, None)])
def test_the_benchmark_fails_below_what_it_is_told(monkeypatch, capsys, tmp_path, speed, ends):
    for name, figures in (("alone", 50.0), ("on_chip", (speed, 1.5)), ("whole_drive", (20.0, 1.0))):
        monkeypatch.setattr(c28x_speed, name, lambda figures=figures: figures)
    file = tmp_path / "some" / "speed.json"
    try:
        c28x_speed.main(["--least", "30", str(file)])
        ended = None
    except SystemExit as end:
        ended = end.code
    assert ended == ends
    assert ("29.9 million instructions/s, the least wanted is 30" in capsys.readouterr().err) == bool(ends)
    assert f'"instructions": {speed}' in file.read_text()
