"""Branches, calls, loops, interrupts and traps on the C28x core."""

import itertools

import pytest
from c28x_desk import Run, ask, put

from stillspin.c28x.operands import CONDITIONS
from stillspin.c28x.program import assemble

HOLDS = {
    "NEQ": lambda f: not f["z"],
    "EQ": lambda f: f["z"],
    "GT": lambda f: not f["z"] and not f["n"],
    "GEQ": lambda f: not f["n"],
    "LT": lambda f: f["n"],
    "LEQ": lambda f: f["z"] or f["n"],
    "HI": lambda f: f["c"] and not f["z"],
    "HIS": lambda f: f["c"],
    "LO": lambda f: not f["c"],
    "LOS": lambda f: not f["c"] or f["z"],
    "NOV": lambda f: not f["v"],
    "OV": lambda f: f["v"],
    "NTC": lambda f: not f["tc"],
    "TC": lambda f: f["tc"],
    "NBIO": lambda f: False,
    "UNC": lambda f: True,
}


@pytest.mark.parametrize("condition", CONDITIONS)
@pytest.mark.parametrize("branch", ["B", "BF", "SB"])
def test_conditions(condition, branch):
    program = assemble(f"start: {branch} there,{condition}\n MOVB AL,#1\n ESTOP0\nthere: MOVB AL,#2\n ESTOP0")
    cases = [dict(zip("nzcv", bits, strict=True)) for bits in itertools.product((0, 1), repeat=4)]
    cases = [{**flags, "tc": flags["n"] ^ flags["c"]} for flags in cases]
    commands = []
    for flags in cases:
        commands += ["fresh", *put(program.words), *(f"set {name} {value}" for name, value in flags.items())]
        commands += ["step 1", "state", "cycles"]
    answers = ask(commands)
    for flags, state, spent in zip(cases, answers[::2], answers[1::2], strict=True):
        taken = bool(HOLDS[condition](flags))
        there = dict(word.split("=") for word in state.split())
        assert int(there["pc"], 16) == (program.symbols["THERE"] if taken else len(program.words) - 4), flags
        assert there["v"] == ("0" if condition in ("OV", "NOV") else str(flags["v"]))
        assert spent.split()[0] == ("4" if branch == "BF" or not taken else "7")


def test_calls_return_in_every_way():
    run = Run(
        """
        start:  MOVB XAR1,#0
                LCR outer
                LC plain
                FFC XAR7,fast
                MOVL XAR4,#inner
                LCR *XAR4
                MOVL XAR7,#plain
                LC *XAR7
                ESTOP0
        outer:  ADDB XAR1,#1
                LCR inner               ; RPC is saved by the second call
                LRETR
        inner:  ADDB XAR1,#8
                LRETR
        plain:  ADDB XAR1,#32
                LRET
        fast:   ADDB XAR1,#64
                LB *XAR7
        """,
        registers={"rpc": 0x2ABCDE},
    )
    assert (run.end, run.registers["xar1"]) == ("breakpoint", 1 + 8 + 32 + 64 + 8 + 32)
    assert (run.registers["sp"], run.registers["rpc"]) == (0x400, 0x2ABCDE)


@pytest.mark.parametrize("sp", [0x400, 0x401])
def test_a_return_address_lies_on_the_stack_at_any_address(sp):
    run = Run(
        "start: LC there\n ESTOP0\n .org 0x2345\nthere: ESTOP0",
        registers={"sp": sp},
        reads=[(sp, 2)],
    )
    assert run.memory[0] == [2, 0]


def test_loops_over_pointers_and_counts():
    run = Run(
        """
        start:  MOVB XAR0,#9
                MOVB XAR1,#0
                MOVB XAR2,#5
        again:  ADDB XAR1,#1
                BANZ again,AR0--
        until:  ADDB XAR2,#1
                BAR until,AR2,AR1,NEQ
                BAR same,AR2,AR1,EQ
                ESTOP0
        same:   MOVB XAR3,#1
                ESTOP0
        """
    )
    assert [run.registers[name] for name in ("xar0", "xar1", "xar2", "xar3")] == [0xFFFF, 10, 10, 1]


def test_calls_of_the_older_family_stay_in_the_upper_page():
    run = Run(
        """
                .org 0x3F8000
        start:  MOVB XAR0,#3
                NOP *,ARP0
        again:  XCALL 0x8100,UNC
                XBANZ 0x8002,*--,ARP0
                MOVB ACC,#0
                ESTOP0
                .org 0x3F8100
                ADDB XAR5,#1
                XRETC EQ
                ADDB XAR5,#1
                XRET
        """
    )
    assert (run.end, run.registers["xar5"], run.registers["sp"]) == ("breakpoint", 8, 0x400)


VECTORS = """
        .org 0x3FFFC0
        .long start, int1, int2
        .org 0x3FFFE4
        .long nmi, illegal, user1
        .org 0x1000
"""


