"""Tables as CSV: a head that says of what they are, in front of the names of the columns."""

import pandas as pd

from stillspin import csv_table

ABOUT = {"firmware": "stillspin 1.0 (board ipm,\ntable 1234abcd)", "seed": 1, "trigger": {"signal": "speed"}}
ROWS = [["a, b", 1.5], ['says "no"', ""]]


def test_a_table_comes_back_with_its_head(tmp_path):
    file = tmp_path / "x.csv"
    csv_table.write(file, ABOUT, ["words", csv_table.heading("speed", "rpm")], ROWS)
    assert file.read_text(encoding="utf-8").splitlines() == [
        "# firmware: stillspin 1.0 (board ipm, table 1234abcd)",
        "# seed: 1",
        '# trigger: {"signal": "speed"}',
        "words,speed [rpm]",
        '"a, b",1.5',
        '"says ""no""",',
    ]
    about, rows = csv_table.read(file)
    assert list(about) == list(ABOUT)
    assert about["firmware"] == "stillspin 1.0 (board ipm, table 1234abcd)"
    assert rows == [{"words": "a, b", "speed [rpm]": "1.5"}, {"words": 'says "no"', "speed [rpm]": ""}]


def test_pandas_reads_it_as_the_book_says(tmp_path):
    file = tmp_path / "x.csv"
    csv_table.write(file, ABOUT, ["words", "speed [rpm]"], ROWS)
    frame = pd.read_csv(file, comment="#")
    assert list(frame) == ["words", "speed [rpm]"]
    assert frame["words"].tolist() == ["a, b", 'says "no"']


def test_a_table_without_a_head_is_read_and_says_nothing(tmp_path):
    (tmp_path / "x.csv").write_text("a,b\n1,2\n", encoding="utf-8")
    assert csv_table.read(tmp_path / "x.csv") == ({}, [{"a": "1", "b": "2"}])
