"""What a file may say for 0 and 1: one rule for the files of the virtual drive and for those of a drive."""

import pytest
from desk import needs_board

from stillspin import core
from stillspin.cases import profile
from stillspin.drive import Drive, parameter_file
from stillspin.errors import InputError
from stillspin.runs import commission


def taken(way, name):
    """What a way to read a parameter comes to; None where it refuses the value."""
    try:
        return way(name)
    except InputError:
        return None


@needs_board
@pytest.mark.parametrize(("word", "value"), [("true", 1.0), ("false", 0.0)])
def test_true_and_false_are_taken_by_switches_alone_wherever_a_parameter_is_read(tmp_path, word, value):
    native = core.load()
    known, schema = core.parameters(native), core.plant_schema(native)
    with Drive.virtual("ideal") as drive:
        table = drive.table
        now = drive.parameters()
        assert drive.set("mtpa", value == 1.0) == value
    file = tmp_path / "one.toml"
    ways = (
        lambda _: commission.load(file, known),  # run --params
        lambda _: parameter_file.read(file, table, now),  # params load and diff, the page
        lambda name: {name: profile.load(str(file), schema, known).parameters[name]},  # a profile, a motor
        lambda name: profile.changes([f"{name}={word}"], schema, known).parameters,  # --set
    )
    switches = set()
    for name in known:
        file.write_text(f"[parameters]\n{name} = {word}\n")
        found = [taken(way, name) for way in ways]
        assert found in ([None] * 4, [{name: value}] * 4), name
        switches |= {name} if found[0] else set()
    assert switches == {name for name, entry in known.items() if entry.whole and entry.range_text == "0 … 1"}
    assert switches > {"mtpa", "wiring_check"}
