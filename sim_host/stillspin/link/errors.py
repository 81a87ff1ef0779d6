"""What goes wrong between a client and a drive, each with a message of one line for people."""

from __future__ import annotations


class DriveError(Exception):
    """The drive, or the way to it, did not do what was asked. The command line ends with exit status 1."""


class LinkError(DriveError):
    """The way to the drive cannot be opened, or is lost."""


class NoAnswerError(DriveError):
    """The drive did not answer in time."""


class RefusedError(DriveError):
    """The drive refused a request; `status` is its status code."""

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.status = status
