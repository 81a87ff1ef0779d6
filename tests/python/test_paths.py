"""The longest paths (toolchain/isr/paths): blocks, loops and calls of listings whose paths are counted by hand."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "toolchain"))

from isr.paths.bound import Bound
from isr.paths.facts import Facts, read_facts
from isr.paths.loops import loops_of
from isr.paths.program import Frame, Program
from isr.paths.steps import Steps
from isr.paths.watch import Regions, contradiction, periods

LISTING = """
00000100 <leaf>:
     100:\t2000      \tmovs\tr0, #0
     102:\t4770      \tbx\tlr

00000110 <chooses>:
     110:\t2800      \tcmp\tr0, #0
     112:\td002      \tbeq.n\t11a <chooses+0xa>
     114:\t3001      \tadds\tr0, #1
     116:\t3001      \tadds\tr0, #1
     118:\t4770      \tbx\tlr
     11a:\t4770      \tbx\tlr

00000120 <counts>:
     120:\tb510      \tpush\t{r4, lr}
     122:\t2400      \tmovs\tr4, #0
     124:\tf7ff ffec \tbl\t100 <leaf>
     128:\t3401      \tadds\tr4, #1
     12a:\t2c05      \tcmp\tr4, #5
     12c:\td1fa      \tbne.n\t124 <counts+0x4>
     12e:\tbd10      \tpop\t{r4, pc}

00000140 <asks>:
     140:\t2c05      \tcmp\tr4, #5
     142:\td002      \tbeq.n\t14a <asks+0xa>
     144:\t3401      \tadds\tr4, #1
     146:\te7fb      \tb.n\t140 <asks>
     14a:\t4770      \tbx\tlr

00000150 <leaves_early>:
     150:\t2800      \tcmp\tr0, #0
     152:\tbf08      \tit\teq
     154:\t4770      \tbxeq\tlr
     156:\t3001      \tadds\tr0, #1
     158:\tf7ff bfda \tb.w\t110 <chooses>

0000015c <switches>:
     15c:\t2801      \tcmp\tr0, #1
     15e:\td806      \tbhi.n\t16e <switches+0x12>
     160:\te8df f000 \ttbb\t[pc, r0]
     164:\t0402      \t.short\t0x0402
     166:\t0303      \t.short\t0x0303
     168:\t4770      \tbx\tlr
     16a:\tbf00      \tnop
     16c:\t3001      \tadds\tr0, #1
     16e:\t4770      \tbx\tlr

00000180 <interrupt>:
     180:\tb510      \tpush\t{r4, lr}
     182:\t4798      \tblx\tr3
     184:\tf7ff fffe \tbl\t900 <target_elapse>
     188:\tf7ff fffe \tbl\t902 <target_read16>
     18c:\tf7ff ffc8 \tbl\t120 <counts>
     190:\tbd10      \tpop\t{r4, pc}
"""


def frames_of(listing: str) -> dict[int, tuple[Frame, ...]]:
    """Every instruction comes from where it is linked, but a branch of `chooses`: from one that is inlined."""
    found, function = {}, ""
    for line in listing.splitlines():
        if line.endswith(">:"):
            function = line.partition("<")[2][:-2]
        elif "\t" in line:
            found[int(line.partition(":")[0], 16)] = (Frame(function, "a.c", "1"),)
    for address in {0x114, 0x116, 0x118} & found.keys():
        found[address] = (Frame("rare", "a.c", "1"), *found[address])
    return found


def program(listing: str = LISTING, constants: dict[str, bytes] | None = None) -> Program:
    known = frames_of(listing)
    return Program(listing, constants or {}, lambda addresses: {address: known[address] for address in addresses})


def bound(facts: Facts | None = None, never: set[str] | None = None) -> Bound:
    return Bound(program(), facts or Facts(), never or set())


def test_the_longer_branch_counts_and_what_never_runs_does_not() -> None:
    assert bound().of_function("chooses").cost == 5
    assert bound(never={"rare"}).of_function("chooses").cost == 3
    assert bound(never={"a.c:rare"}).of_function("chooses").cost == 3
    assert bound(never={"b.c:rare"}).of_function("chooses").cost == 5


def test_where_nothing_else_is_left_there_is_no_path() -> None:
    assert not bound(never={"leaf"}).of_function("counts").is_possible


def test_a_loop_counts_as_often_as_its_fact_says() -> None:
    # Asked at its end: five times the call, what is called and three more, and three around.
    assert bound(Facts(loops={"counts": 5})).of_function("counts").cost == 2 + 5 * (1 + 2 + 3) + 1
    # Asked at its beginning: once more than it goes round.
    assert bound(Facts(loops={"asks": 5})).of_function("asks").cost == 6 * 2 + 5 * 2 + 1


def test_a_loop_of_which_nothing_is_said_is_an_error_that_says_where() -> None:
    with pytest.raises(ValueError, match=r"no fact on the loop at 124 of counts, counts \(a.c:1\)"):
        bound().of_function("counts")


def test_a_function_may_end_within_an_it_block_and_by_a_jump_to_another() -> None:
    blocks = program().function("leaves_early").blocks
    assert blocks[0x150].returns and blocks[0x150].successors == [0x156]
    assert bound().of_function("leaves_early").cost == 3 + 2 + 5


def test_a_table_of_jumps_is_followed() -> None:
    assert program().function("switches").blocks[0x160].successors == [0x168, 0x16C]
    assert bound().of_function("switches").cost == 2 + 1 + 2


def test_a_table_of_jumps_without_an_end_is_not_understood() -> None:
    with pytest.raises(ValueError, match="160: no comparison before a jump through a table"):
        program(LISTING.replace("cmp\tr0, #1", "tst\tr0, r1")).function("switches")


def test_what_is_called_through_a_pointer_has_to_be_said() -> None:
    with pytest.raises(ValueError, match=r"no fact on the call through a pointer at 182 of interrupt"):
        bound().of_function("interrupt")
    with pytest.raises(ValueError, match="interrupt calls nobody through a pointer: there is no such function"):
        bound(Facts(calls={"interrupt": ["nobody"]})).of_function("interrupt")
    facts = Facts(loops={"counts": 1}, calls={"interrupt": ["leaf", "chooses"]})
    assert bound(facts).of_function("interrupt").cost == 2 + 5 + 0 + 1 + (1 + 9) + 1


def test_tables_of_functions_are_read() -> None:
    constants = {"steps": (0x101).to_bytes(4, "little") + (0x111).to_bytes(4, "little")}
    assert program(constants=constants).table("steps") == {"leaf", "chooses"}


def test_steps_end_where_the_facts_say_so() -> None:
    facts = Facts(loops={"counts": 5}, calls={"interrupt": ["leaf"]}, step_ends={"interrupt"})
    assert [way.cost for way in Steps(bound(facts), "interrupt").longest()] == [4, 1 + 1 + 33 + 1, 4 + 36]


def test_a_loop_with_two_entries_is_refused() -> None:
    listing = """
