"""The boot ROM's serial loader: autobaud, then a stream of which it echoes every octet.

It has no check sum, no time-out and no way back: the echo is all there is. Octets go out a few ahead of their echoes,
but the last word, behind which the ROM jumps, only when all before it have come back right.
"""

from __future__ import annotations

from collections.abc import Callable

from stillspin.flash import boot_stream
from stillspin.flash.line import Line, drop
from stillspin.flash.program import Program
from stillspin.link.errors import LinkError, NoAnswerError

RATE = 38400
"""The highest usual rate that the ROM makes of a 20 MHz crystal: its clock is 2.5 MHz."""
AHEAD = 16
"""Octets under way at most. The ROM has an octet's time for each, and needs a tenth of it."""
_LETTER = b"A"
_LETTER_WAIT = 2.0
"""Seconds; a letter that is sent while the echo of the one before is under way is data for the ROM, a wrong key."""
_ECHO_WAIT = 5.0
"""Seconds; an echo that is this late never comes, and a computer that is busy does other things first."""

Progress = Callable[[int, int], None]
"""Octets done, octets in all."""


def locks(line: Line, attempts: int) -> bool:
    """Send the letter until the ROM has found the rate by it and echoes it."""
    for _ in range(attempts):
        line.write(_LETTER)
        if line.read(1, _LETTER_WAIT) == _LETTER:
            return True
        drop(line)
    return False


def load(line: Line, program: Program, progress: Progress) -> None:
    """Send a program to a ROM whose rate is locked; it runs afterwards.

    Raises:
        LinkError: an echo is missing or wrong, or the port is lost.
    """
    assert program.entry is not None
    body = b"".join(octets for block in program.blocks for octets in boot_stream.block_octets(block))
    stream = boot_stream.head(program.entry) + body
    total = len(stream) + len(boot_stream.END)
    done = 0
    for at in range(0, len(stream), AHEAD):
        piece = stream[at : at + AHEAD]
        _send(line, piece, at, total)
        done += len(piece)
        progress(done, total)
    for octet in boot_stream.END:
        _send(line, bytes((octet,)), done, total)
        done += 1
    progress(done, total)


def _send(line: Line, piece: bytes, at: int, total: int) -> None:
    line.write(piece)
    echoed = b""
    while len(echoed) < len(piece):
        more = line.read(len(piece) - len(echoed), _ECHO_WAIT)
        if not more:
            raise NoAnswerError(f"{line.name}: no echo of octet {at + len(echoed) + 1} of {total}: {_REMEDY}")
        echoed += more
    for index, (sent, heard) in enumerate(zip(piece, echoed, strict=True)):
        if sent != heard:
            raise LinkError(
                f"{line.name}: octet {at + index + 1} of {total} was 0x{sent:02X} and came back as 0x{heard:02X}: "
                f"{_REMEDY}"
            )


_REMEDY = "check the cable, reset the board with its jumpers in serial boot and repeat; the flash was not touched"
