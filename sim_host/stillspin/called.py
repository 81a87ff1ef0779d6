"""How this program is called, so that the commands that it proposes can be pasted."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

NAME = "stillspin"


def called() -> str:
    """`stillspin` where the shell finds it by that name, else the path by which it was called."""
    typed = sys.argv[0]
    if Path(typed).stem != NAME:
        return NAME  # python -m stillspin, or a program of somebody else's
    found = shutil.which(NAME)
    return NAME if found and Path(found).samefile(typed) else typed
