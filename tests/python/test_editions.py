"""The editions of the firmware on the virtual board: what they do is what lab does, what they have not they refuse."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

# What a feature that drive and minimal leave out would have recorded.
LEFT_OUT = {"load_angle", "magnet_flux"}
# What the plant says, not the drive. Its solver ends a step wherever the background level reaches for the hardware;
# with fewer features that is elsewhere, and the last bit of what it integrates is another one.
PLANT = {"torque", "i_a", "i_b", "i_c", "v_dc", "load_torque", "told_angle", "told_cross", "told_speed"}
LAST_BIT = 1e-6  # some times that of the record's numbers, which have 24 bits
SCENARIOS = ("A10", "A16", "A18b")


def on(edition: str, *command: str, expected: int = 0) -> str:
    done = subprocess.run(
        [sys.executable, *command],
        env={**os.environ, "STILLSPIN_EDITION": edition},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == expected, done.stdout + done.stderr
    return done.stdout + done.stderr


def recorded(edition: str, scenario: str, where: Path) -> dict[str, pd.DataFrame]:
    """Every run of a scenario, by its file's name."""
    folder = where / edition / scenario
    if not folder.exists():
        on(edition, "-m", "stillspin", "run", scenario, "--no-plots", "--out", str(folder))
    return {path.name: pd.read_parquet(path) for path in sorted((folder / "runs").glob("*.parquet"))}


@pytest.fixture(scope="module")
def where(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("editions")


@pytest.mark.parametrize("scenario", SCENARIOS)
@pytest.mark.parametrize("edition", ["drive", "minimal"])
def test_in_a_run_the_drive_does_bit_for_bit_what_lab_does(edition: str, scenario: str, where: Path) -> None:
    lab, own = recorded("lab", scenario, where), recorded(edition, scenario, where)
    assert lab and lab.keys() == own.keys()
    for name, run in own.items():
        assert set(lab[name].columns) - set(run.columns) == LEFT_OUT
        of_plant = [column for column in run.columns if column in PLANT or column.startswith("true_")]
        of_drive = [column for column in run.columns if column not in of_plant]
        pd.testing.assert_frame_equal(run[of_drive], lab[name][of_drive], check_exact=True)
        pd.testing.assert_frame_equal(run[of_plant], lab[name][of_plant], rtol=LAST_BIT, atol=LAST_BIT)


DESK = """
import sys
sys.path.insert(0, sys.argv[1])
from stillspin import core
core.load()
from function_desk import Desk
"""


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
print(desk.type("get flux", 300))
"""


def test_what_is_left_out_is_refused_by_its_edition() -> None:
    said = on("minimal", "-c", f"{DESK}desk = Desk({{}}){REFUSALS}", str(Path(__file__).parent))
    for name in ("flux_low", "can_node", "load_angle"):
        assert f"'{name}' is not in this edition of the firmware, minimal" in said
    assert "there is no parameter 'flux'" in said, "what no edition has"
    assert "flux_high" not in said, "nor is it suggested"


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
