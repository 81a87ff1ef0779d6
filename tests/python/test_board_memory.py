"""What the drive saves outlives the board that saved it: the EEPROM of the virtual board as a file."""

from __future__ import annotations

import subprocess
import sys
from contextlib import contextmanager

import pytest
from typer.testing import CliRunner

from stillspin import cli
from stillspin.drive import Drive
from stillspin.drive.requester import wait_until

pytest.importorskip("stillspin._core", reason="the native module is not built")


@contextmanager
def board(directory):
    """A drive on a board that keeps its memory in a file."""
    link, memory = directory / "drive", directory / "memory.bin"
    words = ["board", "--speed", "0", "--serial-link", str(link), "--eeprom", str(memory)]
    command = [sys.executable, "-m", "stillspin", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        for line in process.stdout:
            if line.startswith("switch off"):
                break
        with Drive.open(str(link), timeout=5.0) as drive:
            yield drive
        process.terminate()
        process.communicate(timeout=30.0)
    assert process.returncode == 0


def test_what_is_saved_is_there_at_the_next_power_on(tmp_path):
    with board(tmp_path) as drive:
        drive.set("speed_ramp", 1234.0)
        drive.save()
        drive.set("speed_ramp", 2345.0)  # and not saved
    assert (tmp_path / "memory.bin").stat().st_size == 32768
    with board(tmp_path) as drive:
        assert wait_until(lambda: drive.get("speed_ramp") == 1234.0, 10.0)


def test_a_file_that_is_no_memory_is_refused_and_left_alone(tmp_path):
    file = tmp_path / "notes.txt"
    file.write_text("not a memory", encoding="utf-8")
    done = CliRunner().invoke(cli.app, ["board", "--eeprom", str(file), "--for", "0"])
    assert done.exit_code == 2
    assert "12 octets" in done.stderr
    assert file.read_text(encoding="utf-8") == "not a memory"
