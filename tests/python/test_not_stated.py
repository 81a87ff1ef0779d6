"""Whatever runs a motor of a file says on the terminal what the file leaves out, and what holds instead."""

import pytest
import typer
from c28x_chip import linked_file
from in_process import stillspin
from test_motors import PUMP, pump

from stillspin import cli
from stillspin.campaign import units
from stillspin.errors import InputError

ALONE = ("--jobs", "1", "--out", "r")
CALLS = [
    ("run", "A18a", "--no-plots", "--motor"),
    ("reproduce", "A18a", *ALONE, "--no-commission", "--no-nameplate", "--no-paper-scheme", "--motor"),
    ("explain", "A18a", *ALONE, "--no-alone", "--only", "cogging", "--motor"),
    ("commission", "--out", "p.toml", "--motor"),
    ("board", "--speed", "0", "--for", "0.01", "--motor"),
    ("campaign", "-n", "1", *ALONE, "--motors"),
    ("type-test", *ALONE),
    ("image inject", "control.out", "--interrupt", "INT1.7", "--from", "step", "--motor"),
    ("image record", "recording.json", "--for", "0.001", "--motor"),
    ("image record", "recording.json", "--for", "0.001", "--image", "control.out", "--motor"),
    ("image record", "recording.json", "--for", "0.001", "--scenario", "A18a", "--motor"),
    ("image replay", "control.out", "recording.json", "--motor"),
    ("image time", "control.out", "--for", "0.001", "--motor"),
    ("image time", "control.out", "A18a", "A10", "--motor"),
    ("image trace", "control.out", "--motor"),
]
"""Each command in each way in which it runs a motor; the motor's file is the last word."""
SAID = "stillspin: motor pump: mechanics.inertia is not stated; the drive keeps inertia = "


def takers(group, before=()):
    """Names of the commands that take a motor."""
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from takers(command, (*before, name))
        elif any(parameter.name in {"motor", "motors"} for parameter in command.params):
            yield " ".join((*before, name))


def test_every_command_that_takes_a_motor_is_called_below():
    every = list(takers(typer.main.get_command(cli.app)))
    assert len(every) >= 11
    assert set(every) == {name for name, *_ in CALLS}


def enough(*_):
    """Nobody waits for the minutes that come."""
    raise InputError("that is enough")


@pytest.mark.parametrize("words", CALLS, ids=lambda words: " ".join(words[:3]))
def test_every_command_that_runs_a_motor_says_once_what_its_file_leaves_out(request, tmp_path, monkeypatch, words):
    """Campaigns and the chip want the native module itself; for the others there is one that needs no time."""
    name, *others = words
    monkeypatch.chdir(tmp_path)
    if name in {"campaign", "type-test"}:
        monkeypatch.setattr(units, "workers", enough)
        ask = stillspin
    elif name.startswith("image"):
        linked_file(tmp_path, "control")
        stillspin("image", "record", "recording.json", "--image", "control.out", "--for", "0.001")
        ask = stillspin
    else:
        ask = request.getfixturevalue("call")
    done = ask(*name.split(), *others, pump(tmp_path, f"{PUMP}speed_limit = 1300\n"))
    assert done.stderr.count(SAID) == 1, done.output
