"""`stillspin image inject`: non-atomic accesses and spoiled registers are found, and nothing else is."""

import pytest
from c28x_chip import PROGRAMS, linked_file, program
from in_process import stillspin

from stillspin.errors import CampaignError, InputError
from stillspin.image import opened, vectors
from stillspin.image.inject import Stretch, inject

TICK = 38
UP = 0.01


@pytest.fixture
def tried(tmp_path):
    """The report of a stretch of a program, and the program's names."""
    boards = []

    def run(name, begin, end, vector, *, replaced=None, watched=(), after=UP, most=400):
        source = PROGRAMS / f"{name}.asm"
        if replaced:
            (tmp_path / "start.asm").write_text((PROGRAMS / "start.asm").read_text())
            text = source.read_text()
            source = tmp_path / f"{name}.asm"
            assert replaced[0] in text
            source.write_text(text.replace(*replaced))
        image = opened.read(linked_file(tmp_path, name, [source]))
        at = image.names.addresses
        while boards:
            boards.pop().close()
        board = opened.power_on(image, "bench", "A", 1)
        boards.append(board)
        opened.advance(board, after)
        return inject(board, Stretch(at[begin], at[end], vector, watched, most, 0.05)), at

    yield run
    for board in boards:
        board.close()


def test_a_counter_in_three_steps_loses_an_interrupt(tried):
    report, at = tried("shared", "torn", "whole", TICK)
    assert len(report.executed) == 4
    assert [address for address, _ in report.differences] == [at["torn"] + 3, at["torn"] + 4], "between MOV and MOV"
    for _, differences in report.differences:
        (lost,) = [one for one in differences if one.what == at["COUNT"]]
        assert lost.value == lost.before - 1 == lost.after - 1


def test_one_step_and_a_guarded_access_are_safe(tried):
    for begin, end in (("whole", "guard"), ("guard", "again")):
        report, _ = tried("shared", begin, end, TICK)
        assert report.differences == []
        assert report.unclear == report.spoilt == []


def test_what_is_masked_to_the_end_is_held_off(tried):
    longer = ("CLRC    INTM\n        NOP\nagain:  B", "NOP\n        NOP\nagain:  CLRC    INTM\n        B")
    report, at = tried("shared", "guard", "again", TICK, replaced=longer)
    assert report.differences == []
    assert at["guard"] not in report.held_off
    assert len(report.held_off) == len(report.executed), "all but the first; and at the end"


def test_a_register_that_is_not_put_back_is_found(tried):
    report, at = tried("shared", "whole", "guard", TICK, replaced=("#tick", "#careless"))
    assert report.differences == [], "it is spoilt before and behind alike"
    assert report.spoilt[0][0] == at["whole"]
    assert {one.what for _, registers in report.spoilt for one in registers} == {"XAR7"}
    first = report.spoilt[0][1][0]
    assert (first.before, first.value) == (0x12345, 0x8000)


@pytest.mark.parametrize(
    ("replaced", "spoilt"),
    [(None, set()), (("PUSH    RPC", "NOP\n        ADDB    SP,#2"), {"RPC"}), (("PUSH    XT", "PUSH    XAR5"), {"XT"})],
)
def test_an_interrupt_may_call_the_function_that_it_came_into(tried, replaced, spoilt):
    """It saves what cl2000 saves; only what it forgets is found, wherever it comes."""
    report, at = tried("divides", "loop", "behind", TICK, replaced=replaced)
    assert len(report.executed) == 18
    assert at["divide"] in report.executed
    assert report.differences == report.unclear == report.held_off == []
    assert {one.what for _, registers in report.spoilt for one in registers} == spoilt


def test_an_interrupt_that_is_off_is_said_to_be(tried):
    with pytest.raises(CampaignError, match="never taken"):
        tried("shared", "torn", "whole", 39)


def test_places_that_are_never_reached(tried):
    with pytest.raises(CampaignError, match="beginning"):
        tried("shared", "careless", "torn", TICK)
    with pytest.raises(CampaignError, match=r"the end, was not reached within 0\.05 s; the program is at 0x3F4"):
        tried("shared", "torn", "careless", TICK)


def test_the_control_program_s_loop_stands_it(tried):
    report, _ = tried("control", "beside", "beside", 32, after=0.03)
    assert len(report.executed) == 3
    assert report.differences == []


def test_the_command_says_that_the_control_program_stands_it(tmp_path):
    image = linked_file(tmp_path, "control")
    stretch = ["--interrupt", "INT1.1", "--after", "0.03", "--from", "beside", "--to", "beside"]
    done = stillspin("image", "inject", image, *stretch)
    assert done.exit_code == 0, done.stderr
    assert "each time" in done.stdout


def test_the_set_up_of_the_interrupts_stands_it(tried):
    """From the permission on: the background of `nested` goes to sleep, and the timer comes by itself."""
    at = program("nested").symbols
    report, _ = tried("nested", "sleep", "tick", TICK, watched=[(at["PERIODS"], 1)])
    assert report.differences == []


def test_interrupts_by_ti_s_names():
    for vector in (13, 14, 32, 39, 40, 127):
        assert vectors.number(vectors.name(vector).lower(), "--interrupt") == vector
    for text in ("INT0.1", "INT13.1", "INT1.9", "INT5", "NMI", ""):
        with pytest.raises(InputError, match="--interrupt"):
            vectors.number(text, "--interrupt")


def test_the_command_names_the_place(tmp_path):
    image = linked_file(tmp_path, "shared")
    command = ["image", "inject", image, "--interrupt", "INT1.7", "--after", "0.01"]
    done = stillspin(*command, "--from", "torn", "--to", "whole", "--compare", "COUNT")
    assert done.exit_code == 1, done.stderr
    lines = (PROGRAMS / "shared.asm").read_text().splitlines()
    store = 1 + next(k for k, line in enumerate(lines) if "MOV     @COUNT,AL" in line)
    assert f"(shared.asm:{store})" in done.stdout
    assert "COUNT (0x8000) is 0x" in done.stdout
    assert "2 places at which" in done.stdout
    done = stillspin(*command, "--from", "whole", "--to", "guard")
    assert done.exit_code == 0
    assert "each time" in done.stdout


def test_a_stretch_that_is_too_long_says_what_to_give(tmp_path):
    image = linked_file(tmp_path, "shared")
    command = ["image", "inject", image, "--interrupt", "INT1.7", "--after", "0.01", "--from", "torn", "--to", "whole"]
    done = stillspin(*command, "--most", "1")
    assert done.exit_code == 1
    assert "was not reached within 1 instruction; the program is at 0x" in done.stderr
    assert "; allow more with --most" in done.stderr
    done = stillspin(*command[:-4], "--from", "0x3F7000", "--within", "0.001")
    assert done.exit_code == 1
    assert "0x3F7000, the beginning, was not reached within 0.001 s; give it longer with --within" in done.stderr
