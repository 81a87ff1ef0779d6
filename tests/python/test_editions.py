"""The editions of the firmware on the virtual board: what they do is what lab does, what they have not they refuse."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import cantools
import pandas as pd
import pytest
from by_edition import DESK, on, switch_on
from desk import board
from own_edition import LOADED, ROOT, linked

from stillspin import can

# What the features that drive and minimal leave out would have recorded.
LEFT_OUT = {"load_angle", "magnet_flux"}
# Without a look for a turning shaft and for its wiring a start begins earlier: lab is told to leave both out as well.
AS_IN = {"drive": (), "minimal": ("--set", "flying_start=0", "--set", "wiring_check=0")}
# What the plant says, not the drive. The virtual chip takes an interrupt between two register accesses. The background
# level of minimal has none of the bus's, so a control interrupt begins some ticks of 10 ns earlier or later, and with
# it what it does itself in a start: gates on and off at no current, where the plant's solver ends a step. From there on
# the last bit of what it integrates is another one. The test below shows that it is the bus alone.
PLANT = {"torque", "i_a", "i_b", "i_c", "v_dc", "load_torque", "told_angle", "told_cross", "told_speed"}
LAST_BIT = 1e-6  # some times that of the record's numbers, which have 24 bits
SCENARIOS = ("A10", "A16", "A18b")


def recorded(edition: str, scenario: str, where: Path, *options: str) -> dict[str, pd.DataFrame]:
    """Every run of a scenario, by its file's name."""
    folder = where / edition / "".join(options) / scenario
    if not folder.exists():
        on(edition, "-m", "stillspin", "run", scenario, "--no-plots", "--out", str(folder), *options)
    return {path.name: pd.read_parquet(path) for path in sorted((folder / "runs").glob("*.parquet"))}


