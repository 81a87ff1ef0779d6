"""The commands that talk to a drive: parameter files, captures as files, the live plot, the console."""

import errno
import json
import os
import re
import signal
import struct
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from prompt_toolkit.document import Document
from screen import terminal

from stillspin import csv_table, mdf
from stillspin.commands import braille, capture_file
from stillspin.commands.completion import COMMANDS, ConsoleWords
from stillspin.commands.transcript import LINE, Transcript
from stillspin.drive import Capture, Trigger
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.report import tables


@pytest.fixture
def ask(call, fake):
    """Calls the command line for the small drive."""
    return lambda *arguments: call(*arguments, "--drive", fake.port)


def test_a_dump_is_loaded_without_a_change(ask, fake, tmp_path):
    fake.values[6] = 14_680_065  # a raw value that no number of two decimals gives
    assert ask("params", "dump", "all.toml").stdout == "8 parameters; see all.toml\n"
    assert "speed_ramp = 3000  # rpm/s; slope of the speed reference" in (tmp_path / "all.toml").read_text()
    before = dict(fake.values)
    result = ask("params", "load", "all.toml")
    assert result.stdout == "0 of 8 parameters changed\n"
    assert fake.values == before
    assert ask("params", "diff", "all.toml").stdout == "0 of 8 parameters different\n"


def test_what_differs_is_shown_and_loaded(ask, fake, tmp_path):
    (tmp_path / "some.toml").write_text("[parameters]\nspeed_ramp = 500\nmotor_poles = 4\n")
    result = ask("params", "diff", "some.toml")
    assert "speed_ramp" in result.stdout
    assert "1 of 2 parameters different" in result.stdout
    result = ask("params", "load", "some.toml", "--save")
    assert "1 of 2 parameters changed, saved" in result.stdout, result.stderr
    assert fake.values[86] == 500 * 2**8
    assert fake.store == 5
    assert "speed_ramp = 500" in ask("params", "dump", "--changed").stdout
    assert "1 of 8 parameters different" in ask("params", "diff", "defaults").stdout


def test_what_the_next_power_on_would_not_have_is_said_behind_what_changed_it(ask, fake, tmp_path):
    lost = "stillspin: 1 parameter is not saved: 'save' keeps what is in force\n"
    (tmp_path / "some.toml").write_text("[parameters]\nspeed_ramp = 500\n")
    assert ask("console", "-c", "status").stderr == ""
    assert ask("params", "load", "some.toml").stderr == lost
    assert ask("console", "-c", "status", "-c", "version").stderr == lost
    assert ask("params", "load", "some.toml", "--save").stderr == ""
    assert ask("console", "-c", "status").stderr == ""


def test_the_pages_server_says_at_its_end_what_is_not_saved(fake):
    serve = [sys.executable, "-m", "stillspin", "tune", "--no-open", "--drive", fake.port]
    with subprocess.Popen(serve, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        assert any(line.startswith("Whoever has this address") for line in running.stdout)
        fake.values[86] = 500 * 2**8
        time.sleep(0.2)
        running.send_signal(signal.SIGINT)
        assert running.communicate(timeout=60)[1].endswith("1 parameter is not saved: 'save' keeps what is in force\n")
        assert running.returncode == 0


def test_nothing_is_sent_of_a_file_that_is_wrong(ask, fake, tmp_path):
    (tmp_path / "bad.toml").write_text("[parameters]\nspeed_ramp = 500\ncurrent_limit = 99\n")
    result = ask("params", "load", "bad.toml")
    assert result.exit_code == 2
    assert "bad.toml: current_limit: 99 A is out of range; 0.10 … 16.00 A" in result.stderr
    assert fake.values[86] == 3000 * 2**8


def test_what_the_drive_refuses_is_said_and_not_saved(ask, fake, tmp_path):
    (tmp_path / "x.toml").write_text("[parameters]\nspeed_limit = 1000\nspeed_ramp = 500\n")
    fake.stubborn = 8
    fake.values[8] = 0
    result = ask("params", "load", "x.toml", "--save")
    assert result.exit_code == 1
    assert "speed_limit: the drive is busy" in result.stderr
    assert "the drive does not take all of x.toml; nothing was saved" in result.stderr
    assert (fake.values[86], fake.store) == (500 * 2**8, 1)


def test_a_conflict_that_the_next_values_resolve_is_none(ask, fake, tmp_path):
    fake.values[164] = 20 * 2**16
    (tmp_path / "x.toml").write_text("[parameters]\nspeed_ramp = 500\nlink_regulation = 300\n")
    assert "2 of 2 parameters changed" in ask("params", "load", "x.toml").stdout
    (tmp_path / "x.toml").write_text("[parameters]\nlink_regulation = 20\nspeed_ramp = 600\n")
    result = ask("params", "load", "x.toml", "--save")
    assert result.exit_code == 1
    assert "2 of 2 parameters changed\n" in result.stdout
    assert "does not start with it: link_regulation must be above link_minimum" in result.stderr
    assert fake.store == 1


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (("params", "dump"), 2, "no drive is given: --drive /dev/ttyUSB0"),
        (("params", "dump", "--drive", "/dev/none"), 3, "there is no serial port /dev/none"),
        (("params", "dump", "--drive", "usb:x"), 2, "must be like serial:///dev/ttyUSB0"),
        (("scope", "speed", "--out", "x.xls"), 2, "x.xls: the ending must be one of .parquet, .csv, .mf4"),
        (("scope", "speed", "--edge", "now", "--level", "5"), 2, "--level: no meaning with --edge now"),
        (("scope", "speed=fast"), 2, "full scale of speed: 'fast' is no number"),
        (("monitor", "--duration", "-1"), 2, "is out of range; 0 … ∞"),
    ],
)
def test_what_is_wrong_is_one_line(call, tmp_path, arguments, status, said):
    result = call(*arguments)
    assert (result.exit_code, result.stderr.count("\n")) == (status, 1)
    assert said in result.stderr


