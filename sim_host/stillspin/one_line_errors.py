"""Command line errors in one line on stderr, instead of a page of usage or a traceback."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Sequence
from types import FrameType
from typing import Any

from typer.core import TyperGroup
from typer.exceptions import TyperException

from stillspin.errors import CampaignError, InputError
from stillspin.link.errors import DriveError

BROKEN = 1
BAD_INPUT = 2
INTERRUPTED = 130


class OneLineErrors(TyperGroup):
    """A group of commands that says what was wrong in one line.

    Exit status: 2 for bad input (also the command line's own complaints), 1 when the runs could not be carried out or
    the drive did not do what was asked, 130 when interrupted, by Ctrl-C or SIGTERM.
    """

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        windows_expand_args: bool = True,
        **extra: Any,
    ) -> Any:
        """Run the command line and end the process (unless `standalone_mode` is off)."""
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, _interrupt)
        try:
            status = super().main(args, prog_name, complete_var, False, windows_expand_args, **extra)
            if status == INTERRUPTED:
                _complain("interrupted; what was finished before is kept", status)
        except InputError as error:
            status = _complain(str(error), BAD_INPUT)
        except TyperException as error:
            status = _complain(error.format_message(), error.exit_code)
        except (CampaignError, DriveError) as error:
            status = _complain(str(error), BROKEN)
        if standalone_mode:
            sys.exit(status if isinstance(status, int) else 0)
        return status


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    """Whoever is told to end does it as by Ctrl-C: motors are stopped, boards switched off."""
    raise KeyboardInterrupt


def _complain(message: str, status: int) -> int:
    print("stillspin:", " ".join(message.split()), file=sys.stderr)
    return status
