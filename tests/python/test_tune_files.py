"""Files of the page: the session's history, and parameters from and to a file of the command line's format."""

import io
import json

import numpy as np
import pyarrow.parquet as pq
import pytest

from stillspin import csv_table
from stillspin.drive import parameter_file
from stillspin.drive.requester import wait_until
from stillspin.errors import InputError
from stillspin.tune.history import History


def test_a_history_has_every_stretch_with_units_and_gaps_where_nothing_was_plotted():
    history = History()
    history.begin({"speed": "rpm", "state": ""})
    history.add([1.0, 1.02], [[300.0, 301.0], [4.0, 4.0]])
    history.begin({"speed": "rpm", "current_q": "A"})
    history.add([2.0], [[310.0], [1.5]])
    lines = history.file("csv", "1.0 (board ipm)").decode().splitlines()
    assert lines == [
        "# firmware: 1.0 (board ipm)",
        "time [s],part,speed [rpm],state,current_q [A]",
        "1.000,1,300,4,",
        "1.020,1,301,4,",
        "2.000,2,310,,1.5",
    ]
    table = pq.read_table(io.BytesIO(history.file("parquet", "firmware 1")))
    assert table.schema.field("current_q").metadata == {b"unit": b"A"}
    assert json.loads(table.schema.metadata[b"stillspin"]) == {"firmware": "firmware 1"}
    assert np.isnan(table.column("current_q").to_numpy()[:2]).all()


def test_a_history_without_samples_says_so():
    with pytest.raises(InputError, match="nothing was plotted yet"):
        History().file("csv", "")


def test_the_oldest_samples_go_first(monkeypatch):
    monkeypatch.setattr("stillspin.tune.history._MOST", 3)
    history = History()
    history.begin({"speed": "rpm"})
    for second in range(5):
        history.add([float(second)], [[1.0]])
    assert [line[0] for line in history.file("csv", "").decode().splitlines()[2:]] == ["2", "3", "4"]


@pytest.fixture
def tuned(page, server):
    page.goto(server.address)
    page.wait_for_selector("#state:has-text('ready')")
    page.wait_for_selector("[data-value=speed_reference]:has-text('rpm')")
    return page


@pytest.mark.parametrize("ending", ["parquet", "csv"])
def test_the_history_is_downloaded_from_the_page(tuned, drive, ending):
    with tuned.expect_download() as download:
        tuned.click(f"a[href='/file/history.{ending}']")
    path = download.value.path()
    if ending == "csv":
        about, rows = csv_table.read(path)
        assert about == {"firmware": drive.identity.text}
        names = ["time [s]", "part", "speed [rpm]", "speed_reference [rpm]", "current_d [A]", "current_q [A]"]
        assert list(rows[0]) == names
    else:
        assert pq.read_table(path).column_names[:3] == ["time", "part", "speed"]


def test_parameters_go_to_a_file_and_come_back(tuned, server, fake, drive, tmp_path):
    tuned.click("[data-tab=parameters]")
    with tuned.expect_download() as download:
        tuned.click("a[href='/file/parameters.toml']")
    file = tmp_path / "motor.toml"
    file.write_text(download.value.path().read_text().replace("speed_ramp = 3000", "speed_ramp = 1234"))
    assert parameter_file.read(file, drive.table, drive.parameters())["speed_ramp"] == 1234
    tuned.set_input_files("#load-file", file)
    assert wait_until(lambda: fake.values[86] == 1234 << 8, 10)
    tuned.wait_for_selector("#store-note:has-text('motor.toml names 8 parameters, of which 1 had another value here')")
    assert tuned.input_value("[data-name=speed_ramp] input") == "1234"


def test_a_file_that_does_not_fit_changes_nothing_and_says_why(tuned, fake, tmp_path):
    tuned.click("[data-tab=parameters]")
    file = tmp_path / "wrong.toml"
    file.write_text("[parameters]\nspeed_ramp = 500\ncurrent_limit = 99\n")
    tuned.set_input_files("#load-file", file)
    tuned.wait_for_selector("#note:has-text('wrong.toml: current_limit')")
    assert fake.values[86] == 3000 << 8
