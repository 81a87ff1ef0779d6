"""A process that has the native module of an edition or board, and what a drive answers when it is switched on."""

import os
import subprocess
import sys
from pathlib import Path

DESK = """
import sys
sys.path.insert(0, sys.argv[1])
from stillspin import core
core.load()
from function_desk import Desk
"""

# Switched on with what its memory holds; lines that are typed, and what is answered.
SWITCHED_ON = """
memory = Path(sys.argv[2])
desk = Desk({}, wait=0)
if memory.exists():
    desk.board.eeprom = memory.read_bytes()
desk.wait(200)
for line in sys.argv[3:]:
    print(desk.type(line, 500).replace(line, "", 1).strip("> \\r\\n"))
memory.write_bytes(desk.board.eeprom)
"""
SAVED = "the values have been saved"
IN_FORCE = "the saved values are in force"


def with_build(variable: str, name: str, *command: str, expected: int = 0) -> str:
    """What it says, with the build that this variable of the environment names."""
    done = subprocess.run(
        [sys.executable, *command],
        env={**os.environ, variable: name},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == expected, done.stdout + done.stderr
    return done.stdout + done.stderr


def on(edition: str, *command: str, expected: int = 0) -> str:
    return with_build("STILLSPIN_EDITION", edition, *command, expected=expected)


def switch_on(edition: str, memory: Path, *lines: str) -> list[str]:
    said = on(
        edition, "-c", f"from pathlib import Path{DESK}{SWITCHED_ON}", str(Path(__file__).parent), str(memory), *lines
    )
    return said.splitlines()


def store_of(edition: str, memory: Path) -> str:
    """What the status says of it at power-on."""
    return next(line for line in switch_on(edition, memory, "status") if line.startswith("store"))


def has(edition: str, memory: Path, **values: str) -> bool:
    """Whether a drive that is switched on with the memory has these values."""
    said = switch_on(edition, memory, *(f"get {name}" for name in values))
    starts = [f"{name} = {value}" for name, value in values.items()]
    return all(any(line.startswith(start) for line in said) for start in starts)
