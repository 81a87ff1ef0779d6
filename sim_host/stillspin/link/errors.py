"""What goes wrong between a client and a drive, each with a message of one line for people."""

from __future__ import annotations

from stillspin.errors import StillspinError
from stillspin.exit_codes import ExitCode


class DriveError(StillspinError):
    """The drive, or the way to it, did not do what was asked."""


class LinkError(DriveError):
    """The way to the drive cannot be opened, or is lost."""

    exit_code = ExitCode.NO_CONNECTION


def gone(name: str) -> LinkError:
    """The way was there and is not any more; what the system calls it (errno 5, a read without data) helps nobody.

    Args:
        name: of the port or bus, for people.
    """
    return LinkError(f"{name} is gone: look whether its cable is in, and what it leads to is switched on or still runs")


class NoAnswerError(DriveError):
    """The drive did not answer in time."""

    exit_code = ExitCode.NO_CONNECTION


class DifferentError(DriveError):
    """The board is not what it has to be: another chip, image, build or version."""

    exit_code = ExitCode.DIFFERS


class RefusedError(DriveError):
    """The drive refused a request; `status` is its status code."""

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.status = status
