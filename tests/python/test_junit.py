"""The verdicts of reproduce, startup-matrix and hil as JUnit XML, also when they are broken off."""

import xml.etree.ElementTree as ET

import pytest
from typer.testing import CliRunner

import stillspin
from stillspin import cli
from stillspin.commands import hil
from stillspin.drive.own import firmware
from stillspin.hil.results import Row
from stillspin.report import junit
from stillspin.runs import campaign, startup

COMMAND = [
    "reproduce",
    "A10",
    "A14",
    "--profile",
    "ideal",
    "--jobs",
    "1",
    "--no-paper-scheme",
]


def properties(element):
    return {each.get("name"): each.get("value") for each in element.find("properties")}


def read(file):
    """Cases by class and name, with their verdicts; the counts have to agree with them."""
    top = ET.parse(file).getroot()
    assert top.tag == "testsuites"
    (suite,) = top
    assert suite.attrib == top.attrib
    listed = suite.findall("testcase")
    assert properties(suite)["stillspin"].startswith(f"{stillspin.__version__}, sources ")
    assert len(suite) == 1 + len(listed)
    cases = {(case.get("classname"), case.get("name")): case for case in listed}
    kinds = [verdict.tag for case in listed for verdict in case]
    assert int(suite.get("tests")) == len(listed) == len(cases)
    for kind, plural in (
        ("failure", "failures"),
        ("error", "errors"),
        ("skipped", "skipped"),
    ):
        assert int(suite.get(plural)) == kinds.count(kind)
    assert all(float(case.get("time")) >= 0.0 for case in listed)
    return cases


def call(tmp_path, *words):
    return CliRunner().invoke(
        cli.app,
        [
            *COMMAND,
            "-o",
            str(tmp_path / "r"),
            "--junit",
            str(tmp_path / "j.xml"),
            *words,
        ],
    )


def test_every_run_and_goal_is_a_case_and_the_same_seed_gives_the_same_file(tmp_path, core):
    done = call(tmp_path)
    first = (tmp_path / "j.xml").read_bytes()
    cases = read(tmp_path / "j.xml")
    assert {name for name, _ in cases} == {"reproduce.A10", "reproduce.A14"}
    assert any(name.startswith("run ") for _, name in cases)
    assert ("reproduce.A10", "position_error_peak") in cases
    assert (done.exit_code == 0) == (not any(len(case) for case in cases.values()))
    call(tmp_path)
    assert (tmp_path / "j.xml").read_bytes() == first
    assert properties(ET.parse(tmp_path / "j.xml").getroot()[0])["firmware"] == firmware()


def test_a_run_that_broke_off_is_an_error_and_its_goals_fail(tmp_path, core):
    (tmp_path / "short.toml").write_text("[inverter]\ndead_short = true\n", encoding="utf-8")
    assert call(tmp_path, "--profile", str(tmp_path / "short.toml")).exit_code == 1
    cases = read(tmp_path / "j.xml")
    runs = [case for (_, name), case in cases.items() if name.startswith("run ")]
    assert runs and all("over-current" in case.find("error").get("message") for case in runs)


def test_what_was_done_is_there_after_an_interrupt(tmp_path, core, monkeypatch):
    execute = campaign.execute

    def interrupted(job, *rest):
        if job.scenario == "A14":
            raise KeyboardInterrupt
        return execute(job, *rest)

    monkeypatch.setattr(campaign, "execute", interrupted)
    assert call(tmp_path).exit_code == 130
    cases = read(tmp_path / "j.xml")
    assert ("reproduce.A10", "position_error_peak") in cases
    assert "interrupted" in cases["reproduce", "reproduce"].find("error").get("message")
    assert not any(name == "reproduce.A14" for name, _ in cases)


@pytest.mark.parametrize(
    "command",
    [COMMAND, ["startup-matrix", "--quick"], ["round-trips"], ["hil", "A10", "--port", "virtual"]],
)
def test_a_path_that_cannot_be_written_is_said_first(tmp_path, core, monkeypatch, command):
    def never(*_, **__):
        raise AssertionError

    for module, name in (
        (startup, "run_all"),
        (campaign, "run_all"),
        (hil.campaign, "on_virtual"),
    ):
        monkeypatch.setattr(module, name, never)
    monkeypatch.chdir(tmp_path)
    for path in ("none/j.xml", "."):
        done = CliRunner().invoke(cli.app, [*command, "--junit", path])
        assert done.exit_code == 2, done.output
        assert "--junit" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_start_fails_with_figure_and_goal(tmp_path, core, monkeypatch):
    case = startup.Case("free", 15.0, 1, 0.0, "none", 1)
    found = [
        startup.Outcome(case, None, 0.3, 9.0, 1.0, 0.2),
        startup.Outcome(
            startup.Case("free", 30.0, 1, 0.0, "none", 1),
            "2.5 degrees backwards",
            2.5,
            9.0,
            1.0,
            0.2,
        ),
        startup.Outcome(startup.Case("free", 45.0, 1, 0.0, "none", 1), "over-current", broken=True),
    ]

    def run_all(_bench, _todo, _where, told):
        for outcome in found:
            told(outcome)
        return found

    monkeypatch.setattr(startup, "run_all", run_all)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli.app, ["startup-matrix", "--quick", "--junit", "j.xml"])
    assert done.exit_code == 1, done.output
    good, short, broken = read(tmp_path / "j.xml").values()
    assert not len(good) and good.get("time") == "0.200"
    assert short.find("failure").get("message") == "2.5 degrees backwards"
    assert "2.50 deg mechanical backwards, the goal is at most 2;" in short.find("failure").text
    assert broken.find("error").get("message") == "over-current"
    assert properties(ET.parse(tmp_path / "j.xml").getroot()[0])["firmware"] == firmware()


def test_a_board_that_differs_fails_and_one_that_is_lost_is_an_error(tmp_path, monkeypatch):
    row = Row(
        "A10",
        "steps",
        "bench",
        True,
        "can",
        "rev",
        firmware="stillspin 1 (board bench)",
    )
    same = {"board": "a", "native": "a", "seconds": 2.0}
    rows = [
        Row(**{**vars(row), **same}),
        Row(
            **{
                **vars(row),
                "run": "other",
                "board": "a",
                "native": "b",
                "step": 7,
                "words": "gates on",
            }
        ),
        Row(**{**vars(row), "run": "third", "lost": "no answer \x07"}),
    ]
    with junit.Report(tmp_path / "j.xml", "hil") as verdicts:
        assert [case.find("error") is not None for case in read(tmp_path / "j.xml").values()] == [True]  # not ended
        verdicts.add(map(junit.of_loop, rows))
        verdicts.add([junit.left_out(Row(**{**vars(row), "run": "fourth"}))])
    good, differs, lost, skipped = read(tmp_path / "j.xml").values()
    assert [each.tag for each in good] == ["properties"] and good.get("time") == "2.000"
    assert properties(good) == properties(differs) == properties(lost) == {"firmware": row.firmware}
    assert "step 7: gates on" in differs.find("failure").get("message")
    assert differs.find("failure").text == row.firmware
    assert lost.find("error").get("message") == "no answer ?"
    assert skipped.find("skipped") is not None
