"""A Python environment with nothing but a wheel and what that wheel says it needs, without index, pip or compiler."""

import os
import subprocess
import sys
import venv
from importlib.metadata import distribution
from pathlib import Path

from packaging.requirements import Requirement


def closure(names):
    """These distributions of this environment and all that they need."""
    found, waiting = {}, list(names)
    while waiting:
        wanted = Requirement(waiting.pop())
        if wanted.name in found or (wanted.marker and not wanted.marker.evaluate({"extra": ""})):
            continue
        found[wanted.name] = distribution(wanted.name)
        waiting += found[wanted.name].requires or []
    return found.values()


class Environment:
    """A directory with a Python; `run` starts programs that see nothing else."""

    def __init__(self, where):
        venv.create(where, with_pip=False, symlinks=True)
        self.home = where / "home"
        self.home.mkdir()
        self.bin = where / "bin"
        self.python = self.bin / "python"
        (self._site,) = where.glob("lib/python*/site-packages")

    def lend(self, distributions):
        """Make distributions of the environment of the tests appear in this one."""
        for one in distributions:
            tops = {file.parts[0] for file in one.files or ()} - {"..", "__pycache__"}
            for top in tops:
                place = self._site / top
                if not place.exists():
                    place.symlink_to(Path(one.locate_file(top)))

    def install(self, wheel):
        """Install a wheel; what it needs must be there."""
        pip = [sys.executable, "-m", "pip", "--python", self.python, "--disable-pip-version-check"]
        subprocess.run([*pip, "install", "--quiet", "--no-index", "--no-compile", wheel], check=True, timeout=120)

    @property
    def variables(self):
        """Of the programs that run in it: no other program is to be found, above all no compiler and no git."""
        language = {name: value for name, value in os.environ.items() if name.startswith(("LANG", "LC_"))}
        return {"PATH": str(self.bin), "HOME": str(self.home), "COLUMNS": "200", **language}

    def run(self, program, *arguments, timeout=60, **variables):
        """What a program of this environment said, and its exit status."""
        return subprocess.run(
            [self.bin / program, *map(str, arguments)],
            cwd=self.home,
            env={**self.variables, **variables},
            capture_output=True,
            text=True,
            timeout=timeout,
            stdin=subprocess.DEVNULL,
            check=False,
        )