00000100 <tangled>:
     100:\td002      \tbeq.n\t106 <tangled+0x6>
     102:\t3001      \tadds\tr0, #1
     104:\t3001      \tadds\tr0, #1
     106:\t3001      \tadds\tr0, #1
     108:\td1fb      \tbne.n\t102 <tangled+0x2>
     10a:\t4770      \tbx\tlr
"""
    with pytest.raises(ValueError, match="tangled: a loop with two entries"):
        loops_of(program(listing).function("tangled"))


FACTS = """
loop counts ROUNDS  # five
step ends in interrupt
[base]
never a b
one of tasks, x: c
one of tasks, x: d
[whole: base]
at most 30
one of tasks, y: e
"""


def test_facts_add_up(tmp_path: Path) -> None:
    table = tmp_path / "facts.txt"
    table.write_text(FACTS)
    whole = read_facts(table, {"ROUNDS": 5})["whole"]
    assert whole.loops == {"counts": 5} and whole.step_ends == {"interrupt"} and whole.most == 30
    assert whole.left_out() == {"x": {"a", "b", "e"}, "y": {"a", "b", "c", "d"}}
    table.write_text("loops counts 5\n")
    with pytest.raises(ValueError, match=r"facts.txt: not understood: loops counts 5"):
        read_facts(table, {})
    table.write_text("loop counts ROUNDS\n")
    with pytest.raises(ValueError, match=r"facts.txt: not understood: loop counts ROUNDS"):
        read_facts(table, {})
    table.write_text("[whole: none]\n")
    with pytest.raises(ValueError, match=r"there is no mode none above \[whole: none\]"):
        read_facts(table, {})


def test_a_period_contradicts_what_never_runs_or_excludes_each_other() -> None:
    facts = Facts(never={"a"}, kinds={"tasks": {"x": {"c", "d"}, "y": {"d", "e"}}})
    assert contradiction(facts, {"c", "d", "other"}) == ""
    assert contradiction(facts, {"a"}) == "a never run"
    assert contradiction(facts, {"c", "e"}) == "none of the tasks has c e together"


def test_periods_are_read_from_the_log(tmp_path: Path) -> None:
    listing = LISTING + "\n00000200 <drive_control_step>:\n     200:\t4770      \tbx\tlr\n"
    known = frames_of(listing)
    linked = Program(listing, {}, lambda addresses: {address: known[address] for address in addresses})
    regions = Regions(linked, {"rare"}, ["chooses"], ["leaf"])
    assert regions.filter() == "0x100..0x101,0x114..0x119,0x200..0x201"
    log = tmp_path / "log"
    at = (0x114, 0x200, 0x116, 0x100, 0x200, 0x110, 0x100)
    log.write_text("".join(f"Trace 0: 0x7f [00800400/{place:08x}/00000110/ff020200] x\n" for place in at))
    assert list(periods(log, regions, ("leaf",))) == [("leaf", {"rare"}), ("leaf", set())]


def test_many_regions_are_covered_by_few_ranges(monkeypatch: pytest.MonkeyPatch) -> None:
    listing = LISTING + "\n00000200 <drive_control_step>:\n     200:\t4770      \tbx\tlr\n"
    known = frames_of(listing)
    linked = Program(listing, {}, lambda addresses: {address: known[address] for address in addresses})
    regions = Regions(linked, {"rare"}, ["chooses"], ["leaf"])
    monkeypatch.setattr("isr.paths.watch.RANGES", 2)
    assert regions.filter() == "0x100..0x119,0x200..0x201"
