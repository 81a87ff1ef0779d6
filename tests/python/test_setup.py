"""The set-up script calls the package tools only when something is missing, and says plainly what it cannot install.

Every tool that could reach the network or change the machine is replaced by a script that notes its arguments.
"""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


class Machine:
    """A PATH in front of which fake tools stand; what they were called with is in ``calls``."""

    def __init__(self, folder: Path) -> None:
        self.bin = folder / "bin"
        self.bin.mkdir()
        self.log = folder / "calls"
        self.log.touch()

    def tool(self, name: str, script: str = "", status: int = 0) -> None:
        """Puts a tool that notes its call, runs ``script`` and exits with ``status``."""
        path = self.bin / name
        path.write_text(f'#!/bin/bash\necho "{name} $*" >>"{self.log}"\n{script}\nexit {status}\n', encoding="utf-8")
        path.chmod(0o755)

    def calls(self, name: str) -> list[str]:
        """Arguments of the calls of ``name``."""
        lines = self.log.read_text(encoding="utf-8").splitlines()
        return [line[len(name) + 1 :] for line in lines if line.startswith(name + " ")]

    def setup(self) -> "subprocess.CompletedProcess[str]":
        """Runs the set-up in the real tree with the fake tools in front."""
        env = {**os.environ, "PATH": f"{self.bin}:{os.environ['PATH']}", "PIP_NO_INDEX": "1"}
        return subprocess.run(
            ["bash", str(ROOT / "toolchain/setup.sh")],
            env=env,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    """Root on a Debian machine that has every package; apt-get and sudo fail, which a call would show."""
    made = Machine(tmp_path)
    made.tool("dpkg-query", "echo installed")
    made.tool("id", "echo 0")
    made.tool("apt-get", status=97)
    made.tool("sudo", status=97)
    return made


# dpkg-query's answer when one package alone is missing; the package is the last argument.
MISSING_SUNDIALS = "[[ ${!#} == libsundials-dev ]] && exit 1\necho installed"


def test_nothing_is_fetched_when_nothing_is_missing(machine: Machine) -> None:
    run = machine.setup()
    assert run.returncode == 0, run.stderr
    assert run.stdout == ""
    assert machine.calls("apt-get") == [] and machine.calls("sudo") == []


def test_a_package_that_cannot_be_installed_is_named_in_one_line(machine: Machine) -> None:
    machine.tool("dpkg-query", MISSING_SUNDIALS)
    run = machine.setup()
    assert run.returncode != 0
    assert "libsundials-dev: ARKODE" in run.stdout  # what it installs, and why
    assert len(run.stderr.splitlines()) == 1
    assert "cannot install libsundials-dev; by hand: sudo apt-get install libsundials-dev" in run.stderr


def test_only_what_is_missing_is_installed(machine: Machine) -> None:
    machine.tool("dpkg-query", MISSING_SUNDIALS)
    machine.tool("apt-get")
    assert machine.setup().returncode == 0
    update, install = machine.calls("apt-get")
    assert update.split()[-1] == "update"
    assert install.split()[-1] == "libsundials-dev" and "--no-install-recommends" in install


def test_without_root_and_password_it_fails_instead_of_waiting(machine: Machine) -> None:
    machine.tool("dpkg-query", MISSING_SUNDIALS)
    machine.tool("id", "echo 1000")
    run = machine.setup()
    assert run.returncode != 0
    assert "sudo apt-get install libsundials-dev" in run.stderr
    assert machine.calls("sudo") and all(call.startswith("-n ") for call in machine.calls("sudo"))


def test_a_machine_without_clang_gets_the_newest_in_the_lists(machine: Machine) -> None:
    for version in range(14, 23):
        machine.tool(f"clang-{version}", status=1)
    machine.tool("clang", status=1)
    # As apt-cache does: 21 is only mentioned by another package, 22 unknown.
    machine.tool(
        "apt-cache",
        "case ${!#} in clang-14 | clang-16 | clang-19) echo '  Candidate: 1:1.0-1' ;;"
        " clang-21) echo '  Candidate: (none)' ;; esac",
    )
    machine.tool("apt-get")
    run = machine.setup()
    assert run.returncode == 0, run.stderr
    assert machine.calls("apt-get")[-1].split()[-1] == "clang-19"
