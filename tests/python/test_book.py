"""What the book owes its readers, beyond links that lead somewhere."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import typer

from stillspin import cli

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import costs  # noqa: E402
from book import chip, figures, hooks, parameters, records  # noqa: E402
from checks import glossary, pieces, tables  # noqa: E402


@pytest.mark.parametrize(
    "page", ["README.md", *(f"docs/{name}.md" for name in ("way-board", "flash", "bring-up", "isr-cost"))]
)
def test_who_is_about_to_use_a_chip_reads_first_how_the_image_fits(page: str) -> None:
    """By the last counts of image and interrupt, and before the first heading of the pages about the chip."""
    known = records.load(ROOT)
    fit = chip.fit(ROOT, known["image"]["figures"], known["isr-cost"]["figures"])
    text = (ROOT / page).read_text(encoding="utf-8")
    top = text if page == "README.md" else text.split("\n## ")[0]
    assert ("does not fit its chip" in top) is not fit.fits
    assert ("whether it fits its chip is open" in top.lower()) is fit.is_open
    assert f"{fit.of_flash(fit.words):.0f} % of the flash" in top
    assert f"{fit.of_period(fit.worst):.0f} % of its period" in top
    assert "image.md#does-it-fit" in top


def test_the_clients_page_has_every_extra() -> None:
    """Less what they need who change the sources."""
    project = tomllib.loads((ROOT / "sim_host" / "pyproject.toml").read_text(encoding="utf-8"))
    page = (ROOT / "docs" / "client.md").read_text(encoding="utf-8")
    named = re.findall(r"^\| `stillspin\[(\w+)\]` \|", page, re.MULTILINE)
    assert sorted([*named, "dev"]) == sorted(project["project"]["optional-dependencies"])


def test_a_smaller_and_faster_image_fits() -> None:
    known = records.load(ROOT)
    image, cost = known["image"]["figures"], known["isr-cost"]["figures"]
    edition = chip.fit(ROOT, image, cost).edition
    image["editions"][edition]["flash_words_expected"] = 50000
    cost["editions"][edition]["by_source"]["observer"]["worst_cycles_expected"] = 10001
    assert not chip.fit(ROOT, image, cost).fits
    cost["editions"][edition]["by_source"]["observer"]["worst_cycles_expected"] = 5600
    found = chip.fit(ROOT, image, cost)
    assert found.fits
    assert min(found.flash_chance, found.time_chance) > 99


def test_figures_of_older_sources_are_said_to_be_that() -> None:
    end = "| 1 |\n<!-- end of drift -->\n\nMore.\n"
    assert hooks.aged(end, {}) == end
    aged = hooks.aged(end, {"drift": "toolchain/figures.py drift"})
    assert "Of an older state of the sources; `toolchain/figures.py drift` renews it." in aged
    assert hooks.aged(end, {"speed": "make bench"}) == end
    state = hooks.aged("<!-- end of state -->", {"image": "make image-check", "isr-cost": "make isr-cost"})
    assert "`make image-check` and `make isr-cost`" in state


@pytest.mark.parametrize(
    ("path", "name", "command"),
    [
        ("control/a.c", "isr-cost", "make isr-cost"),
        ("control/a.c", "type-test", "toolchain/figures.py type-test"),
        ("sim_host/stillspin/type_test/duties.py", "type-test", "toolchain/figures.py type-test"),
        ("sim_host/stillspin/hil/loop.py", "hil-can", "toolchain/figures.py hil-can"),
    ],
)
def test_a_record_is_of_older_sources_as_soon_as_one_of_them_changes(
    tmp_path: Path, path: str, name: str, command: str
) -> None:
    source = tmp_path / path
    source.parent.mkdir(parents=True)
    source.write_text("a = 1\n", encoding="utf-8")
    records.keep(tmp_path, name, command, {"observer": 1})
    assert records.outdated(tmp_path) == {}
    source.write_text("a = 2\n", encoding="utf-8")
    assert records.outdated(tmp_path) == {name: command}


def test_runs_stand_by_their_speed_and_a_source_that_has_none_leaves_a_gap() -> None:
    runs = {name: {"mean": 10.4, "worst": 20} for name in ("600", "0, held", "0", "60")}
    cost = {"observer": {"runs": runs}, "paper": {"runs": {"60": {"mean": 1.0, "worst": 2}}}}
    rows = figures.run_by_run(cost, ["observer", "paper"]).split("\n")[2:]
    assert rows == [
        "| 0 | 10 | 20 |  |  |",
        "| 0, held | 10 | 20 |  |  |",
        "| 60 | 10 | 20 | 1 | 2 |",
        "| 600 | 10 | 20 |  |  |",
    ]


ROWS = "| | A | B |\n| --- | --- | --- |\n| x | {} | why |\n| y | **9.1 %** | not |\n"


@pytest.mark.parametrize(
    ("page", "lines"),
    [
        (ROWS.format("0.3 %"), [1]),
        ("\n\n" + ROWS.format("–"), [3]),
        (ROWS.format("`limit`"), []),
        ("<!-- not measured: by design -->\n\n" + ROWS.format("3"), []),
        ("<!-- x: made by toolchain/render.py -->\n" + ROWS.format("3") + "<!-- end of x -->\n", []),
    ],
)
def test_a_table_of_figures_that_is_kept_by_hand_fails_the_check(page: str, lines: list[int]) -> None:
    assert list(tables.by_hand(page)) == lines


def test_a_table_that_differs_from_its_record_fails_the_check_and_a_record_of_older_sources_alone_does_not(
    tree: Path,
) -> None:
    known = records.load(tree)["speed"]
    records.keep(tree, "speed", known["command"], known["figures"], made_of="0" * 16)
    assert "speed" in records.outdated(tree)
    assert pieces.check(tree) == []
    known["figures"]["5"]["plant"] *= 2
    records.keep(tree, "speed", known["command"], known["figures"])
    assert "speed" not in records.outdated(tree)
    assert any("speed is stale: run toolchain/render.py" in finding.message for finding in pieces.check(tree))


def test_a_picture_that_no_command_made_fails_the_check(tree: Path) -> None:
    images = tree / records.PICTURES
    images.mkdir(exist_ok=True)
    (images / "bench.png").write_bytes(b"as made")
    records.keep(tree, "pictures", "make pictures", records.sums(images))
    assert pieces.check(tree) == []
    (images / "bench.png").write_bytes(b"another")
    assert [str(finding) for finding in pieces.check(tree)] == [
        "docs/images/bench.png:1: is not as make pictures left it"
    ]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of what the pieces of the book are made of."""
    for folder in (
        "docs",
        "toolchain/book",
        "hal/boards",
        "sim_host/motors",
        "sim_host/profiles",
        "firmware",
    ):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "README.md", tmp_path / "README.md")
    (tmp_path / costs.FILE).parent.mkdir()
    shutil.copy(ROOT / costs.FILE, tmp_path / costs.FILE)
    return tmp_path


