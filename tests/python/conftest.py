"""Fixtures: the package with a fake native module, in this process and as a tree that subprocesses import."""

from __future__ import annotations

import re
import shutil
import signal
import sys
from pathlib import Path

import pytest
from desk import PATIENT
from function_desk import Desk
from playwright.sync_api import sync_playwright
from typer.testing import CliRunner

import browser
import fake_core
from fake_drive import FakeDrive
from stillspin import cli
from stillspin.board.pseudo_terminal import PseudoTerminal
from stillspin.drive import Drive
from stillspin.tune.server import Server

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "sim_host" / "stillspin"
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as a shell starts what goes into the background
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what the tests start has to hear it
GONE = re.compile("ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|WebSocket connection to|status of 403")
LONG = (
    *("test_scenarios", "test_interrupted", "test_editions", "test_hil", "test_ways", "test_flash_broken"),
    *("test_client_on_board", "test_faults", "test_tune_on_board", "test_checks", "test_wheel", "test_command_line"),
)


def pytest_collection_modifyitems(items):
    """The files that take longest first: at the end no core waits long for another."""
    items.sort(key=lambda item: LONG.index(item.path.stem) if item.path.stem in LONG else len(LONG))


@pytest.fixture
def core(monkeypatch):
    """The fake native module in place of the real one, whether or not that is built."""
    monkeypatch.setitem(sys.modules, "stillspin._core", fake_core)
    return fake_core


@pytest.fixture
def file(tmp_path):
    """Writes octets as an image file, and says where."""

    def write(octets):
        path = tmp_path / "program.out"
        path.write_bytes(octets)
        return path

    return write


@pytest.fixture
def power():
    """Switches on a virtual board in this process, which has room for one at a time; off behind the test."""
    opened = []

    def switch_on(*arguments, **named):
        opened.append(Desk(*arguments, **named))
        return opened[-1]

    yield switch_on
    for desk in opened:
        desk.board.close()


@pytest.fixture
def port():
    """The serial port of a virtual board, without the board."""
    terminal = PseudoTerminal()
    yield terminal
    terminal.close()


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """A small drive on a pseudo-terminal, and a place of its own for what clients keep of it."""
    for variable in ("XDG_CACHE_HOME", "XDG_STATE_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "home"))
    with FakeDrive() as fake:
        yield fake


@pytest.fixture
def drive(fake):
    """The client of that drive."""
    with Drive.open(f"serial://{fake.port}", timeout=0.3) as drive:
        yield drive


@pytest.fixture
def server(drive, fake):
    """The page's server for that drive; both are more patient than they are by default, for machines that stall."""
    fake.values[200] = 5000  # link_timeout
    with Server(drive, patience=PATIENT) as server:
        yield server


@pytest.fixture(scope="module")
def chromium():
    """The browser that is installed."""
    with sync_playwright() as playwright:
        # No sandbox: it does not start where the tests run as root; the only page opened is this project's.
        launched = playwright.chromium.launch(
            executable_path=browser.found(playwright), args=["--no-sandbox", "--disable-gpu"]
        )
        yield launched
        launched.close()


@pytest.fixture
def page(chromium):
    """A page that must not complain; that a server is gone, or another one is there, the browser says by itself."""
    context = chromium.new_context(viewport={"width": 1280, "height": 860})
    opened = context.new_page()
    complaints = []
    opened.on("pageerror", lambda error: complaints.append(str(error)))
    opened.on("console", lambda m: complaints.append(m.text) if m.type == "error" and not GONE.search(m.text) else None)
    opened.set_default_timeout(15_000)
    yield opened
    context.close()
    assert complaints == []


@pytest.fixture
def call(core, tmp_path, monkeypatch):
    """Calls the command line in an empty directory, with the fake native module."""
    monkeypatch.chdir(tmp_path)

    def invoke(*arguments):
        return CliRunner().invoke(cli.app, [str(argument) for argument in arguments])

    return invoke


@pytest.fixture(scope="session")
def fake_tree(tmp_path_factory):
    """A directory to put on PYTHONPATH: the package's own files, with the fake as its native module.

    Worker processes import everything anew, so they need it as files.
    """
    tree = tmp_path_factory.mktemp("tree")
    skipped = shutil.ignore_patterns("_core*", "__pycache__")
    shutil.copytree(PACKAGE, tree / "stillspin", ignore=skipped)
    for name in ("motors", "profiles", "scenarios", "schemes"):
        shutil.copytree(ROOT / "sim_host" / name, tree / name)
    shutil.copy(Path(fake_core.__file__), tree / "stillspin" / "_core.py")
    return tree