def test_a_capture_is_written_in_every_form(ask, tmp_path):
    files = [f"capture{ending}" for ending in capture_file.WRITERS]
    options = [part for file in files for part in ("--out", file)]
    result = ask("scope", "speed", "current_d=4", "--trigger", "speed", "--level", 5, *options)
    assert result.exit_code == 0, result.stderr
    assert "512 records every 0.1 ms" in result.stdout
    table = pq.read_table(tmp_path / "capture.parquet")
    assert table.column_names == ["time", "speed", "current_d"]
    about = json.loads(table.schema.metadata[b"stillspin"])
    assert about["trigger"]["level"] == 5.0
    drive = re.search(r"board \w+, .*table [0-9a-f]{8}", about["firmware"])
    assert drive
    for ending in set(capture_file.WRITERS) - {".csv", ".parquet"}:
        assert drive[0].encode() in (tmp_path / f"capture{ending}").read_bytes(), ending
    head, rows = csv_table.read(tmp_path / "capture.csv")
    assert (head["firmware"], json.loads(head["trigger"])) == (about["firmware"], about["trigger"])
    assert list(rows[0]) == ["time [s]", "speed [rpm]", "current_d [A]"]
    assert len(rows) == 512
    assert float(rows[128]["time [s]"]) == 0.0
    frame = pd.read_csv(tmp_path / "capture.csv", comment="#")
    assert list(frame) == list(rows[0]), "as the book says"
    assert np.isfinite(frame.to_numpy()).all()
    assert (tmp_path / "capture.png").read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*files, "home"])


def example():
    time_axis = np.arange(5) * 1e-4
    values = {"speed": np.arange(5.0), "current_q": -np.arange(5.0)}
    units = {"speed": "rpm", "current_q": "A"}
    return Capture(time_axis, values, units, ("speed",), Trigger("speed", 1.0, "rising"), 2.5, 1e-4, "1.0")


def links(octets, at):
    (count,) = struct.unpack_from("<Q", octets, at + 16)
    return (
        octets[at : at + 4].decode(),
        struct.unpack_from(f"<{count}Q", octets, at + 24),
        octets[at + 24 + 8 * count :],
    )


def text(octets, at):
    mark, _, data = links(octets, at)
    assert mark == "##TX"
    return data[: data.index(0)].decode()