def test_every_promise_to_users_is_held_by_tests_that_there_are() -> None:
    """Each row but that of the language, which no program reads."""
    text = (ROOT / "docs/promises.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| (.+) \| (.+) \|$", text, re.MULTILINE)
    assert [int(number) for number, _, _ in rows] == list(range(1, 26))
    assert [promise for _, promise, held in rows if "](" not in held] == ["Plain English"]
    assert all_tests_are_there(text)


def all_tests_are_there(text: str) -> bool:
    """Those that a page links by name; of one that is not, says which."""
    for name, file in re.findall(r"\[`(\w+)`\]\(\.\./(\S+)\)", text):
        there = (ROOT / file).read_text(encoding="utf-8")
        assert re.search(rf"^(def {name}\(|TEST(_F|_P)?\(\w+,\s+{name}\))", there, re.MULTILINE), (name, file)
    return "`](../" in text


def test_every_command_that_takes_an_image_has_its_test_on_the_control_program() -> None:
    page = (ROOT / "docs/c28x.md").read_text(encoding="utf-8")
    table = page.partition("### One control program")[2].partition("\n### ")[0]
    named = {row for cell in re.findall(r"^\| (`.+?) \|", table, re.MULTILINE) for row in re.findall("`(.+?)`", cell)}
    commands = typer.main.get_command(cli.app).commands  # type: ignore[attr-defined]
    taking = {name for name, command in commands.items() if any("--image" in one.opts for one in command.params)}
    there = {f"{name} --image" for name in taking} | {f"image {name}" for name in commands["image"].commands}
    assert named - {"board --image --gdb"} == there
    assert all_tests_are_there(table)


def test_every_parameter_has_its_place_on_the_page() -> None:
    """Under a heading that is its name alone, by which other pages, the console and the browser's page link to it."""
    lines = (ROOT / "docs/parameters.md").read_text(encoding="utf-8").split("\n")
    headings = [line.removeprefix("### ") for line in lines if line.startswith("### ")]
    assert headings == [parameter.name for parameter in parameters.parameters(ROOT)]
    assert len(headings) > 130


def test_a_parameter_that_not_every_edition_has_says_which_have() -> None:
    """Of a feature that `lab` alone has, of one that `minimal` leaves out, and of none."""
    within = parameters.editions(ROOT)
    assert within["170"] == ["lab"]
    assert within["150"] == ["lab", "drive", "hil"]
    assert "1" not in within
    page = (ROOT / "docs/parameters.md").read_text(encoding="utf-8")
    said = {
        part.partition("\n")[0]: re.findall(r"^- editions: (.+)$", part, re.MULTILINE)
        for part in page.split("\n### ")[1:]
    }
    assert said["flying_start"] == ["`lab`, `drive`, `hil`"]
    assert said["pole_pairs"] == []
    assert sum(map(len, said.values())) == len(within)


def test_a_parameter_that_is_on_no_page_fails_the_check(tree: Path) -> None:
    """A new one, one that changed, and one that nobody says anything of."""
    assert pieces.check(tree) == []
    listed = tree / "firmware/dictionary/parameter_list.h"
    text = listed.read_text(encoding="utf-8")
    listed.write_text(text.replace("1, 30, 4, STOPPED", "1, 31, 4, STOPPED"), encoding="utf-8")
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
