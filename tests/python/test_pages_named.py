"""Pages of the book that the client names: their paths exist for who reads them, wherever it is installed."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from stillspin import resources

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(resources.__file__).parent
SOURCES = sorted(path for path in PACKAGE.rglob("*.py") if path.name != "resources.py")
A_PAGE = re.compile(r"[\w-]\.md\b")


def nodes(kind):
    """Of all sources, each with where it is."""
    for path in SOURCES:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        said = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}  # of docstrings
        for node in ast.walk(tree):
            if isinstance(node, kind) and id(node) not in said:
                yield f"{path.relative_to(PACKAGE)}:{node.lineno}", node


def named():
    """The pages that are asked for, with where."""
    for where, node in nodes(ast.Call):
        if isinstance(node.func, ast.Attribute) and ast.unparse(node.func) == "resources.page":
            (name,) = node.args
            yield where, ast.literal_eval(name)


PAGES = sorted({name for _, name in named()})


def test_nothing_names_a_page_by_a_path_of_its_own():
    strings = [(where, node.value) for where, node in nodes(ast.Constant) if isinstance(node.value, str)]
    assert len(strings) > 5000
    assert [(where, text) for where, text in strings if A_PAGE.search(text)] == []


def test_every_page_that_is_named_exists(tmp_path, monkeypatch):
    assert {"c28x", "chip", "flash", "parameters", "tuning"} <= set(PAGES)
    for folder in (tmp_path, ROOT, ROOT / "docs", ROOT / "docs/images"):
        monkeypatch.chdir(folder)
        for name in PAGES:
            assert Path(resources.page(name)).read_text(encoding="utf-8").startswith("# "), name
    monkeypatch.chdir(ROOT)
    assert Path(resources.page("tuning")) == Path("docs/tuning.md")


@pytest.mark.parametrize("is_in_sources", [True, False])
def test_a_help_names_a_path_that_can_be_copied(tmp_path, is_in_sources):
    folder = ROOT if is_in_sources else tmp_path
    said = subprocess.run(
        [sys.executable, "-m", "stillspin", "params", "-h"], cwd=folder, capture_output=True, text=True, check=True
    )
    (path,) = re.findall(r"^ +(\S+\.md)$", said.stdout, re.MULTILINE)
    assert (folder / path).is_file()
    assert Path(path).is_absolute() != is_in_sources


def test_where_the_book_is_missing_the_rest_is_said_all_the_same(monkeypatch, tmp_path):
    monkeypatch.setattr(resources, "PACKAGE", tmp_path / "lib/stillspin")
    assert resources.page("flash") == "flash.md"
