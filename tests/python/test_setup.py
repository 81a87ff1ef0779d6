"""The set-up script calls the package tools only when something is missing, and says plainly what it cannot install.

Every tool that could reach the network or change the machine is replaced by a script that notes its arguments.
"""

import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

import browser

ROOT = Path(__file__).resolve().parents[2]


class Machine:
    """A PATH in front of which fake tools stand; what they were called with is in ``calls``."""

    def __init__(self, folder: Path) -> None:
        self.bin = folder / "bin"
        self.bin.mkdir()
        self.log = folder / "calls"
        self.log.touch()
        self.path = f"{self.bin}:{os.environ['PATH']}"

    def tool(self, name: str, script: str = "", status: int = 0) -> None:
        """Puts a tool that notes its call, runs ``script`` and exits with ``status``."""
        path = self.bin / name
        path.write_text(f'#!/bin/bash\necho "{name} $*" >>"{self.log}"\n{script}\nexit {status}\n', encoding="utf-8")
        path.chmod(0o755)

    def calls(self, name: str) -> list[str]:
        """Arguments of the calls of ``name``."""
        lines = self.log.read_text(encoding="utf-8").splitlines()
        return [line[len(name) + 1 :] for line in lines if line.startswith(name + " ")]

    def hide(self, *names: str) -> None:
        """Takes programs off the path."""
        rest = self.bin.parent / "rest"
        rest.mkdir()
        for folder in map(Path, os.environ["PATH"].split(":")):
            for file in folder.iterdir() if folder.is_dir() else ():
                if file.name not in names and not (rest / file.name).is_symlink():
                    (rest / file.name).symlink_to(file)
        self.path = f"{self.bin}:{rest}"

    def setup(self, *groups: str) -> "subprocess.CompletedProcess[str]":
        """Runs the set-up in the real tree with the fake tools in front; what Playwright would fetch is not there."""
        nowhere = {"PLAYWRIGHT_BROWSERS_PATH": str(self.bin / "none"), "PLAYWRIGHT_DOWNLOAD_HOST": "http://127.0.0.1:9"}
        env = {**os.environ, **nowhere, "PATH": self.path, "PIP_NO_INDEX": "1"}
        return subprocess.run(
            ["bash", str(ROOT / "toolchain/setup.sh"), *groups],
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


BROWSERS = ("chromium", "chromium-browser", "google-chrome")
MISSING_BROWSER = "[[ ${!#} == chromium ]] && exit 1\necho installed"


def test_the_tests_of_the_page_get_the_distributions_chromium(machine: Machine) -> None:
    machine.hide(*BROWSERS)
    machine.tool("dpkg-query", MISSING_BROWSER)
    machine.tool("apt-cache", "echo '  Candidate: 1.0-1'")
    machine.tool("apt-get", f"[[ $* == *install* ]] && cp {machine.bin}/id {machine.bin}/chromium")
    run = machine.setup("build", "test")
    assert run.returncode == 0, run.stderr
    assert "chromium: shows the page" in run.stdout
    assert machine.calls("apt-get")[-1].split()[-1] == "chromium"


def test_a_machine_without_any_chromium_fails_and_says_what_to_do(machine: Machine) -> None:
    machine.hide(*BROWSERS)
    machine.tool("dpkg-query", MISSING_BROWSER)
    machine.tool("apt-cache", "echo '  Candidate: (none)'")
    machine.tool("apt-get", "[[ $* == *chromium* ]] && exit 97")
    run = machine.setup("build", "test")
    assert run.returncode != 0
    assert "installing the Chromium of Playwright" in run.stdout
    assert len(run.stderr.splitlines()) == 1 and "cannot install Chromium" in run.stderr
    assert "by hand: install any chromium" in run.stderr


def test_a_browser_that_is_there_is_enough(machine: Machine) -> None:
    machine.hide(*BROWSERS)
    machine.tool("dpkg-query", MISSING_BROWSER)
    machine.tool("google-chrome")
    run = machine.setup("build", "test")
    assert run.returncode == 0 and machine.calls("apt-get") == [], run.stdout


def test_without_a_browser_the_tests_of_the_page_fail_with_the_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    nothing = SimpleNamespace(chromium=SimpleNamespace(executable_path="/nowhere/chromium"))
    with pytest.raises(pytest.fail.Exception, match=r"setup\.sh build test"):
        browser.found(nothing)
