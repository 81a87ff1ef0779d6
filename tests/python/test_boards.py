"""One description of a board: what the firmware is compiled with, what the virtual board is, what the docs say."""

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType

import pytest
from by_edition import with_build

ROOT = Path(__file__).resolve().parents[2]
OTHER = "ipm"
PPM = 1.0
NTC_KELVIN = 2.0


def load_tables() -> ModuleType:
    spec = importlib.util.spec_from_file_location("board_table", ROOT / "toolchain" / "board_table.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["board_table"] = module
    spec.loader.exec_module(module)
    return module


tables = load_tables()


def on(board: str, *command: str, expected: int = 0) -> str:
    return with_build("STILLSPIN_BOARD", board, *command, expected=expected)


def test_the_book_has_the_tables_of_the_files() -> None:
    page = tables.PAGE.read_text(encoding="utf-8")
    assert tables.BEGIN + tables.tables() + tables.END in page


def test_every_board_says_everything() -> None:
    first, *others = tables.boards()
    assert others
    for board in others:
        assert list(board.values) == list(first.values)
        assert board.groups.keys() == first.groups.keys()


def test_the_other_board_has_little_in_common() -> None:
    usual, other = (board for board in tables.boards() if board.name in ("bench", OTHER))
    for macro in (
        "FIRST_LEG_MODULE",
        "GATE_ON_LEVEL",
        "TRIP_INPUT",
        "PIN_GATE_ENABLE",
        "LAMP_ON_LEVEL",
        "ADC_CURRENTS",
    ):
        assert usual.number(macro) != other.number(macro)
    for macro in ("ADC_SLOW", "CURRENT_RANGE", "LINK_RANGE", "PIN_FAULT_LAMP", "ENABLE_TIME_US"):
        assert usual.number(macro) != other.number(macro)


@pytest.mark.parametrize("board", tables.boards(), ids=lambda board: board.name)
def test_scalings_are_exact_enough(board: object) -> None:
    assert all(abs(scaling.error_ppm) < PPM for scaling in tables.scalings(board))
    codes = [round(tables.ntc_code(board, celsius)) for celsius in range(-40, 141, 20)]
    assert board.numbers("NTC_CODES") == codes  # type: ignore[attr-defined]
    assert tables.ntc_error(board) < NTC_KELVIN


def test_an_unknown_board_is_refused_in_a_sentence() -> None:
    said = on("nonesuch", "-m", "stillspin", "params", expected=2)
    assert "there is no such board; known: ipm" in said


DEFAULTS = """
import json
from stillspin import core
native = core.load()
named = {row["name"]: row["default"] for row in native.parameters()}
adc = native.plant_schema()["adc"]
print(json.dumps([named["current_full_scale"], named["link_full_scale"], named["dead_time"],
                  adc["current_range"]["default"], adc["voltage_range"]["default"]]))
"""


@pytest.mark.parametrize("board", tables.boards(), ids=lambda board: board.name)
def test_drive_and_virtual_board_have_it_from_the_file(board: object) -> None:
    amps, volts = board.number("CURRENT_RANGE") / 100, board.number("LINK_RANGE") / 10  # type: ignore[attr-defined]
    dead = board.number("DEAD_TIME") / 100  # type: ignore[attr-defined]
    name = board.name.replace("bench", "")  # type: ignore[attr-defined]
    assert json.loads(on(name, "-c", DEFAULTS)) == pytest.approx([amps, volts, dead, amps, volts])


@pytest.mark.parametrize("scenario", ["A10", "A12"])
def test_scenarios_reach_their_bounds_on_the_other_board(scenario: str, tmp_path: Path) -> None:
    """A12 switches the legs directly, slice by slice, where another module counts them."""
    command = ("run", scenario, "--no-plots", "--out", str(tmp_path))
    said = on(OTHER, "-m", "stillspin", *command)
    figures = json.loads((tmp_path / "metrics.json").read_text(encoding="utf-8"))["scenarios"][scenario]
    goals = [figure["met"] for figure in figures.values() if figure["goal"] is not None]
    assert len(goals) >= 2
    assert all(goals), said


FUNCTIONS = """
import sys
sys.path.insert(0, sys.argv[1])
from stillspin import core
core.load()
from test_board_functions import Desk
desk = Desk({"gate_feedback": 1.0, "emergency_stop": 1.0, "reference_input": 1.0})
desk.run(300)
desk.wait(100)
print(desk.status("self-test"), desk.output("gates_pass"), desk.output("lockouts"))
desk.board.set_input("emergency", 1.0)
desk.wait(1)
print(desk.state, desk.fault)
"""


def test_functions_and_self_test_find_their_pins_on_the_other_board() -> None:
    """Bootstrap supplies that are charged, other trip inputs, feedback and references."""
    said = on(OTHER, "-c", FUNCTIONS, str(ROOT / "tests" / "python")).splitlines()
    assert said == ["passed; flash not tested, the image has no check sum 1.0 0.0", "6 14"]