def with_vectors(body, **routines):
    """A program at 0x2000 with a routine for each vector, which returns."""
    names = ("int1", "int2", "nmi", "illegal", "user1")
    text = "".join(f"{name}: {routines.get(name, 'NOP')}\n IRET\n" for name in names)
    return f"{VECTORS}{text}\n .org 0x2000\n{body}"


EVERYTHING = {
    **{"acc": 0x12345678, "p": 0x9ABCDEF0, "xt": 0x13572468, "dp": 0x1FF, "xar0": 0x11112222, "xar1": 0x33334444},
    **{
        "pm": 3,
        "ovc": 5,
        "sxm": 1,
        "ovm": 1,
        "tc": 1,
        "c": 1,
        "z": 1,
        "n": 0,
        "v": 1,
        "arp": 5,
        "eallow": 1,
        "dbgm": 0,
    },
}
DISTURBS = "\n".join(
    [
        *("ZAPA", "MOV T,@AL", "MOVW DP,#0", "MOV @AR0,#7", "MOV @AR1,#8", "SPM 0", "CLRC OVC", "CLRC SXM,OVM,TC,C"),
        *("EDIS", "NOP *,ARP1", "MOV @AL,#1", "ADDB AL,#1"),
    ]
)


@pytest.mark.parametrize("sp", [0x400, 0x401])
def test_an_interrupt_saves_what_it_says_and_the_return_restores_it(sp):
    source = with_vectors("start: CLRC INTM\n NOP\n MOVB XAR3,#3\n ESTOP0", int1=DISTURBS + "\nMOV @0x10,#1")
    run = Run(
        source,
        registers={**EVERYTHING, "sp": sp, "ier": 3},
        requests=[1],
        reads=[(sp - sp % 2 + 2 * (sp % 2), 14), (0x10, 1)],
    )
    after = run.registers
    assert run.end == "breakpoint"
    assert {name: after[name] for name in EVERYTHING} == EVERYTHING
    assert (after["sp"], after["ier"], after["ifr"], after["intm"], after["xar3"]) == (sp, 3, 0, 0, 3)
    saved, done = run.memory
    assert done == [1]
    st0 = 5 << 10 | 3 << 7 | 0b1011111
    st1 = 5 << 13 | 1 << 11 | 1 << 9 | 1 << 6 | 1 << 3
    assert saved[:10] == [st0, 0x1357, 0x5678, 0x1234, 0xDEF0, 0x9ABC, 0x2222, 0x4444, st1, 0x1FF]
    assert saved[10:] == [3, 0, 0x2001, 0]


def test_a_higher_interrupt_comes_first_and_a_lower_one_may_be_let_in():
    """INT2's routine lets INT1 in; each writes its step into a list."""
    log = "MOVL XAR5,XAR4\n ADDB XAR4,#1\n MOV *XAR5,#{}"
    nested = with_vectors(
        "start: MOVL XAR4,#0x8000\n OR IER,#2\n EINT\n NOP\n OR IER,#1\n NOP\n ESTOP0",
        int1=log.format(1),
        int2=f"{log.format(2)}\n OR IER,#1\n CLRC INTM\n NOP\n NOP\n SETC INTM\n {log.format(3)}",
    )
    run = Run(nested, requests=[1, 2], reads=[(0x8000, 4)])
    assert (run.end, run.memory[0]) == ("breakpoint", [2, 1, 3, 0])
    both = nested.replace("OR IER,#2\n EINT", "OR IER,#3\n EINT")
    assert Run(both, requests=[1, 2], reads=[(0x8000, 4)]).memory[0] == [1, 2, 3, 0]


def test_priorities_are_those_of_the_vector_table():
    """Routines of all sixteen in a row note their numbers; each return lets the next one in."""
    table = ",".join(["start", *(f"int{n}" for n in range(1, 17))])
    routines = "".join(f"int{n}: MOV *XAR4++,#{n}\n IRET\n" for n in range(1, 17))
    source = f".org 0x3FFFC0\n .long {table}\n .org 0x1000\n{routines} .org 0x2000\nstart: EINT\n NOP\n ESTOP0"
    run = Run(source, registers={"ier": 0xFFFF, "xar4": 0x8000}, requests=range(1, 17), reads=[(0x8000, 17)])
    assert run.memory[0] == [16, *range(1, 16), 0]


@pytest.mark.parametrize("count", [2, 3, 20000])
def test_rpt_behind_rpt_repeats_nothing(count):
    run = Run(".org 0x2000\nstart: MOVB ACC,#1\n" + " RPT #7\n" * count + " ADDU ACC,@AL\n ESTOP0")
    assert run.registers["acc"] == (2 if count % 2 == 0 else 256)


