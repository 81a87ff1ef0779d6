"""A virtual board as a process, with a serial port for the tests of the client."""

import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
import serial

import stillspin

_PATIENCE = 120
PATIENT = 2.5
"""Seconds that a page may be silent while it holds a motor: more than by default, for machines that stall."""

needs_board = pytest.mark.skipif(
    not any(Path(stillspin.__file__).parent.glob("_core*.so")), reason="the native module is not built"
)


def open_port(name, rate=115200, **options):
    """A board's serial port, as a program opens it."""
    return serial.Serial(str(name), rate, timeout=1.0, exclusive=True, **options)


@contextmanager
def process(log, links, *arguments):
    """`stillspin` with these arguments, from when these links exist until the context ends; `log` has what it says."""
    with log.open("w") as said:
        running = subprocess.Popen([sys.executable, "-m", "stillspin", *arguments], stdout=said, stderr=said)
        try:
            end = time.monotonic() + _PATIENCE
            while not all(link.exists() for link in links):
                assert running.poll() is None, log.read_text()
                assert time.monotonic() < end
                time.sleep(0.05)
            yield
        finally:
            running.terminate()
            running.wait(_PATIENCE)


@contextmanager
def board(directory, *options):
    """The name of the port of a board that runs until the context ends; `can` beside it is its SLCAN adapter."""
    link, adapter = directory / "drive", directory / "can"
    links = ["--serial-link", str(link), "--can-link", str(adapter)]
    with process(directory / "board.log", (link, adapter), "board", *links, *options):
        yield str(link)
