#!/usr/bin/env python3
"""Writes docs/notebook.ipynb from the page docs/notebook.md: the same cells, without what they print.

Usage: toolchain/notebook.py
"""

from pathlib import Path

import jupytext

DOCS = Path(__file__).resolve().parent.parent / "docs"


def made(page: str) -> str:
    """The notebook of a page; the same page, the same octets."""
    notebook = jupytext.reads(page, fmt="md")
    for number, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{number}"  # jupytext's own are new every time
    notebook.metadata.pop("jupytext", None)
    return jupytext.writes(notebook, fmt="ipynb")


if __name__ == "__main__":
    page = (DOCS / "notebook.md").read_text(encoding="utf-8")
    (DOCS / "notebook.ipynb").write_text(made(page) + "\n", encoding="utf-8")