def test_interrupts_wait_for_ier_and_intm_and_for_the_end_of_a_repeat():
    body = "start: EINT\n RPT #99\n || ADDB AL,#0\n NOP\n RPT #99\n || NOP\n ESTOP0"
    masked = Run(with_vectors("start: NOP\n ESTOP0", int1="MOVB XAR5,#1"), requests=[1], registers={"ier": 1})
    assert (masked.registers["xar5"], masked.registers["ifr"]) == (0, 1)
    disabled = Run(with_vectors(body, int1="MOVB XAR5,#1"), requests=[1])
    assert disabled.registers["xar5"] == 0
    program = assemble(with_vectors("start: RPT #99\n || ADDU ACC,*XAR4++\n ESTOP0", int1="MOVL XAR5,XAR4"))
    commands = [
        "fresh",
        *put(program.words),
        "set pc 2000",
        "set ier 1",
        "set intm 0",
        "go 1",
        "request 1",
        "go 100",
        "state",
    ]
    there = dict(word.split("=") for word in ask(commands)[-1].split())
    assert (int(there["xar4"], 16), int(there["xar5"], 16)) == (100, 100)


def test_idle_ends_with_an_interrupt_even_a_masked_one():
    source = with_vectors("start: IDLE\n MOVB XAR3,#1\n ESTOP0", int1="MOVB XAR5,#1")
    program = assemble(source)
    for intm, woken in ((0, 1), (1, 0)):
        commands = ["fresh", *put(program.words), "set pc 2000", "set ier 1", f"set intm {intm}", "go 100", "state"]
        first, asleep, second, after = ask([*commands, "request 1", "go 100", "state"])
        assert (first, second) == ("idle", "breakpoint")
        assert "idlestat=1" in asleep.split()
        there = dict(word.split("=") for word in after.split())
        assert (int(there["xar5"]), there["xar3"], there["idlestat"]) == (woken, "1", "0")


def test_loopz_waits_for_a_word_that_an_interrupt_writes():
    source = with_vectors(
        "start: MOVW DP,#0x200\n LOOPZ @0,#0x0004\n MOVB XAR3,#1\n ESTOP0", int1="MOV AL,#0x000C\n MOV @0,AL"
    )
    program = assemble(source)
    commands = ["fresh", *put(program.words), "set pc 2000", "set ier 1", "set intm 0", "go 40", "state"]
    first, waits, second, after = ask([*commands, "request 1", "go 200", "state"])
    assert (first, second) == ("cycles", "breakpoint")
    assert {"loop=1", "z=1"} <= set(waits.split())
    assert {"loop=0", "xar3=1", "z=0"} <= set(after.split())


def test_traps_and_illegal_instructions_take_their_vectors():
    source = with_vectors(
        "start: TRAP #20\n .word 0\n .word 0xFFFF\n .word 0x7640-0x0F\n INTR NMI\n ESTOP0",
        user1="ADDB XAR3,#1",
        illegal="ADDB XAR4,#1",
        nmi="ADDB XAR5,#1",
    )
    run = Run(source, registers={"ier": 0x55})
    assert run.end == "breakpoint"
    assert [run.registers[name] for name in ("xar3", "xar4", "xar5", "ier", "sp")] == [1, 3, 1, 0x55, 0x400]


def test_intr_clears_its_request_and_an_nmi_cannot_be_masked():
    run = Run(with_vectors("start: INTR INT2\n ESTOP0", int2="MOVB XAR3,#1"), requests=[2], registers={"ier": 2})
    assert (run.registers["xar3"], run.registers["ifr"], run.registers["ier"]) == (1, 0, 2)
    program = assemble(with_vectors("start: NOP\n NOP\n ESTOP0", nmi="MOVB XAR5,#1"))
    answers = ask(["fresh", *put(program.words), "set pc 2000", "nmi", "go 100", "state"])
    assert "xar5=1" in answers[-1].split()


@pytest.mark.parametrize(("way", "seen", "left"), [("TRAP #2", 7, 2), ("INTR INT2", 5, 0)])
def test_a_trap_leaves_the_masks_alone_and_intr_does_as_its_interrupt(way, seen, left):
    run = Run(
        with_vectors(f"start: {way}\n ESTOP0", int2="MOV @AR3,IER"), requests=[2], registers={"ier": 7, "intm": 1}
    )
    assert (run.registers["xar3"], run.registers["ifr"], run.registers["ier"]) == (seen, left, 7)


def test_stack_alignment_is_undone():
    run = Run("start: ASP\n MOVZ AR3,@SP\n NASP\n ESTOP0", registers={"sp": 0x401})
    assert (run.registers["xar3"], run.registers["sp"], run.registers["spa"]) == (0x402, 0x401, 0)


@pytest.mark.parametrize("text", ["LPADDR", "SETC AMODE"])
def test_the_other_addressing_mode_stops_the_core(text):
    assert Run(f"start: {text}\n NOP\n ESTOP0").end == "unmodelled"
