"""What the book owes its readers, beyond links that lead somewhere."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

from book import hooks, parameters  # noqa: E402
from checks import glossary, pieces  # noqa: E402

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


def _line(tree: Path) -> int:
    lines = (tree / "docs/parameters.md").read_text(encoding="utf-8").split("\n")
    return 1 + next(k for k, line in enumerate(lines) if line.startswith("<!-- parameters:"))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The book as `make docs` builds it."""
    where = tmp_path_factory.mktemp("site")
    command = ["-m", "mkdocs", "build", "--quiet", "--strict", "--config-file", "toolchain/mkdocs.yml", "--site-dir"]
    subprocess.run([sys.executable, *command, str(where)], cwd=ROOT, check=True)
    return where


@pytest.mark.parametrize(
    ("words", "place"),
    [
        ("speed_ramp", "parameters.html#speed_ramp"),
        ("ramp speed", "parameters.html#speed_ramp"),
        ("polarity ambiguous", "start.html"),
        ("host in the loop", "hil.html"),
    ],
)
def test_the_search_finds_it_in_a_book_that_was_opened_as_a_file(chromium, site, words, place) -> None:
    """Without a server, which is how `make docs` opens it; what is found is a link that leads there."""
    page = chromium.new_page()
    page.goto(f"{(site / 'index.html').as_uri()}")
    page.fill("input[name=q]", words)
    page.press("input[name=q]", "Enter")
    link = page.locator(f'#mkdocs-search-results a[href^="./{place}"]').first
    link.click()
    assert place in page.url
    page.close()


def test_the_search_says_when_there_is_nothing(chromium, site) -> None:
    page = chromium.new_page()
    page.goto(f"{(site / 'search.html').as_uri()}?q=quetzalcoatl")
    assert page.locator("#mkdocs-search-results").inner_text() == "No results found"
    page.close()


def test_an_abbreviation_is_explained_where_it_stands(site: Path) -> None:
    page = (site / "hil.html").read_text(encoding="utf-8")
    known = hooks.abbreviations()
    assert f'<abbr title="{known["CAN"]}">CAN</abbr>' in page
    assert len(known) > 60


@pytest.mark.parametrize(("line", "words"), [("a CAN bus, an XQZ and `ABC`", ["XQZ"]), ("an RS-232 port, a B-SPM", [])])
def test_an_abbreviation_that_nobody_explains_fails_the_check(line: str, words: list[str]) -> None:
    assert glossary.unexplained(line) == words
