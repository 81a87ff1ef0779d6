"""A virtual board as a process, with a serial port for the tests of the client."""

import os
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

import stillspin

_PATIENCE = 60

needs_board = pytest.mark.skipif(
    not any(Path(stillspin.__file__).parent.glob("_core*.so")), reason="the native module is not built"
)


@contextmanager
def board(directory, *options):
    """The name of the port of a board that runs until the context ends; `can` beside it is its SLCAN adapter."""
    link, adapter = directory / "drive", directory / "can"
    links = ["--serial-link", str(link), "--can-link", str(adapter)]
    command = [sys.executable, "-m", "stillspin", "board", *links, *options]
    log = (directory / "board.log").open("w")
    process = subprocess.Popen(command, stdout=log, stderr=log, env=os.environ)
    try:
        end = time.monotonic() + _PATIENCE
        while not (link.exists() and adapter.exists()):
            assert process.poll() is None, (directory / "board.log").read_text()
            assert time.monotonic() < end
            time.sleep(0.05)
        yield str(link)
    finally:
        process.terminate()
        process.wait(_PATIENCE)
        log.close()