@pytest.fixture(scope="module")
def where(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("editions")


def as_lab(run: pd.DataFrame, lab: pd.DataFrame, *, exact: bool) -> None:
    """All that the drive says of itself, and what the plant says, but for its last bit where that is not exact."""
    assert set(lab.columns) - set(run.columns) == LEFT_OUT
    if exact:
        pd.testing.assert_frame_equal(run, lab[run.columns], check_exact=True)
        return
    of_plant = [column for column in run.columns if column in PLANT or column.startswith("true_")]
    of_drive = [column for column in run.columns if column not in of_plant]
    pd.testing.assert_frame_equal(run[of_drive], lab[of_drive], check_exact=True)
    pd.testing.assert_frame_equal(run[of_plant], lab[of_plant], rtol=LAST_BIT, atol=LAST_BIT)


@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize("edition", ["drive", "minimal"])
def test_in_a_run_the_drive_does_bit_for_bit_what_lab_does(edition: str, scenario: str, where: Path) -> None:
    lab, own = recorded("lab", scenario, where, *AS_IN[edition]), recorded(edition, scenario, where)
    assert lab and lab.keys() == own.keys()
    for name, run in own.items():
        as_lab(run, lab[name], exact=edition == "drive")


PLAYED = """
from stillspin import core
from stillspin.cases import profile, scenario_file
from stillspin.runs import execute
import pandas
native = core.load()
schema, known = core.plant_schema(native), core.parameters(native)
settings = execute.Settings(profile.load("bench", schema, known), profile.Changes(), 1, "")
run = execute.play(native, execute.prepare(scenario_file.load("A16"), settings, native)[0], None, None)
pandas.DataFrame(dict(run.signals)).to_parquet(sys.argv[-1])
"""


def played(module: Path | None, run: Path) -> pd.DataFrame:
    """A16 on a module, or on lab's."""
    code = f"{LOADED}{PLAYED}" if module else f"import sys{PLAYED}"
    on("lab", "-c", code, *([str(module)] if module else []), str(run))
    return pd.read_parquet(run)


@pytest.fixture(scope="module")
def by_lab(where: Path) -> pd.DataFrame:
    return played(None, where / "lab.parquet")


def test_with_the_bus_and_the_flying_start_minimal_is_lab_to_the_last_bit_of_the_plant(
    where: Path, by_lab: pd.DataFrame
) -> None:
    both = where / "both.txt"
    minimal = (ROOT / "firmware/editions/minimal.txt").read_text(encoding="utf-8")
    both.write_text(minimal + "can\nstart/flying\n", encoding="utf-8")
    own = played(linked(both), where / "both.parquet")
    assert set(by_lab.columns) - set(own.columns) == LEFT_OUT
    pd.testing.assert_frame_equal(own, by_lab[own.columns], check_exact=True)


def test_without_console_and_link_the_drive_runs_as_ever(where: Path, by_lab: pd.DataFrame) -> None:
    quiet = where / "quiet.txt"
    quiet.write_text("drive\nsources/observer\nstart\nstart/flying\nboard\nstore\nscope\n", encoding="utf-8")
    as_lab(played(linked(quiet), where / "quiet.parquet"), by_lab, exact=False)


@pytest.mark.parametrize("edition", ["lab", "drive", "hil", "minimal"])
def test_the_table_is_that_of_the_edition(edition: str) -> None:
    code = "import json; from stillspin import core; print(json.dumps([r['name'] for r in core.load().parameters()]))"
    names = json.loads(on(edition, "-c", code))
    assert ("flux_low" in names) == (edition == "lab")
    assert ("can_node" in names) == (edition != "minimal")
    assert "stator_resistance" in names


def test_an_unknown_edition_is_refused_in_a_sentence() -> None:
    said = on("nonesuch", "-m", "stillspin", "params", expected=2)
    assert "there is no such edition; known: drive, hil, minimal" in said


REFUSALS = """
print(desk.type("get flux_low", 150), desk.type("set can_node 3", 150), desk.type("get load_angle", 150), sep="")
print(desk.type("set flying_start 0", 150), desk.type("set if_speed 200", 150), desk.type("look", 150), sep="")
print(desk.type("get flux", 300), desk.type("scope arm", 150), desk.type("help scope", 150), desk.type("help", 1500))
print("suggested:", desk.type("scopes", 300))
"""


def test_what_is_left_out_is_refused_by_its_edition() -> None:
    said = on("minimal", "-c", f"{DESK}desk = Desk({{}}){REFUSALS}", str(Path(__file__).parent))
    for name in ("flux_low", "can_node", "load_angle", "flying_start", "if_speed", "look"):
        assert f"'{name}' is not in this edition of the firmware, minimal" in said
    assert "there is no parameter 'flux'" in said, "what no edition has"
    assert "flux_high" not in said, "nor is it suggested"
    assert said.count("'scope' is not in this edition of the firmware, minimal") == 2, "a command and its help"
    assert "captures signals" not in said
    assert "measures machine" not in said
    assert "switches the power stage on" in said, "what is there is explained"
    assert "there is no command 'scopes': see 'help'" in said.split("suggested:")[1]


OFFERED = """
from prompt_toolkit.document import Document
from stillspin.commands.completion import ConsoleWords, commands_of
from stillspin.commands.connection import opened
with opened("virtual:") as drive:
    words = ConsoleWords(drive.table, commands_of(drive))
    for begun in ("", "get flux_", "set can_", "signals load_", "scope speed"):
        print(*(offered.text for offered in words.get_completions(Document(begun), None)), sep=",")
"""


@pytest.mark.parametrize("edition", ["lab", "drive", "hil", "minimal"])
def test_tab_offers_what_the_drives_own_help_lists(edition: str, tmp_path: Path) -> None:
    """Commands, parameters and signals; of a command that is left out no argument either."""
    listed = {line.split()[0] for line in switch_on(edition, tmp_path / "memory", "help") if line[:1].islower()}
    commands, fluxes, can_ids, loads, scoped = (line.split(",") for line in on(edition, "-c", OFFERED).splitlines())
    assert set(commands) == listed
    assert ("flux_low" in fluxes) == (edition == "lab")
    assert ("can_node" in can_ids) == (edition != "minimal")
    assert ("load_angle" in loads) == (edition == "lab") and "load_torque" in loads
    assert ("speed_reference" in scoped) == (edition != "minimal")


ASKED = """
import json
from stillspin import core
core.load()
from stillspin.drive import describe
from stillspin.drive.own import virtual_ask
from stillspin.drive.protocol import Request
from stillspin.drive.state import RawStatus
from stillspin.link.errors import RefusedError

def answer(ask, kind, body):
    try:
        ask(kind, body)
    except RefusedError as error:
        return error.status, str(error)
    return 0, ""

with virtual_ask() as ask:
    who = describe.identity(ask)
    # A body that no request has, so that nothing is carried out; commands have one length.
    long, command = bytes(239), Request.COMMAND
    requests = {kind: answer(ask, kind, long) for kind in range(0x40) if kind not in (Request.HIL_STEP, command)}
    commands = {code: answer(ask, command, bytes([code]) + bytes(4)) for code in range(0x100)}
    faults = [answer(ask, Request.WORDS, bytes([kind, code])) for kind in (1, 8) for code in range(who.faults + 1)]
    status = RawStatus.unpack(ask(Request.STATUS, b""))
print(json.dumps([requests, commands, faults, [status.store, status.save_progress, status.unsaved], who.edition]))
"""
UNKNOWN, RANGE, EDITION = 1, 2, 8
SCOPE, LOOK, HIL = set(range(0x10, 0x15)), {0x17}, {0x20, 0x22}  # HIL_STEP takes any length
RESULT, COMMISSION, STORE, BEGIN_LOOK = {0x16}, {6}, {7, 8, 9}, {10}
LEFT_OUT_REQUESTS = {
    "lab": (set(), set()),
    "drive": (HIL, set()),
    "hil": (RESULT, COMMISSION),
    "minimal": (SCOPE | RESULT | LOOK | HIL, COMMISSION | STORE | BEGIN_LOOK),
}

LEFT_OUT_FAULTS = {"lab": 0, "drive": 1, "hil": 1, "minimal": 5}  # the encoder's; those of the wiring


@cache
def answered(edition: str) -> Any:
    """What an edition says to all of that."""
    return json.loads(on(edition, "-c", ASKED))


@pytest.mark.parametrize("edition", LEFT_OUT_REQUESTS)
def test_a_request_of_what_is_left_out_is_told_from_one_that_no_edition_knows(edition: str) -> None:
    """Every number that there can be: lab has them all, so what it does not know nobody does."""
    lab, own = answered("lab"), answered(edition)
    words = [f"not in this edition of the firmware, {edition}"]
    for asked, in_lab, left_out in zip(own[:2], lab[:2], LEFT_OUT_REQUESTS[edition], strict=True):
        assert {int(kind) for kind, (status, _) in asked.items() if status == EDITION} == left_out
        assert [said for status, said in asked.values() if status == EDITION] == words * len(left_out)
        unknown, in_no = ({kind for kind, (status, _) in of.items() if status == UNKNOWN} for of in (asked, in_lab))
        assert unknown == in_no
        assert len(unknown) > 20
    faults, in_lab = own[2], lab[2]
    assert len(faults) == len(in_lab), "numbers of faults are those of all editions"
    assert [status for status, _ in in_lab].count(RANGE) == 2, "behind the last one"
    gone = [k for k, fault in enumerate(faults) if fault != in_lab[k]]
    assert [faults[k] for k in gone] == [[EDITION, *words]] * 2 * LEFT_OUT_FAULTS[edition], "its words and its remedy"


@pytest.mark.parametrize(
    ("edition", "way"), [("hil", "--port"), ("hil", "--can"), ("lab", "--port"), ("drive", "--port")]
)
def test_a_board_is_compared_with_a_virtual_drive_of_its_own_edition(
    edition: str, way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever edition the environment of the command has."""
    file = tmp_path / "results.json"
    monkeypatch.setenv("STILLSPIN_EDITION", edition)
    with board(tmp_path, "--speed", "0") as port:
        where = port if way == "--port" else str(tmp_path / "can")
        options = ("--run", "creep", "--check", way, where, "--json", str(file))
        said = on("minimal", "-m", "stillspin", "hil", "A10", *options, expected=int(edition == "drive"))
    if edition == "drive":
        assert "not in this edition of the firmware, drive" in said
        return
    (row,) = json.loads(file.read_text())["runs"]
    assert f"edition {edition}," in row["firmware"]
    assert row["board"] == row["native"] and row["steps"] > 2000


@pytest.mark.parametrize("edition", ["lab", "drive"])
def test_the_dbc_that_is_exported_is_that_of_the_edition(
    edition: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "own.dbc"
    monkeypatch.setenv("STILLSPIN_EDITION", edition)
    with board(tmp_path):
        on("lab", "-m", "stillspin", "can", f"can:slcan:{tmp_path / 'can'}", "--export", str(file))
    own, all_editions = cantools.database.load_file(file), can.database(1)
    assert [(m.name, m.frame_id, len(m.signals)) for m in own.messages] == [
        (m.name, m.frame_id, len(m.signals)) for m in all_editions.messages
    ]
    faults, known = (
        dict(bus.get_message_by_name("STATUS").get_signal_by_name("FAULT").choices) for bus in (own, all_editions)
    )
    assert known.pop(28) == "encoder"
    assert faults == {**known, **({28: "encoder"} if edition == "lab" else {})}


def test_an_edition_that_is_not_built_is_answered_with_the_command_that_makes_it() -> None:
    """A board of one's own edition, before the first step."""
    code = """
from stillspin import core
core.follow_edition("limited")
core.load()
from stillspin.drive import describe
from stillspin.hil import built
asked = describe.identity
theirs = describe.Identity(1, 1, 1, 1, "stillspin 0.1.0", "bench", edition="limited")
describe.identity = lambda ask: theirs if ask == "board" else asked(ask)
built.check_board("board")
"""
    said = on("hil", "-c", code, expected=1)
    assert "cmake --preset release -DSTILLSPIN_EDITION=limited && cmake --build --preset release" in said


def test_without_a_store_the_status_says_that_nothing_can_be_saved() -> None:
    absent, progress = 8, 100
    assert answered("minimal")[3] == [absent, progress, 0]
    assert answered("drive")[3][0] != absent


def test_the_client_names_the_edition_that_has_not_what_was_asked_for(tmp_path: Path) -> None:
    """Exit status 1: the drive's answer, not a wrong name."""
    file = tmp_path / "parameters.toml"
    drive = ("--drive", "virtual:")
    file.write_text("[parameters]\nspeed_ramp = 500\nflux_low = 123.0\n", encoding="utf-8")
    said = on("minimal", "-m", "stillspin", "params", "load", str(file), *drive, expected=1)
    assert "parameter 'flux_low' is not in this edition of the firmware, minimal" in said
    for signal in ("load_angle", "current_q"):
        said = on("minimal", "-m", "stillspin", "scope", signal, *drive, expected=1)
        assert "not in this edition of the firmware, minimal" in said
    file.write_text("[parameters]\nflux_lou = 123.0\n", encoding="utf-8")
    said = on("minimal", "-m", "stillspin", "params", "load", str(file), *drive, expected=2)
    assert "no parameter 'flux_lou'" in said, "what no edition has"


def test_a_client_reads_the_table_and_the_edition_of_the_drive() -> None:
    """Records in the place of the console's words: status 8, no row of what is left out."""
    code = """
from stillspin import core
core.load()
from stillspin.drive import describe
from stillspin.drive.own import virtual_ask
from stillspin.drive.protocol import Request, StatusCode
from stillspin.link.errors import RefusedError
with virtual_ask() as ask:
    who = describe.identity(ask)
    table = describe.table(ask, who)
    print(who.text, len(table.signals) == who.signals - 2, table.has_parameter("flux_low"))
    for request, body in (
        (Request.PARAMETER_GET, (303).to_bytes(2, "little")),
        (Request.PARAMETER_SET, (303).to_bytes(2, "little") + bytes(4)),
        (Request.SIGNALS, (23).to_bytes(2, "little")),
        (Request.PARAMETER_GET, (9999).to_bytes(2, "little")),
    ):
        try:
            ask(request, body)
        except RefusedError as error:
            print(error.status == StatusCode.EDITION)
"""
    said = on("drive", "-c", code).split()
    assert {"(edition", "drive,"} <= set(said)
    assert said[-6:] == ["True", "False", "True", "True", "True", "False"]
