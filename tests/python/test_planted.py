"""The defects that the long checks plant fit the sources as they are: else those checks fail where nobody looks."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import fuzz16  # noqa: E402
import planted  # noqa: E402
import vectors  # noqa: E402
from proof import defects as proof  # noqa: E402


@pytest.mark.parametrize(
    "defects", [proof.DEFECTS, vectors.DEFECTS, fuzz16.DEFECTS], ids=["prove", "vectors", "fuzz16"]
)
def test_every_defect_has_its_place(defects: tuple[proof.Defect | vectors.Defect | fuzz16.Defect, ...]) -> None:
    gone = [(d.file, d.right) for d in defects if d.right not in (ROOT / d.file).read_text(encoding="utf-8")]
    assert gone == []


@pytest.mark.parametrize(
    "defects", [proof.DEFECTS, vectors.DEFECTS, fuzz16.DEFECTS], ids=["prove", "vectors", "fuzz16"]
)
def test_every_defect_changes_something(defects: tuple[proof.Defect | vectors.Defect | fuzz16.Defect, ...]) -> None:
    assert [d.right for d in defects if d.right == d.wrong] == []


def test_a_defect_without_a_place_is_complained_about(tmp_path: Path) -> None:
    changes = [("control/frame.h", "no such text", "")]
    assert planted.plant(tmp_path / "tree", ("control",), changes) == ["control/frame.h has no 'no such text'"]
