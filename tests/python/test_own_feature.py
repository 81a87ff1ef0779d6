"""A feature outside of the tree (tests/feature, explained in docs/feature.md): composed, compiled, linked, at work."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from desk import needs_board
from own_edition import LOADED, linked

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from row_lists import Lists  # noqa: E402

EXAMPLE = ROOT / "tests/feature"
PAGE = ROOT / "docs/feature.md"
FENCED = re.compile(r"^```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)

# 9 N m at 600 rpm take
# 9.4 A, and current_limit is 14 A.
DRIVEN = """
import json
from stillspin import core
from stillspin.board.power import power
from stillspin.cases import profile

SECOND = 100_000_000
schema, known = core.plant_schema(native), core.parameters(native)
chosen = profile.load("ideal", schema, known, "A")
board = power(native, chosen, profile.changes([], schema, known), 1)

def typed(line):
    board.serial_write(line.encode() + b"\\r")
    board.advance(SECOND // 2)
    return board.serial_read().decode()

board.set_input("speed", 3.0)
board.advance(SECOND // 2)
typed("ref 600")
typed("start free")
board.advance(3 * SECOND)
board.set_load(9.0)
seen = []
for volts in (3.0, 1.5):
    board.set_input("speed", volts)
    board.advance(SECOND // 5)
    ripple = []
    for _ in range(20):  # over a period: the pulses of the excitation are in it
        board.advance(SECOND // 200_000)
        ripple.append(board.truth()["i_q"])
    seen.append((sum(ripple) / len(ripple), board.truth()["speed"], typed("status")))
board.set_input("speed", 0.0)
board.advance(SECOND // 5)
said = [typed(line) for line in ("get torque_share", "set torque_limit_least 60", "get torque_share", "list torque")]
board.close()
print(json.dumps([seen, said, native.names()]))
"""


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The native module of an edition with the example, in a user's folder."""
    folder = tmp_path_factory.mktemp("own")
    shutil.copytree(EXAMPLE, folder, dirs_exist_ok=True)
    return linked(folder / "limited.txt", *folder.glob("torque_limit/*.c"))


@pytest.fixture(scope="module")
def driven(own: Path) -> list[Any]:
    """What it does on a board, what it says, and the names in its tables."""
    run = subprocess.run([sys.executable, "-c", LOADED + DRIVEN, own], capture_output=True, text=True, check=True)
    return json.loads(run.stdout)


@needs_board
def test_the_voltage_limits_the_torque(driven: list[Any]) -> None:
    (whole, at_speed, all_of_it), (half, slower, half_of_it) = driven[0]
    assert 8.5 < whole < 10.5  # what the load takes
    assert at_speed == pytest.approx(600, abs=30)
    assert 6.0 < half < 7.5  # half of current_limit
    assert slower < 560
    assert "100 % of current_limit" in all_of_it
    assert "50 % of current_limit" in half_of_it


@needs_board
def test_its_parameter_and_its_signal_are_in_the_tables(driven: list[Any]) -> None:
    """Behind all others, whose places stay; the parameter acts."""
    least, _, more, listed = driven[1]
    assert re.search(r"torque_share +5.00 % ", least)
    assert re.search(r"torque_share +60.00 % ", more)
    assert re.search(r"torque_limit_least +\*60 % ", listed)
    parameters, signals = (
        [row[at] for row in Lists().rows(name, macro)]
        for name, macro, at in (("parameter_list.h", "PARAMETER", 1), ("signal_list.h", "SIGNAL", 0))
    )
    assert driven[2] == [*parameters, "torque_limit_least", *signals, "torque_share"]


def test_what_the_page_shows_is_what_is_built() -> None:
    files = {path: path.read_text(encoding="utf-8") for path in EXAMPLE.rglob("*") if path.is_file()}
    shown = [
        block for block in FENCED.findall(PAGE.read_text(encoding="utf-8")) if not block.startswith(("make", "cmake"))
    ]
    assert shown
    assert all(any(block in text for text in files.values()) for block in shown)
    assert {path for path, text in files.items() if any(block in text for block in shown)} == set(files)
