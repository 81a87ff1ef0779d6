"""What an update leaves on the chip when a cable, the board or Ctrl-C ends it early, in words."""

from __future__ import annotations

from enum import Enum

from stillspin.errors import StillspinError
from stillspin.exit_codes import ExitCode
from stillspin.link.errors import DriveError


class Stage(Enum):
    """How far an update has come, and what that means for the chip."""

    BEFORE = "nothing was erased: the chip has the image that it had"
    BEGINNING = "take it that no complete image is on the chip any more: its first sector may be erased"
    ERASED = "no complete image is on the chip: it stays in its boot code and runs no drive, the gates stay off"
    SEALING = "whether the image on the chip is complete is not known: if not, it runs no drive and the gates stay off"


class BrokenOffError(DriveError):
    """An update that ended early; `stage` says where. It ends with the status of its cause, 130 for Ctrl-C."""

    def __init__(self, cause: BaseException, stage: Stage) -> None:
        super().__init__(f"{'interrupted' if isinstance(cause, KeyboardInterrupt) else cause}; {stage.value}")
        self.stage = stage
        self.exit_code = cause.exit_code if isinstance(cause, StillspinError) else ExitCode.INTERRUPTED

    def with_remedy(self, command: str) -> BrokenOffError:
        """The same with what to do.

        Args:
            command: that has to be given again.
        """
        jumpers = "" if self.stage is Stage.BEFORE else "leave the jumpers in serial boot, reset the board, then: "
        self.args = (f"{self}. To repeat: {jumpers}{command}",)
        return self
