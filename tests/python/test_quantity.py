"""Numbers as people type them: one rule for the client, the page, `--set` and files."""

import string
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stillspin.errors import InputError
from stillspin.quantity import Range

POLES = Range(1, 20, whole=True, decimals=0)
CURRENT = Range(0.1, 16, "A", decimals=2, set_by="trip_current")


@pytest.mark.parametrize(
    ("typed", "number"),
    [
        ("1.5", 1.5),
        (" 2 A ", 2.0),
        ("2A", 2.0),
        ("2 a", 2.0),
        ("1e1", 10.0),
        ("1.5E+0A", 1.5),
        (".5", 0.5),
        ("5.", 5.0),
        ("+3", 3.0),
    ],
)
def test_digits_one_point_an_exponent_and_the_unit_are_taken(typed, number):
    assert CURRENT.read(typed, "current_limit") == number


@pytest.mark.parametrize(("typed", "number"), [("2.0", 2), ("1e1", 10), (4, 4), (4.0, 4), ("20", 20)])
def test_whole_numbers_may_be_written_as_any_number(typed, number):
    read = POLES.read_whole(typed, "pole_pairs")
    assert read == number and type(read) is int


@pytest.mark.parametrize(
    ("allowed", "typed", "words"),
    [
        (POLES, "2.5", "pole_pairs: 2.5 is not a whole number; 1 … 20"),
        (POLES, 2.5, "pole_pairs: 2.5 is not a whole number; 1 … 20"),
        (POLES, "25e-1", "pole_pairs: 25e-1 is not a whole number; 1 … 20"),
        (POLES, "2 A", "pole_pairs has no unit, not in A: '2 A'; 1 … 20"),
        (
            CURRENT,
            "1,5",
            "'1,5' is no number: no comma or space within it, decimals come after a point; 0.10 … 16.00 A",
        ),
        (CURRENT, "1,000", "'1,000' is no number: no comma"),
        (CURRENT, "1.000,5", "'1.000,5' is no number: no comma"),
        (CURRENT, "1,5 A", "'1,5 A' is no number: no comma"),
        (CURRENT, "1 000 A", "'1 000 A' is no number: no comma or space within it"),
        (POLES, "1 0", "'1 0' is no number: no comma or space within it"),
        (CURRENT, "1.2.3", "'1.2.3' is no number; 0.10"),
        (CURRENT, "16.004", "16.004 A is out of range; 0.10 … 16.00 A (trip_current)"),
        (CURRENT, "1e3 A", "1e3 A is out of range; 0.10 … 16.00 A (trip_current)"),
        (CURRENT, 17, "17 A is out of range"),
        (CURRENT, "1 mA", "is in A, not in mA: '1 mA'"),
        (CURRENT, "nan", "'nan' is no number"),
        (CURRENT, "1e999", "1e999 A is no number"),
        (CURRENT, float("inf"), "inf A is no number"),
        (CURRENT, True, "True is no number"),
        (POLES, True, "True is no number; 1 … 20"),
        (Range(0, 1), True, "True is no number; 0 … 1"),
        (CURRENT, None, "None is no number"),
        (CURRENT, "", "'' is no number"),
        (CURRENT, "٣", "'٣' is no number"),
        (CURRENT, "1_0", "not in _0"),
    ],
)
def test_a_complaint_has_the_value_as_typed_and_what_holds(allowed, typed, words):
    with pytest.raises(InputError) as caught:
        allowed.read(typed, "pole_pairs" if allowed is POLES else "current_limit")
    assert words in str(caught.value)


def test_true_and_false_are_a_switch_s_1_and_0():
    switch = Range(0, 1, whole=True)
    assert [switch.read(given, "mtpa") for given in (True, False, 1, 0.0, "1")] == [1, 0, 1, 0, 1]


@given(st.text(string.digits + ".,eE+- A", max_size=12))
def test_what_is_taken_is_what_python_reads_and_never_has_a_comma(typed):
    try:
        number = Range(unit="A").read(typed, "x")
    except InputError:
        return
    assert "," not in typed
    assert number == float(typed.replace("A", ""))


def test_what_a_signal_counts_or_stands_for_is_whole_and_what_it_measures_is_not(drive):
    state, speed = drive.table.signal("state"), drive.table.signal("speed")
    assert [state.to_raw(value) for value in ("2", "2.0", 4)] == [2, 2, 4]
    for value in ("2.5", 2.5):
        with pytest.raises(InputError, match=r"state: 2\.5 is not a whole number"):
            state.to_raw(value)
    assert speed.to_raw("2.5 rpm") == 5 << 15
    plain = replace(state, unit="Bd")  # a value in a unit, of which the drive has no fractions
    assert plain.to_raw(2.6) == 3
