"""Any octets: the virtual board's SLCAN adapter and the client's readers (any_octets.py has the properties)."""

import random

import any_octets
import pytest
from hypothesis import given
from hypothesis import strategies as st

checks = pytest.mark.parametrize("check", any_octets.CHECKS, ids=lambda check: check.__name__)


@checks
@given(octets=st.binary(max_size=400))
def test_any_octets(check, octets):
    check(octets)


@given(
    words=st.lists(
        st.one_of(
            st.from_regex(rb"[SsOLCtTrRFZVN][0-9A-Fa-f]{0,26}\r", fullmatch=True),
            st.sampled_from([b"S6\r", b"O\r", b"L\r", b"C\r", b"Z1\r", b"\r"]),
            st.binary(max_size=4),
        ),
        max_size=20,
    )
)
def test_commands_of_the_adapter_in_any_order(words):
    any_octets.slcan(b"".join(words))


@checks
def test_words_of_the_protocols_cut_and_disturbed(check):
    source = random.Random(17)
    for _ in range(500):
        check(any_octets.some_octets(source))
