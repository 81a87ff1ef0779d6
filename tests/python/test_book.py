"""What the book owes its readers, beyond links that lead somewhere."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from book import parameters  # noqa: E402
from checks import pieces  # noqa: E402

STATE = "**no**, neither the flash nor the time"
"""How docs/image.md answers whether the drive fits its chip."""


@pytest.mark.parametrize("page", ["flash.md", "bring-up.md", "isr-cost.md"])
def test_who_is_about_to_use_a_chip_reads_first_that_the_image_does_not_fit(page: str) -> None:
    """Before the first heading, for as long as that is so."""
    known = (ROOT / "docs/image.md").read_text(encoding="utf-8")
    assert STATE in known, "the image fits: take the warnings away, and this test"
    top = (ROOT / "docs" / page).read_text(encoding="utf-8").split("\n## ")[0]
    warnings = [line for line in top.split("\n") if line.startswith("> **")]
    assert any("fit" in line for line in warnings), top
    assert "147 %" in top
    assert "image.md#does-it-fit" in top


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of what the pieces of the book are made of."""
    for folder in ("docs", "toolchain/book", "hal/boards"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("*.png", "__pycache__"))
    (tmp_path / "firmware").mkdir()
    for name in ("README.md", parameters.LIST):
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def test_every_parameter_has_its_place_on_the_page() -> None:
    """Under a heading that is its name alone, by which other pages, the console and the browser's page link to it."""
    lines = (ROOT / "docs/parameters.md").read_text(encoding="utf-8").split("\n")
    headings = [line.removeprefix("### ") for line in lines if line.startswith("### ")]
    assert headings == [parameter.name for parameter in parameters.parameters(ROOT)]
    assert len(headings) > 130


def test_a_parameter_that_is_on_no_page_fails_the_check(tree: Path) -> None:
    """A new one, one that changed, and one that nobody says anything of."""
    assert pieces.check(tree) == []
    listed = tree / parameters.LIST
    text = listed.read_text(encoding="utf-8")
    listed.write_text(text.replace("1, 20, 4, STOPPED", "1, 21, 4, STOPPED"), encoding="utf-8")
    assert [str(finding) for finding in pieces.check(tree)] == [
        f"docs/parameters.md:{_line(tree)}: parameters is stale: run toolchain/render.py"
    ]
    listed.write_text(text.replace("friction,", "drag,"), encoding="utf-8")
    assert "friction" in pieces.check(tree)[0].message
    listed.write_text(
        text.replace("(7, friction", "(999, drag", 1) + text[text.index("// Machine") :], encoding="utf-8"
    )
    assert pieces.check(tree)


def _line(tree: Path) -> int:
    lines = (tree / "docs/parameters.md").read_text(encoding="utf-8").split("\n")
    return 1 + next(k for k, line in enumerate(lines) if line.startswith("<!-- parameters:"))
