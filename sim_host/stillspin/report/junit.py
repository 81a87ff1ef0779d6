"""Results as JUnit XML, as the servers that build and test software read them."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Annotated, Self

import typer

from stillspin import __version__, whole_file
from stillspin.hil.results import Row
from stillspin.resources import natural_key
from stillspin.revision import revision
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.startup import ANGLE_LIMIT, BACKWARD_LIMIT, Outcome

JunitOption = Annotated[
    Path | None,
    typer.Option("--junit", metavar="FILE", help="Write the verdicts here as JUnit XML, also when broken off."),
]
_NOT_ENDED = "the command did not come to its end"


@dataclass(frozen=True)
class TestCase:
    """One verdict.

    Attributes:
        seconds: what it took.
        kind: failure, error or skipped; empty when it is good.
        words: why; details: more of it.
        firmware: of a board, where the verdict is of one.
    """

    classname: str
    name: str
    seconds: float = 0.0
    kind: str = ""
    words: str = ""
    details: str = ""
    firmware: str = ""


class Report:
    """A file of test cases that is there from entering on, and complete at leaving, however that comes about."""

    def __init__(self, file: Path | None, name: str, firmware: Callable[[], str] | None = None) -> None:
        """Of a command; no file writes nothing. `firmware`: of all cases, asked for once, and only for a file."""
        self._file, self._name = file, name
        self._about = {"stillspin": f"{__version__}, sources {revision()}"} if file else {}
        if file and firmware:
            self._about["firmware"] = firmware()
        self._cases: list[TestCase] = []

    def add(self, cases: Iterable[TestCase]) -> None:
        """Take what is done."""
        self._cases += cases

    def __enter__(self) -> Self:
        """Write a file that says that the work did not end, which is true until it does.

        Raises:
            InputError: it cannot be written.
        """
        self._write([self._broken(_NOT_ENDED)])
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        # By what they are of: which scenario was judged first, depends on who was quick.
        done = sorted(self._cases, key=lambda case: natural_key(case.classname))
        if kind is None or issubclass(kind, typer.Exit):
            self._write(done)
            return
        words = "interrupted" if issubclass(kind, KeyboardInterrupt) else str(error) or kind.__name__
        self._write([*done, self._broken(f"{_NOT_ENDED}: {words}")])

    def _broken(self, words: str) -> TestCase:
        return TestCase(self._name, self._name, kind="error", words=words)

    def _write(self, cases: list[TestCase]) -> None:
        if not self._file:
            return
        tree = _tree(self._name, cases, self._about)
        ET.indent(tree)
        whole_file.write(self._file, ET.tostring(tree, encoding="utf-8", xml_declaration=True), "--junit")


def _tree(name: str, cases: list[TestCase], properties: Mapping[str, str]) -> ET.Element:
    counts = {"tests": str(len(cases))}
    for kind, plural in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
        counts[plural] = str(sum(case.kind == kind for case in cases))
    about = {"name": f"stillspin {name}", **counts, "time": f"{sum(case.seconds for case in cases):.3f}"}
    top = ET.Element("testsuites", about)
    suite = ET.SubElement(top, "testsuite", about)
    _add_properties(suite, properties)
    for case in cases:
        entry = {"classname": case.classname, "name": case.name, "time": f"{case.seconds:.3f}"}
        element = ET.SubElement(suite, "testcase", entry)
        if case.firmware:
            _add_properties(element, {"firmware": case.firmware})
        if case.kind:
            ET.SubElement(element, case.kind, {"message": _clean(case.words)}).text = _clean(case.details) or None
    return top


def _add_properties(to: ET.Element, properties: Mapping[str, str]) -> None:
    listed = ET.SubElement(to, "properties")
    for name, value in properties.items():
        ET.SubElement(listed, "property", {"name": name, "value": _clean(value)})


def _clean(text: str) -> str:
    """Without the signs that XML does not have."""
    return "".join(sign if sign.isprintable() or sign in "\n\t" else "?" for sign in text)


def of_scenario(result: ScenarioResult, classname: str = "") -> Iterator[TestCase]:
    """Every run, and every figure that has a goal; seconds are the drive's. `classname`: where it is no scenario's."""
    scenario = result.scenario
    classname = classname or f"reproduce.{scenario.id}"
    for outcome in result.outcomes:
        kind = "" if not outcome.broken else "error" if outcome in result.broken else "skipped"
        seconds = outcome.stats.get("simulated_seconds", 0.0)
        yield TestCase(classname, f"run {outcome.run}", seconds, kind, outcome.broken or "")
    for figure in result.figures:
        if figure.goal is None:
            continue
        found = "no value" if figure.value is None else f"{figure.value:g} {figure.unit}".rstrip()
        words = "" if figure.met else f"{found}, the goal is at most {figure.goal:g} {figure.unit}".rstrip()
        kind = "" if figure.met else "failure"
        yield TestCase(classname, figure.name, 0.0, kind, words, figure.note)


def of_refused(words: str) -> TestCase:
    """A value of the commissioning that the drive did not believe."""
    return TestCase("reproduce.commission", words.partition(" ")[0], kind="failure", words=words)


def of_start(outcome: Outcome) -> TestCase:
    """A start; seconds are the drive's."""
    case = outcome.case
    at = f"{case.speed:+.0f} rpm" if case.way == "flying" else f"{case.load:+.2f} N m"
    way = "forward" if case.direction > 0 else "backward"
    name = f"{case.angle:g} deg, {way}, {at}, error {case.error}, seed {case.seed}"
    kind = "" if not outcome.problem else "error" if outcome.broken else "failure"
    details = (
        f"{outcome.backward:.2f} deg mechanical backwards, the goal is at most {BACKWARD_LIMIT:g}; angle"
        f" {abs(outcome.angle_error):.1f} deg electrical off, the goal is at most {ANGLE_LIMIT:g}"
    )
    shown = details if kind == "failure" else ""
    return TestCase(f"startup-matrix.{case.way}", name, outcome.start, kind, outcome.problem or "", shown)


def of_loop(row: Row) -> TestCase:
    """A run that a board and the virtual drive computed."""
    name = f"{row.run}{'' if row.whole else ' (its start)'}"
    about = f"hil.{row.link}.{row.scenario}"
    if row.lost:
        return TestCase(about, name, row.seconds, "error", row.lost, row.firmware, row.firmware)
    if row.identical:
        return TestCase(about, name, row.seconds, firmware=row.firmware)
    at = f"differs at step {row.step}: {row.words}" if row.step is not None else "the logs differ"
    return TestCase(about, name, row.seconds, "failure", at, row.firmware, row.firmware)


def left_out(row: Row) -> TestCase:
    """A run that an earlier file has as identical."""
    return TestCase(
        f"hil.{row.link}.{row.scenario}", f"{row.run}", kind="skipped", words="identical already, left out by --resume"
    )
