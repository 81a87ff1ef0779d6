"""Time that passes on a virtual board, and what becomes of it when the chip cannot go on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from stillspin.errors import CampaignError


class StoppedError(CampaignError):
    """The chip of a virtual board cannot go on."""


@contextmanager
def advancing() -> Iterator[None]:
    """Around what lets a board's time pass.

    Raises:
        StoppedError: the board stopped, with its words.
    """
    try:
        yield
    except RuntimeError as error:
        raise StoppedError(f"the virtual board stopped: {error}") from error
