"""What carries records: the interface of the serial port, the CAN bus and the virtual board."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Protocol

from stillspin.link.records import Record
from stillspin.link.splitter import Item


class Transport(Protocol):
    """A way to one drive. One thread receives, any thread sends."""

    @property
    def name(self) -> str:
        """For people: the port, the bus and node."""
        ...

    @property
    def has_console(self) -> bool:
        """Whether text goes through it, too."""
        ...

    @property
    def port(self) -> tuple[int, int] | None:
        """File descriptor of the port and node of the CAN bus (0: none) where other code may carry records itself."""
        ...

    def send(self, record: Record) -> None:
        """Hand a record over.

        Raises:
            LinkError: the way is lost.
        """
        ...

    def send_text(self, octets: bytes) -> None:
        """Hand console text over.

        Raises:
            LinkError: the way is lost, or has no console.
        """
        ...

    def receive(self, timeout: float) -> list[Item]:
        """What has come, in order; waits up to `timeout` seconds for something.

        Raises:
            LinkError: the way is lost.
        """
        ...

    def beats(self, interval: float, end: threading.Event) -> Iterator[None]:
        """One every `interval` seconds of the drive's time, until the end."""
        ...

    def close(self) -> None:
        """Give the port back. May be called twice."""
        ...


def beats_of_clock(interval: float, end: threading.Event) -> Iterator[None]:
    """The beats of a drive whose time is the clock's."""
    while not end.wait(interval):
        yield
