"""Campaigns on worker processes that are interrupted: what is done is written, the status is 130, nobody is left."""

import os
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

pytest.importorskip("stillspin._core", reason="the native module is not built")

PATIENCE = 300.0
ALONE = ("--no-commission", "--no-paper-scheme", "--no-nameplate")
COMMANDS = {
    "reproduce": (
        "reproduce",
        "A14",
        "A10",
        "A11",
        "A15",
        "A16",
        "A17",
        "--no-commission",
        "--no-paper-scheme",
        "--no-nameplate",
    ),
    "explain": ("explain", "A10"),
    "startup-matrix": ("startup-matrix",),
    "hil": ("hil", "A14", "A10", "A11", "--port", "virtual", "--json", "rows.json"),
}
WORKED = 6.0  # s of computing by one worker, when there is nothing else to see
WAYS = [
    *((name, True) for name in COMMANDS),
    *((name, False) for name in ("reproduce", "hil")),  # the others have the workers of reproduce
]


def of_session(leader):
    """Processes of a session: seconds of computing by their number."""
    found = {}
    for entry in Path("/proc").iterdir():
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except (OSError, IndexError):
            continue
        state, session, ticks = fields[0], int(fields[3]), int(fields[11]) + int(fields[12])
        if session == leader and state != "Z":
            found[int(entry.name)] = ticks / os.sysconf("SC_CLK_TCK")
    return found


def until(true, what):
    end = time.monotonic() + PATIENCE
    while not true():
        assert time.monotonic() < end, f"{what}: not within {PATIENCE:g} s"
        time.sleep(0.05)


def something_is_done(name, folder, leader):
    if name == "hil":
        return (folder / "rows.json").exists()
    if name == "reproduce":  # with six of its nine runs: not both workers can still be at their first evaluation
        return len(list(folder.glob(".results-*/runs/*.parquet"))) >= 6
    return any(seconds > WORKED for number, seconds in of_session(leader).items() if number != leader)


@pytest.mark.parametrize(("name", "all_of_them"), WAYS)
def test_what_is_done_is_written_and_nobody_is_left(tmp_path, name, all_of_them):
    words = [*COMMANDS[name], "--jobs", "2"]
    if name != "explain":
        words += ["--junit", "j.xml"]
    started = subprocess.Popen(
        [sys.executable, "-m", "stillspin", *words],
        cwd=tmp_path,
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        until(lambda: something_is_done(name, tmp_path, started.pid) or started.poll() is not None, "something done")
        assert started.poll() is None, started.communicate()
        time.sleep(0.5)  # what is done in a worker has reached the command
        (os.killpg if all_of_them else os.kill)(started.pid, signal.SIGINT)
        said = started.communicate(timeout=PATIENCE)
        until(lambda: not of_session(started.pid), "the last process gone")
    finally:
        for number in of_session(started.pid):
            os.kill(number, signal.SIGKILL)
    assert started.returncode == 130, said
    assert said[1] == "stillspin: interrupted; what was finished before is kept\n"
    assert not list(tmp_path.glob(".*")), "a directory that was begun"
    if name == "explain":
        return
    *done, last = ET.parse(tmp_path / "j.xml").getroot().iter("testcase")
    assert done
    assert last.find("error").get("message") == "the command did not come to its end: interrupted"
    if name == "hil":
        assert '"identical"' not in (tmp_path / "rows.json").read_text()
        assert len(done) == (tmp_path / "rows.json").read_text().count('"scenario"')
