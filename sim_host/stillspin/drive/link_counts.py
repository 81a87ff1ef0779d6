"""What the drive has counted at its port."""

from __future__ import annotations

from dataclasses import dataclass

from stillspin.drive.describe import unpack
from stillspin.drive.protocol import Request
from stillspin.drive.requester import Requester


@dataclass(frozen=True)
class LinkCounts:
    """Since power-on; the samples since the stream began. Each stays at 65535."""

    damaged: int
    too_long: int
    broken_off: int
    framing: int
    overrun: int
    breaks: int
    lost: int
    unsent: int
    """Samples of the stream that the drive had no room or no time for."""
    refused: int
    """Lines of its console that were not carried out."""


def ask_counts(requester: Requester) -> LinkCounts:
    """Ask for them.

    Raises:
        DriveError: the drive does not say.
    """
    return LinkCounts(*unpack("<9H", requester.request(Request.LINK, repeat=True)))
