"""A feature outside of the tree (tests/feature, explained in docs/feature.md): composed, compiled, linked, at work."""

import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from desk import needs_board

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/release"
EXAMPLE = ROOT / "tests/feature"
PAGE = ROOT / "docs/feature.md"
FENCED = re.compile(r"^```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)

# In a process of its own: the firmware has static state, and this one knows another module. 9 N m at 600 rpm take
# 9.4 A, and current_limit is 14 A.
DRIVEN = """
import importlib.util, json, sys
spec = importlib.util.spec_from_file_location("stillspin._core", sys.argv[1])
sys.modules["stillspin._core"] = native = importlib.util.module_from_spec(spec)
spec.loader.exec_module(native)
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
    seen.append((board.truth()["i_q"], board.truth()["speed"], typed("status")))
board.close()
print(json.dumps(seen))
"""


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The native module of an edition with the example, in a user's folder.

    Linked as the usual one, with the edition's own tables before the libraries, which then give theirs to nobody.
    """
    folder = tmp_path_factory.mktemp("own")
    shutil.copytree(EXAMPLE, folder, dirs_exist_ok=True)
    made, module = folder / "made", folder / "_core.so"
    compose = [sys.executable, ROOT / "toolchain/compose.py", folder / "limited.txt", made]
    subprocess.run(compose, check=True)
    sources = [*made.glob("*.c"), *folder.glob("torque_limit/*.c")]
    flags = ["-std=c99", "-O2", "-fPIC", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
    subprocess.run(["cc", *flags, f"-I{made}", f"-I{ROOT}", "-c", *sources], cwd=folder, check=True)
    usual = next((ROOT / "sim_host/stillspin").glob("_core*.so")).as_posix()
    commands = subprocess.run(
        ["ninja", "-C", BUILD, "-t", "commands", usual], capture_output=True, text=True, check=True
    ).stdout
    # The linker, its flags, -o MODULE, objects, libraries; CMake has something before it and something behind it.
    words = shlex.split(next(part for part in commands.splitlines()[-1].split(" && ") if " -o " in part))
    words[words.index("-o") + 1] = str(module)
    at = next(k for k, word in enumerate(words) if word.endswith(".o"))
    words[at:at] = sorted(map(str, folder.glob("*.o")))
    subprocess.run(words, cwd=BUILD, check=True)
    return module


@needs_board
def test_the_voltage_limits_the_torque(own: Path) -> None:
    run = subprocess.run([sys.executable, "-c", DRIVEN, own], capture_output=True, text=True, check=True)
    (whole, at_speed, all_of_it), (half, slower, half_of_it) = json.loads(run.stdout)
    assert 8.5 < whole < 10.5  # what the load takes
    assert at_speed == pytest.approx(600, abs=30)
    assert 6.0 < half < 7.5  # half of current_limit
    assert slower < 560
    assert "100 % of current_limit" in all_of_it
    assert "50 % of current_limit" in half_of_it


def test_what_the_page_shows_is_what_is_built() -> None:
    files = {path: path.read_text(encoding="utf-8") for path in EXAMPLE.rglob("*") if path.is_file()}
    shown = [
        block for block in FENCED.findall(PAGE.read_text(encoding="utf-8")) if not block.startswith(("make", "cmake"))
    ]
    assert shown
    assert all(any(block in text for text in files.values()) for block in shown)
    assert {path for path, text in files.items() if any(block in text for block in shown)} == set(files)
