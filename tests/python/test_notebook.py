"""The notebook of the book: it is the page, and its cells run from the first to the last in a Python of their own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import jupytext
from desk import needs_board

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import notebook  # noqa: E402

PAGE, NOTEBOOK = ROOT / "docs" / "notebook.md", ROOT / "docs" / "notebook.ipynb"


def test_the_notebook_is_the_page():
    assert NOTEBOOK.read_text(encoding="utf-8") == notebook.made(PAGE.read_text(encoding="utf-8")) + "\n"


@needs_board
def test_the_cells_run_in_their_order(tmp_path):
    program = tmp_path / "cells.py"
    program.write_text(jupytext.writes(jupytext.read(NOTEBOOK), fmt="py:percent"), encoding="utf-8")
    variables = {**os.environ, "MPLBACKEND": "Agg", "XDG_CACHE_HOME": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, program], cwd=tmp_path, env=variables, capture_output=True, text=True, timeout=300, check=False
    )
    assert ran.returncode == 0, ran.stderr
    said = ran.stdout.splitlines()
    assert said[0].endswith(" ready")
    assert said[2] == "{'time': 's', 'speed': 'rpm', 'speed_reference': 'rpm', 'current_q': 'A'}"
    assert "samples, 0 lost" in said[3]
    assert "is closed" in said[-1]
    picture = tmp_path / "notebook.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    directory = os.environ.get("STILLSPIN_PICTURES")
    if directory:
        shutil.copy(picture, ROOT / directory)
