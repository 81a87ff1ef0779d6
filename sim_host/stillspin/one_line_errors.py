"""Command line errors in one line on stderr, instead of a page of usage or a traceback."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Sequence
from types import FrameType
from typing import Any

from typer import Abort
from typer.core import TyperGroup
from typer.exceptions import TyperException

from stillspin.errors import StillspinError
from stillspin.exit_codes import ExitCode

HELP = {"help_option_names": ["-h", "--help"]}
"""Settings of the whole command line: commands inherit them."""


class OneLineErrors(TyperGroup):
    """A group of commands that says what was wrong in one line, and ends with a status of exit_codes.py.

    With nothing behind its name it shows its help, unless it does something by itself.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """See typer."""
        if not args and not self.invoke_without_command and not ctx.resilient_parsing:
            print(ctx.get_help())
            ctx.exit()
        return super().parse_args(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """The commands, each with the first sentence of its help: whole, over as many lines as it takes."""
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        rows = [(name, command.get_short_help_str(1000)) for name, command in commands.items() if command]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

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
            if status == ExitCode.INTERRUPTED:
                _complain("interrupted; what was finished before is kept", status)
            sys.stdout.flush()
        except StillspinError as error:
            status = _complain(str(error), error.exit_code)
        except TyperException as error:
            status = _complain(error.format_message(), error.exit_code)
        except Abort as error:  # a question without an answer
            print(file=sys.stderr)
            if isinstance(error.__context__, EOFError):
                status = _complain("the input ended before the last question; nothing was done", ExitCode.BAD_INPUT)
            else:
                status = _complain("interrupted before the last question; nothing was done", ExitCode.INTERRUPTED)
        except BrokenPipeError:
            status = _nobody_reads()
        except SystemExit as error:
            if not isinstance(error.__context__, BrokenPipeError):
                raise
            status = _nobody_reads()
        if standalone_mode:
            sys.exit(status if isinstance(status, int) else 0)
        return status


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    """Whoever is told to end does it as by Ctrl-C: motors are stopped, boards switched off."""
    raise KeyboardInterrupt


def _nobody_reads() -> int:
    """What is still in a buffer goes nowhere, instead of into a complaint of the interpreter as it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except BrokenPipeError:
            os.dup2(nowhere, stream.fileno())
    return ExitCode.CLOSED_PIPE


def _complain(message: str, status: int) -> int:
    print("stillspin:", " ".join(message.split()), file=sys.stderr)
    return status
