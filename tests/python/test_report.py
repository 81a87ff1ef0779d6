"""metrics.json has the shape that programs rely on; the page is one file and shows what the figures say."""

import json
import re
import sys

import pytest
from typer.testing import CliRunner

import fake_core
from stillspin import cli
from stillspin.cases import scenario_file
from stillspin.measure.figures import Result
from stillspin.report import page as report
from stillspin.runs import variant


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Results of three scenarios on the fake native module."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "stillspin._core", fake_core)
        out = tmp_path_factory.mktemp("results") / "r"
        chosen = ["A10", "A14", "A18c"]
        arguments = ["reproduce", *chosen, "--profile", "ideal", "--seed", "9", "--jobs", "1", "--out", str(out)]
        done = CliRunner().invoke(cli.app, arguments)
    assert done.exit_code == 0, done.stderr
    return out


@pytest.fixture(scope="module")
def page(results):
    return (results / "report.html").read_text(encoding="utf-8")


def test_metrics_have_exactly_the_agreed_shape(results):
    metrics = json.loads((results / "metrics.json").read_text(encoding="utf-8"))
    assert list(metrics) == ["profile", "seed", "revision", "firmware", "scenarios"]
    assert (metrics["profile"], metrics["seed"]) == ("ideal", 9)
    assert metrics["revision"]
    assert metrics["firmware"] == fake_core.FIRMWARE
    assert list(metrics["scenarios"]) == ["A10", "A14", "A18c"]
    paper = json.loads((results / "paper.json").read_text(encoding="utf-8"))
    assert list(paper) == [*metrics, "lost"]
    # A14 compares position sources itself.
    assert list(paper["scenarios"]) == ["A10", "A18c"]
    assert paper["lost"] == {}
    for identifier, figures in [*metrics["scenarios"].items(), *paper["scenarios"].items()]:
        assert list(figures) == [figure.name for figure in scenario_file.load(identifier).figures]
        for name, figure in figures.items():
            assert re.fullmatch(r"[a-z0-9_]+", name)
            assert list(figure) == ["value", "unit", "paper", "goal", "met"]
            assert isinstance(figure["value"], float)
            assert isinstance(figure["unit"], str)
            for key in ("paper", "goal"):
                assert figure[key] is None or isinstance(figure[key], float)
            if figure["goal"] is None:
                assert figure["met"] is None
            else:
                assert figure["met"] == (abs(figure["value"]) <= figure["goal"])


def test_the_page_needs_nothing_from_elsewhere(page):
    assert not re.search(r"""(src|href)=["'](?!data:|#|runs/)""", page)
    assert not re.search(r"url\(|@import|<script|<link", page)


def test_every_link_to_a_record_leads_somewhere(results, page):
    linked = set(re.findall(r'href="(runs/[^"]+)"', page))
    assert linked == {f"runs/{path.name}" for path in (results / "runs").iterdir()}


def test_the_page_says_what_it_is_about(page):
    for word in (
        "ideal",
        "seed of the noise",
        "the nameplate",
        "Fig. 18c",
        "simulated s per s",
        "0.2",
        fake_core.FIRMWARE,
    ):
        assert word in page
    own = [scenario_file.load(name) for name in ("A10", "A14", "A18c")]
    variants = [variant.paper().scenario(scenario) for scenario in own if variant.paper().applies(scenario)]
    assert page.count("<img") == sum(len(scenario.plots) for scenario in [*own, *variants])


def test_what_comes_from_files_is_escaped(tmp_path, core, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text('description = "<script>alert(1)</script>"\n', encoding="utf-8")
    assert CliRunner().invoke(cli.app, ["run", "A10", "--no-plots", "-p", "mine.toml", "-o", "r"]).exit_code == 0
    assert "<script" not in (tmp_path / "r" / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (0.0, "0"),
        (0.8, "0.8"),
        (0.5191, "0.519"),
        (-2.345, "−2.35"),
        (12.34, "12.3"),
        (123.4, "123"),
        (3000.0, "3000"),
        (0.00339, "3.39e−03"),
        (250000.0, "2.50e+05"),
        (100.0, "100"),
    ],
)
def test_numbers_are_written_for_people(value, text):
    assert report.number(value) == text


@pytest.mark.parametrize(
    ("value", "goal", "met", "word"),
    [
        (1.0, 2.0, True, "met"),
        (3.0, 2.0, False, "missed"),
        (None, 2.0, False, "no value"),
        (1.0, None, None, ""),
        (None, None, None, ""),  # a dash among the values; nothing was promised
    ],
)
def test_the_verdict_of_a_figure(value, goal, met, word):
    assert report.verdict(Result("x", value, "", None, goal, met)) == word
