"""The drive as a library: waiting for a start, following a commissioning, tables with units, and the end."""

import inspect
import json
import re
import struct
from pathlib import Path

import numpy as np
import pytest

from stillspin.drive import Drive, Trigger
from stillspin.drive.protocol import Words
from stillspin.link.errors import DriveError, LinkError

CALLS = {
    "get": lambda drive: drive.get("speed_ramp"),
    "set": lambda drive: drive.set("speed_ramp", 1000),
    "change": lambda drive: drive.change("speed_ramp", 1000),
    "parameters": lambda drive: drive.parameters(),
    "set_scales": lambda drive: drive.set_scales({"current_scale": 1.0}),
    "raw_parameters": lambda drive: drive.raw_parameters(),
    "start": lambda drive: drive.start(100),
    "stop": lambda drive: drive.stop(),
    "let_go": lambda drive: drive.let_go(),
    "coast": lambda drive: drive.coast(),
    "look": lambda drive: drive.look(),
    "reset": lambda drive: drive.reset(),
    "ref": lambda drive: drive.ref(100),
    "save": lambda drive: drive.save(),
    "defaults": lambda drive: drive.defaults(),
    "load": lambda drive: drive.load(),
    "command": lambda drive: drive.command(2),
    "running": lambda drive: drive.running(100).__enter__(),
    "wait_for_run": lambda drive: drive.wait_for_run(1),
    "raw_status": lambda drive: drive.raw_status(),
    "status": lambda drive: drive.status(),
    "faults": lambda drive: drive.faults(),
    "has_faults": lambda drive: drive.has_faults(),
    "signals": lambda drive: drive.signals("speed"),
    "words": lambda drive: drive.words(3, 1),
    "has_words": lambda drive: drive.has_words(Words.PHASE),
    "stream": lambda drive: drive.stream(["speed"]),
    "log": lambda drive: drive.log("speed", duration=0.1),
    "scope_arm": lambda drive: drive.capture("speed"),
    "scope_state": lambda drive: drive.scope_state(),
    "scope_stop": lambda drive: drive.scope_stop(),
    "scope_read": lambda drive: drive.scope_read(None),
    "capture": lambda drive: drive.capture("speed"),
    "commission": lambda drive: drive.commission(),
}
LIBRARY = Path(__file__).resolve().parents[2] / "docs" / "library"
ASK_NOBODY = {"open", "virtual", "close", "hold", "kept_alive", "describe_status"}


def public():
    return {name for name, _ in inspect.getmembers(Drive, callable) if not name.startswith("_")}


def test_every_method_is_tried_behind_the_end():
    assert public() == set(CALLS) | ASK_NOBODY


def test_every_method_is_on_one_page_of_the_book_and_says_what_it_does():
    pages = "\n".join(page.read_text(encoding="utf-8") for page in LIBRARY.glob("*.md"))
    named = re.findall(r"^::: stillspin\.drive\.Drive\.(\w+)$", pages, re.MULTILINE)
    (opening,) = re.findall(r"members: \[(.*)\]", pages)
    assert sorted([*named, *opening.split(", ")]) == sorted({*public(), "__init__", "version"})
    assert all(inspect.getdoc(getattr(Drive, name)) for name in public())


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_every_call_behind_the_end_says_that_the_drive_is_closed(drive, call):
    drive.close()
    with pytest.raises(LinkError, match="is closed: close"):
        call(drive)


def test_a_stream_behind_the_end_says_so_too(drive):
    stream = drive.stream(["speed"])
    drive.close()
    with pytest.raises(LinkError, match="is closed: close"):
        while True:
            stream.next(0.05)


def test_a_start_that_waits_returns_when_the_motor_runs(fake, drive):
    drive.start(300, wait=True)
    assert drive.status().state == "run"
    drive.stop()


def test_a_start_that_waits_raises_in_the_words_of_the_fault(fake, drive):
    fake.start_fault = 1
    with pytest.raises(DriveError, match="does not run: over-current: the comparator opened the gates"):
        drive.start(300, wait=True)


def test_a_start_that_takes_too_long_stops_the_motor(fake, drive, monkeypatch):
    monkeypatch.setattr("stillspin.drive.motion.RUN", 99)
    with pytest.raises(DriveError, match=r"after 0\.2 s"):
        drive.start(300, wait=True, timeout=0.2)
    assert fake.state != 4


def test_a_commissioning_tells_how_far_it_is_to_who_returns_nothing(drive):
    heard = []
    report = drive.commission(on_progress=lambda share, phase: heard.append((share, phase)))
    assert {phase for _, phase in heard} >= {"staircase"}
    assert all(0 <= share <= 1 for share, _ in heard)
    assert report.values


def recordings(drive):
    yield drive.capture("speed", "current_q", trigger=Trigger("speed", 0.0, "now"))
    yield drive.log("speed", "current_q", duration=0.3, period=0.01)


def test_captures_and_logs_are_tables_of_arrow_with_units(drive):
    for recording in recordings(drive):
        table = recording.table()
        assert table.column_names == ["time", "speed", "current_q"]
        assert [table.field(name).metadata[b"unit"] for name in table.column_names] == [b"s", b"rpm", b"A"]
        assert json.loads(table.schema.metadata[b"stillspin"])["firmware"] == drive.identity.text
        np.testing.assert_array_equal(table.column("speed").to_numpy(), recording.signals["speed"])
        assert table.num_rows == recording.time.size > 0


def test_captures_and_logs_are_frames_of_pandas_with_units(drive):
    for recording in recordings(drive):
        frame = recording.frame()
        assert frame.attrs["units"] == {"time": "s", "speed": "rpm", "current_q": "A"}
        assert frame.attrs["about"]["firmware"] == drive.identity.text
        np.testing.assert_array_equal(frame["speed"], recording.signals["speed"])


def test_a_log_has_the_drives_time_and_what_was_lost(drive):
    log = drive.log("speed", duration=0.5, period=0.02)
    assert np.diff(log.time).min() > 0
    assert log.lost == 0
    assert struct.calcsize("d") == log.signals["speed"].itemsize
