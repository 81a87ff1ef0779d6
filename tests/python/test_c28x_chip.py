"""Machine code on the virtual chip: the peripherals, the interrupts and the time are the chip's."""

import itertools

import pytest
from c28x_chip import MILLISECOND, PROGRAMS, ask, blocks, program, put, rows, words

from stillspin.c28x.program import assemble
from stillspin.flash import boot_stream
from stillspin.flash.program import Block, Program

UP = 8 * MILLISECOND
"""The PLL has locked by then, and every program runs."""


def test_an_echo_answers_over_the_serial_line():
    sent = b"Hello, F2808 [z] {A}"
    heard, counts = ask([
        *put(program("echo").words), f"run {UP:x}", "send " + " ".join(f"{octet:x}" for octet in sent),
        f"run {UP + 5 * MILLISECOND:x}", "heard", "counts",
    ])  # fmt: skip
    assert bytes(octet for _, octet in rows(heard, 2)) == sent.swapcase()
    assert counts.split() == ["0", "0", "0", "0"], "no interrupt, nothing lost, nothing unknown, no reset"


def in_ram(name):
    """A program for L0, as it is loaded there: its words alone, and where it begins."""
    text = (PROGRAMS / f"{name}.asm").read_text().replace('.copy   "start.asm"', "")
    text = (PROGRAMS / "start.asm").read_text() + text
    text = text.replace(".org    0x3F7FF6\n        LB      start\n", "").replace(".org    0x3F4000", ".org    0x3F8000")
    return assemble(text)


def test_the_boot_rom_loads_a_program_over_the_serial_line_and_goes_there():
    """Mode pins 110; the loader's clock is slow and so is its line. Then the program sets its own."""
    loaded = in_ram("echo")
    parts = tuple(Block(first, tuple(block)) for first, block in blocks(loaded.words))
    stream = b"A" + boot_stream.to_octets(Program(parts, loaded.symbols["START"]))
    done = 2 * MILLISECOND + len(stream) * 10 * 100_000_000 // 38400 + 10 * MILLISECOND
    load, heard, counts = ask([
        "level 22 0", "rate 9600", f"run {MILLISECOND:x}", "send " + " ".join(f"{octet:x}" for octet in stream),
        f"run {done:x}", "heard", "rate 1c200", "send 6f 6b", f"run {done + 2 * MILLISECOND:x}", "heard", "counts",
    ])  # fmt: skip
    assert bytes(octet for _, octet in rows(load, 2)) == stream, "each octet comes back"
    assert bytes(octet for _, octet in rows(heard, 2)) == b"OK"
    assert counts.split()[2:] == ["0", "0"]


def test_a_pwm_runs_on_its_own_once_it_is_set_up():
    edges, _ = ask([*put(program("toggle").words), f"run {UP + MILLISECOND:x}", "edges", "counts"])
    changes = [(t, a) for t, module, a, _ in rows(edges, 4) if module == 0]
    rising = [t for t, level in changes if level]
    falling = [t for t, level in changes if not level]
    assert len(rising) >= 40
    assert {later - earlier for earlier, later in itertools.pairwise(rising)} == {2000}
    assert {down - up for up, down in zip(rising, falling[-len(rising) :], strict=False)} == {500}


@pytest.mark.parametrize("allowed", [0, 1])
def test_interrupts_nest_through_the_pie(allowed):
    at = program("nested").symbols
    pins, counted, counts = ask([
        *put(program("nested").words), f"put {at['ALLOWED']:x} {allowed}", f"run {UP + 10 * MILLISECOND:x}", "pins",
        f"get {at['TIMERS']:x} 3", "counts",
    ])  # fmt: skip
    timers, within, periods = words(counted)
    changes = rows(pins, 3)
    ticks = [t for t, pin, _ in changes if pin == 7]
    assert int(counts.split()[0]) == timers + periods
    late = [t - ticks[0] - 2500 * round((t - ticks[0]) / 2500) for t in ticks]
    if allowed:
        assert abs(timers - 4 * periods) <= 4
        assert 2 * (periods - 1) <= within <= 3 * periods, "two or three of four ticks fall into the 70 us"
        assert len(ticks) == timers, "none is lost"
        assert max(map(abs, late)) < 100, "only what masks interrupts delays them"
    else:
        assert within == 0
        assert max(late) > 300, "they wait for the end of the other interrupt"
        assert timers < 3.5 * periods, "and of two that wait one is lost"


def test_a_control_program_takes_its_sample_to_the_reference():
    """The converter's code stands still, so that the integrator climbs by the error each period, until it is told
    another reference. What it must be is counted in Python."""
    code, first = 0x320, 0x40
    at = program("control").symbols
    begin, end = 25 * MILLISECOND, 28 * MILLISECOND
    answers = ask([
        *put(program("control").words), f"code 0 {code:x}", f"run {begin:x}", f"get {at['REF']:x} 8",
        f"send {first:x}", f"run {end:x}", f"get {at['REF']:x} 8", "heard", "edges", "counts",
    ])  # fmt: skip
    before, after = words(answers[0]), words(answers[1])
    assert before[:3] == [0, code, 0], "the error is negative: no duty"
    assert before[3] > 50
    below = before[7] << 16 | before[6]
    assert below - (1 << 32) == -code * before[3]
    assert after[0] == first << 4
    total = (after[7] << 16 | after[6]) - (1 << 32)
    heard = rows(answers[2], 2)
    assert [octet for _, octet in heard] == [code >> 4]
    error = (first << 4) - code
    # The number of samples with each reference is known by the sums alone: the new one comes within the run.
    counted = after[3] - before[3]
    new = (total - (below - (1 << 32)) + code * counted) // (error + code)
    assert total == below - (1 << 32) - code * (counted - new) + error * new
    assert 0 < new < counted
    samples = int(answers[4].split()[0])
    assert samples == after[3], "an interrupt each"


def test_the_duty_is_on_the_pins():
    at = program("control").symbols
    reference, code = 0xF0, 0x100
    answers = ask([
        *put(program("control").words), f"code 0 {code:x}", f"run {17 * MILLISECOND:x}", f"send {reference:x}",
        f"run {26 * MILLISECOND:x}", "edges", f"get {at['REF']:x} 8",
    ])  # fmt: skip
    high = [(t, a) for t, module, a, _ in rows(answers[0], 4) if module == 0]
    widths = [down - up for (up, a), (down, _) in itertools.pairwise(high) if a]
    error = (reference << 4) - code
    grown = [b - a for a, b in itertools.pairwise(widths)]
    assert len(grown) > 20
    assert set(grown) <= {error >> 8, (error >> 8) + 1}, "by the error's upper part each period"
    duty = words(answers[1])[2]
    behind = duty - widths[-1]
    assert 0 <= behind <= 2 * ((error >> 8) + 1), "a compare value counts from the next period on"
