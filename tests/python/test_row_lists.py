"""Lists whose rows stand with their features, joined to the table that every edition has."""

import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "toolchain"))

import compose  # noqa: E402
import row_lists  # noqa: E402
from row_lists import JOINED, Lists  # noqa: E402

FIRST_OF_OTHERS = 900  # docs/feature.md


def plant(folder: Path, name: str, text: str) -> None:
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")


def test_arguments_of_a_macro_are_found() -> None:
    text = 'FAULT(1, A, "no", "")  // FAULT(2, B, "comment", "")\nOTHER(3)\nFAULT(4, f(a, b),\n  "x, (y"\n " z")'
    assert row_lists.rows(text, "FAULT")[0] == ["1", "A", "no", ""]
    assert row_lists.rows(text, "FAULT")[-1] == ["4", "f(a,b)", "x, (y z"]


def test_a_list_has_the_rows_of_every_folder() -> None:
    """Faults by their numbers, which their words are found by; what the console's own commands say comes first."""
    faults = [int(row[0]) for row in Lists().rows("fault_list.h", "FAULT")]
    assert faults == list(range(len(faults)))
    assert Lists().rows("help_list.h", "HELP")[0][:2] == ["list", "1"]
    for name, of in JOINED.items():
        files = list((ROOT / "firmware").rglob(name))
        assert len(files) > 3
        joined = Lists().joined()[of.header]
        if of.places:
            own = [row[0] for file in files for row in row_lists.rows_of(file.parent, name)]
            assert sorted(own) == sorted(row[0] for row in row_lists.rows(joined, of.macro))
        else:
            assert set(re.findall(r'#include "([^"]+)"', joined)) == {
                file.relative_to(ROOT).as_posix() for file in files
            }


def test_rows_stand_where_their_place_says_and_without_one_behind_all(tmp_path: Path) -> None:
    plant(
        tmp_path,
        "firmware/dictionary/signal_list.h",
        "// Some.\n\nPLACE(10)\nSIGNAL(a)\nSIGNAL(b)\n\nPLACE(30)\nSIGNAL(e)\n",
    )
    plant(tmp_path, "firmware/scope/signal_list.h", "PLACE(40)\nSIGNAL(f)\n\nPLACE(9)\nSIGNAL(z)\n")
    plant(tmp_path, "firmware/can/signal_list.h", "// More.\nPLACE(20)\nSIGNAL(c)\nSIGNAL(d)\n")
    plant(tmp_path, "own/signal_list.h", "// Mine.\nSIGNAL(x)\n")
    lists = Lists(tmp_path, (tmp_path / "own",))
    assert "".join(row[0] for row in lists.rows("signal_list.h", "SIGNAL")) == "zabcdefx"
    plant(tmp_path, "firmware/can/signal_list.h", "PLACE(30)\nSIGNAL(c)\n")
    with pytest.raises(ValueError, match=r"signal_list\.h: place 30 is taken"):
        lists.rows("signal_list.h", "SIGNAL")
    plant(tmp_path, "firmware/can/signal_list.h", "SIGNAL(c)\nPLACE(20)\nSIGNAL(d)\n")
    with pytest.raises(ValueError, match="c stands before the first PLACE of its file; give it one"):
        lists.rows("signal_list.h", "SIGNAL")


@pytest.mark.parametrize(
    ("name", "row", "wrong"),
    [
        ("parameter_list.h", 'PARAMETER(60, own, NONE, 0, 0, 0, 1, 0, ALWAYS, "mine")', "60 is there twice"),
        ("request_list.h", "REQUEST(COMMAND, OWN, 7)", "COMMAND 7 is there twice"),
        ("fault_list.h", 'FAULT(3, OWN, "mine", "no")', "3 is there twice"),
    ],
)
def test_a_number_that_somebody_has_is_refused(tmp_path: Path, name: str, row: str, wrong: str) -> None:
    plant(tmp_path, f"own/{name}", row + "\n")
    plant(tmp_path, "own/feature.toml", "")
    plant(tmp_path, "own.txt", "drive\nsources/observer\nown\n")
    with pytest.raises(ValueError, match=f"{name}: {wrong}"):
        compose.made(compose.read_edition(str(tmp_path / "own.txt")))


def test_the_tree_leaves_numbers_to_others() -> None:
    assert max(int(row[0]) for row in Lists().rows("parameter_list.h", "PARAMETER")) < FIRST_OF_OTHERS


def test_what_an_edition_leaves_out_is_what_stands_in_its_features_folders() -> None:
    made = compose.made(compose.read_edition("minimal"))
    assert made["signal_looks.c"].count("    look_at_nothing,") == 3
    assert "    look_at_speed," in made["signal_looks.c"]
    assert compose.runs(n for f in compose.left_out(compose.read_edition("minimal")) for n in f.requests) == [
        (0x10, 5),
        (0x16, 2),
        (0x20, 3),
        (0x106, 5),
    ]
