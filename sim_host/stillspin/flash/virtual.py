"""How a virtual board proves that it is one: who simulates the chip answers at its port, in the chip's place.

The question is the first that is said on a port. It has a number that is new every time, and the answer is a hash over
it, which neither boot ROM nor kernel nor drive can make, and no echo. A real board would hear the question before its
boot ROM has found the bit rate; so nobody asks but at a pseudo-terminal, which is all that a virtual board has.
"""

from __future__ import annotations

import hashlib
import secrets
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stillspin.flash.line import Line

_QUESTION = b"stillspin: virtual board? "
_NUMBER = 32
LENGTH = len(_QUESTION) + _NUMBER
_WAIT = 5.0
"""Seconds; a virtual board looks at its port every few milliseconds, on a machine that has time for it."""


def answer(question: bytes) -> bytes:
    """What a virtual board says to a question."""
    return hashlib.sha256(b"a virtual board" + question).hexdigest().encode()


def may_become_question(octets: bytes) -> bool:
    """Whether what has come so far is a question or the beginning of one."""
    return len(octets) <= LENGTH and octets[: len(_QUESTION)] == _QUESTION[: len(octets)]


def is_at(line: Line) -> bool:
    """Whether a virtual board is at the other end; nothing must have been sent before.

    Raises:
        LinkError: the port is lost.
    """
    if not line.is_pseudo_terminal:
        return False
    question = _QUESTION + secrets.token_hex(_NUMBER // 2).encode()
    wanted = answer(question)
    line.write(question)
    heard = b""
    while len(heard) < len(wanted):
        more = line.read(len(wanted) - len(heard), _WAIT)
        if not more:
            return False
        heard += more
    return secrets.compare_digest(heard, wanted)