def test_an_mf4_file_is_the_tree_that_the_standard_draws(tmp_path):
    """Read with nothing but the standard's layout: header, data group, channel group, channels, data."""
    capture = example()
    mdf.write(tmp_path / "x.mf4", capture.time, capture.signals, capture.units, "about")
    octets = (tmp_path / "x.mf4").read_bytes()
    assert octets[:16] == b"MDF     4.10    "
    mark, header, _ = links(octets, 64)
    assert mark == "##HD"
    assert text(octets, header[5]) == "about"
    _, group, _ = links(octets, header[0])
    mark, channel_group, sizes = links(octets, group[1])
    assert mark == "##CG"
    _, cycles, _, _, width = struct.unpack_from("<QQHH4xI", sizes)
    mark, _, data = links(octets, group[2])
    table = np.frombuffer(data[: cycles * width], "<f8").reshape(cycles, -1)
    at, names = channel_group[1], []
    while at:
        _, channel, about = links(octets, at)
        kind, _, data_type, _, offset, bits = struct.unpack_from("<4BII", about)
        assert (data_type, bits) == (4, 64)
        name = text(octets, channel[2])
        unit = text(octets, channel[6])
        expected = capture.time if name == "time" else capture.signals[name]
        assert kind == (2 if name == "time" else 0)
        assert unit == ("s" if name == "time" else capture.units[name])
        assert np.array_equal(table[:, offset // 8], expected)
        names.append(name)
        at = channel[0]
    assert names == ["time", "speed", "current_q"]


def test_an_mf4_file_is_read_by_asammdf(tmp_path):
    asammdf = pytest.importorskip("asammdf", reason="asammdf is not installed; it is no dependency")
    capture = example()
    mdf.write(tmp_path / "x.mf4", capture.time, capture.signals, capture.units, "about")
    with asammdf.MDF(tmp_path / "x.mf4") as file:
        signal = file.get("current_q")
    assert np.array_equal(signal.samples, capture.signals["current_q"])
    assert np.array_equal(signal.timestamps, capture.time)
    assert signal.unit == "A"


def test_a_level_alone_is_a_trigger(ask, tmp_path):
    """On the first signal, which has to rise through it."""
    result = ask("scope", "speed", "current_d", "--level", 5, "--out", "level.parquet")
    assert result.exit_code == 0, result.stderr
    about = json.loads(pq.read_table(tmp_path / "level.parquet").schema.metadata[b"stillspin"])
    assert [about["trigger"][key] for key in ("signal", "level", "edge")] == ["speed", 5.0, "rising"]


def test_a_capture_that_cannot_be_written_leaves_nothing(drive, tmp_path, monkeypatch):
    capture = drive.capture("speed")

    def full(path, _):
        path.write_bytes(b"half")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setitem(capture_file.WRITERS, ".csv", full)
    (tmp_path / "captures").mkdir()
    with pytest.raises(InputError, match=r"x\.csv: cannot be written \(No space left on device\)"):
        capture_file.write(tmp_path / "captures" / "x.csv", capture)
    assert list((tmp_path / "captures").iterdir()) == []


def test_what_the_drive_did_not_know_is_no_number_in_the_table(drive, capsys):
    capture = drive.capture("speed")
    speed = np.full(capture.time.size, 600.0)
    speed[:24] = np.nan
    tables.capture(
        replace(capture, signals={"speed": speed, "angle": speed * np.nan}, units={"speed": "rpm", "angle": "°"})
    )
    _, first, second = (line.split() for line in capsys.readouterr().out.strip().splitlines())
    assert first[:4] == ["speed", "600", "600", "600"]
    assert first[5:] == ["unknown", "in", "24", "of", str(speed.size), "records"]
    assert second[:4] == ["angle", "–", "–", "–"]


def test_a_place_that_cannot_be_written_is_said_before_the_capture(tmp_path):
    with pytest.raises(InputError, match="no such directory"):
        capture_file.check(tmp_path / "none" / "x.csv")


def test_monitor_prints_numbers_where_nobody_looks(ask):
    result = ask("monitor", "speed", "link_voltage", "--period", 5, "--duration", 0.4)
    head, *lines = result.stdout.splitlines()
    assert re.match(r"# firmware: .*board \w+, .*table [0-9a-f]{8}\)$", head)
    assert lines[0] == "time [s]\tspeed [rpm]\tlink_voltage [V]"
    assert len(lines) > 10
    assert all(line.endswith("\t310") for line in lines[1:])


@pytest.mark.parametrize(
    ("unsent", "said"),
    [
        (3, "3 samples did not arrive: not sent, the drive's port has no room for so many"),
        (1, "3 samples did not arrive: 1 not sent, the drive's port has no room for so many"),
        (1, "; 2 lost on the way, this computer is too busy"),
        (0, "3 samples did not arrive: lost on the way, this computer is too busy"),
    ],
)
def test_samples_that_did_not_arrive_are_explained(drive, fake, unsent, said):
    with drive.stream(["speed"], 0.005) as stream:
        assert stream.next(1.0)
        assert stream.why_lost() == ""
        fake.unsent, fake.missing = unsent, 3
        assert wait_until(lambda: stream.lost == 3, 5.0)
        assert said in stream.why_lost()


def test_monitor_says_why_samples_did_not_arrive(ask, fake):
    fake.missing = 1
    result = ask("monitor", "speed", "--period", 5, "--duration", 0.5)
    assert "1 sample did not arrive: lost on the way" in result.stdout


def test_monitor_draws_lines_in_a_terminal(fake):
    environment = {**os.environ, "TERM": "xterm-256color"}
    line = ["monitor", "link_voltage", "current_d", "--drive", fake.port, "--duration", "1.5"]
    seen = terminal(line, environment, 20)
    assert "ready  speed unknown: the shaft may be turning" in seen
    assert "link_voltage 310 V" in seen
    assert "current_d unknown" in seen
    assert any(0x2800 < ord(character) < 0x2900 for character in seen)
    fake.state = 4
    seen = terminal(line, environment, 20)
    assert "current_d -1.5 A" in seen
    assert any(0x2800 < ord(character) < 0x2900 for character in seen)


def dots(rows):
    return {
        (2 * column + dx, 4 * line + dy)
        for line, row in enumerate(rows)
        for column, (character, _) in enumerate(row)
        for dy, masks in enumerate(braille._DOTS)
        for dx, mask in enumerate(masks)
        if (ord(character) - 0x2800) & mask
    }


def test_a_line_of_dots_goes_through_its_values():
    assert dots(braille.plot([[0.0, 1.0, 2.0, 3.0]], 0, 3, 2, 1)) == {(0, 3), (1, 2), (2, 1), (3, 0)}
    assert dots(braille.plot([[0.0, 3.0]], 0, 3, 2, 1)) == {(2, 3), (3, 2), (3, 1), (3, 0)}
    assert dots(braille.plot([[float("nan")] * 4], 0, 3, 2, 1)) == set()


@given(st.floats(-1e9, 1e9), st.floats(0, 1e9))
def test_a_nice_range_holds_its_values(low, span):
    down, up = braille.nice_range(low, low + span)
    assert down <= low
    assert up >= low + span
    assert up > down


def test_the_console_says_a_line_and_prints_the_answer(ask):
    result = ask("console", "--command", "get speed_ramp")
    assert result.stdout == "heard get speed_ramp\n", result.stderr


def test_the_console_ends_with_1_when_a_line_is_refused_and_sends_the_others(ask):
    result = ask("console", "-c", "get x", "-c", "refuse y", "-c", "stop")
    assert result.exit_code == 1
    assert result.stdout == "heard get x\nheard refuse y\nheard stop\n"
    assert result.stderr == "stillspin: not carried out: refuse y\n"


@pytest.mark.parametrize("typed", ["version\r", " version ", "\tversion"])
def test_a_line_of_another_systems_file_is_answered_at_once(ask, fake, typed):
    begin = time.monotonic()
    result = ask("console", "-c", typed, "-c", "get  x\r")
    assert time.monotonic() - begin < 6.0, "the time that is waited for a prompt"
    assert result.stdout == "heard version\nheard get x\n"
    assert fake.lines == ["version", "get x"]


def test_a_transcript_is_without_echo_prompt_and_escapes():
    transcript = Transcript()
    transcript.expect("get x")
    assert transcript.feed(b"get x\r\nx = 1 rpm\r\n\x1b[2K\r> ") == ["x = 1 rpm"]
    assert transcript.answered
    assert transcript.feed(b"gt\b \bet y\r\nfault: over-") == ["get y"]
    assert transcript.feed(b"current\r\n") == ["fault: over-current"]
    assert transcript.feed(b"> \r\n! fault: asked by nobody\r\n> ") == ["! fault: asked by nobody"]


def test_a_line_that_is_too_long_is_known_by_what_the_console_shows_of_it():
    """It echoes as much as it takes, and a bell for each of the others."""
    line = "get " + 30 * "speed "
    transcript = Transcript()
    transcript.expect(line)
    assert transcript.feed(line[:LINE].encode() + b"\a\a\r\na line has at most 80 characters: nothing done\r\n> ") == [
        "a line has at most 80 characters: nothing done"
    ]
    assert transcript.answered
    header = (Path(__file__).resolve().parents[2] / "firmware/console/editor.h").read_text(encoding="utf-8")
    assert f"#define EDITOR_LINE {LINE}u" in header


def completions(table, text):
    return [c.text for c in ConsoleWords(table, COMMANDS).get_completions(Document(text), None)]


def test_completion_knows_the_drives_own_names(drive):
    assert completions(drive.table, "st") == ["start", "stop", "status"]
    assert completions(drive.table, "get speed_") == ["speed_limit", "speed_ramp"]
    assert completions(drive.table, "set speed_ramp ") == ["3000 rpm/s"]
    assert completions(drive.table, "scope current_d cur") == ["current_d", "current_q"]
    assert completions(drive.table, "set nothing ") == []
