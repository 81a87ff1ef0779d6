"""The firmware that this computer's virtual drive runs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from stillspin.board.virtual_transport import VirtualTransport
from stillspin.drive import describe
from stillspin.drive.describe import Ask
from stillspin.drive.protocol import Request
from stillspin.drive.requester import Requester


@contextmanager
def virtual_ask() -> Iterator[Ask]:
    """Asks a virtual drive that is switched on for this alone.

    Raises:
        InputError: there is a virtual drive in this process already, or none at all.
    """
    requester = Requester(VirtualTransport(speed=0.0), timeout=5.0)

    def ask(kind: Request, body: bytes) -> bytes:
        return requester.request(kind, body, repeat=True)

    try:
        yield ask
    finally:
        requester.close()


def firmware() -> str:
    """Version, board file, build and table of the firmware, as a board in the loop tells them of its own.

    What runs natively is no image with a commit of its own: it is compiled with this package, of the same sources.
    """
    with virtual_ask() as ask:
        own = describe.identity(ask)
    return own.text if own.commit else own.built("compiled with this package")
