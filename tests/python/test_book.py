"""What the book owes its readers, beyond links that lead somewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
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
