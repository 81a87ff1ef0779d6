"""Tables on the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from stillspin.cases.scenario import Scenario
from stillspin.catalogue import Entry as MotorEntry
from stillspin.catalogue import Verdict
from stillspin.counted import counted
from stillspin.drive.scope import Capture
from stillspin.drive.table import Parameter
from stillspin.entry import Entry
from stillspin.hil.results import Row
from stillspin.measure.figures import Result
from stillspin.report import page as report
from stillspin.report.explanation import Explanation
from stillspin.runs import commission
from stillspin.runs.assess import ScenarioResult
from stillspin.runs.effects import ALONE, WITHOUT
from stillspin.runs.variant import Beside

_COLOURS = {"met": "green", "missed": "red", "no value": "red", "": ""}
_RIGHT = {
    *("value", "before", "found", "paper", "goal", "runs", "default", "number", "paper scheme", "nameplate"),
    *("without", "alone"),
    *("starts", "failed", "steps", "steps/s", "backward", "sigma", "angle"),
    *("V", "A", "kW", "rpm", "pole pairs", "Lq/Ld"),
}


def _table(*headings: str) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in headings:
        table.add_column(heading, justify="right" if heading in _RIGHT else "left")
    return table


def _print(table: Table) -> None:
    """A table that goes to a file or a pipe has no screen to fit, so it keeps its width."""
    console = Console()
    Console(width=None if console.is_terminal else 200).print(table)


def summary(results: Iterable[ScenarioResult], beside: Sequence[Beside], of: str = "value") -> None:
    """Every figure of merit, `of` says of what, and beside it what the variants reach, where they were run."""
    headings = ("scenario", "figure", of, "unit", "paper", "goal", "")
    table = _table(*headings, *(item.variant.title for item in beside))
    for result in results:
        for figure in result.figures:
            value, paper, goal = (report.number(item) for item in (figure.value, figure.paper, figure.goal))
            word = report.verdict(figure)
            shown = Text(word, style=_COLOURS[word])
            unit = report.unit_text(figure.unit)
            others = [_reached(item.results.get(result.scenario.id), figure.name) for item in beside]
            table.add_row(result.scenario.id, figure.name, value, unit, paper, goal, shown, *others)
    _print(table)


def _reached(result: ScenarioResult | None, name: str) -> str:
    """What a variant reaches: nothing where it was not run."""
    if result is None:
        return ""
    return _or_lost(_figure(result, name).value)


def drift(results: Iterable[ScenarioResult], beside: Sequence[Beside]) -> int:
    """Every figure with a goal, as commissioned and on each plant that has drifted; how many of these fall short."""
    table = _table("scenario", "figure", "unit", "goal there", "commissioned", *(item.variant.title for item in beside))
    short = 0
    for result in results:
        for figure in result.figures:
            if figure.goal is None:
                continue
            others = [_figure(item.results[result.scenario.id], figure.name) for item in beside]
            short += sum(not other.met for other in others)
            cells = [Text(_or_lost(other.value), style="" if other.met else "red") for other in others]
            goal = others[0].goal if others else None
            unit = report.unit_text(figure.unit)
            own = _or_lost(figure.value)
            table.add_row(result.scenario.id, figure.name, unit, report.number(goal), own, *cells)
    _print(table)
    return short


def _figure(result: ScenarioResult, name: str) -> Result:
    return next(figure for figure in result.figures if figure.name == name)


def _or_lost(value: float | None) -> str:
    return "lost" if value is None else report.number(value)


def commissioning(result: commission.Result) -> None:
    """Every identified value and what became of it."""
    table = _table("parameter", "before", "found", "unit", "")
    for value in result.values:
        before, found = (f"{number:.{value.places}f}" for number in (value.before, value.value))
        table.add_row(value.name, before, found, value.unit, Text(value.words, style="green" if value.used else "red"))
    _print(table)


def scenarios(items: Iterable[Scenario]) -> None:
    """What can be run."""
    table = _table("id", "motor", "runs", "scenario", "paper", "")
    for item in items:
        table.add_row(item.id, item.motor, str(len(item.runs)), item.title, item.paper_figure, _when(item))
    _print(table)


def catalogue(motors: Iterable[MotorEntry], verdicts: Mapping[str, Verdict]) -> None:
    """Other people's motors; `verdicts` by name: what the drive says of each, in the place of its source."""
    judged = ("motor check", "first reason") if verdicts else ("source",)
    table = _table("motor", "V", "A", "kW", "rpm", "pole pairs", "Lq/Ld", "kind", *judged)
    for motor in motors:
        numbers = (motor.volts, motor.amperes, motor.kilowatts, motor.speed, motor.pole_pairs)
        last = (verdicts[motor.name].word, verdicts[motor.name].reason) if verdicts else (motor.source,)
        table.add_row(motor.name, *(f"{number:.5g}" for number in numbers), f"{motor.saliency:.2f}", motor.kind, *last)
    _print(table)


def _when(item: Scenario) -> str:
    return "on demand" if item.on_demand else ""


def parameters(entries: Iterable[Entry]) -> None:
    """The firmware's parameters."""
    table = _table("number", "name", "default", "range", "access", "meaning")
    for entry in entries:
        default = f"{entry.default:.{entry.places}f}"
        table.add_row(str(entry.number), entry.name, default, entry.range_text, entry.access, Text(entry.help))
    _print(table)


def differences(rows: Iterable[tuple[Parameter, float | None, float | None]], one: str, other: str) -> None:
    """Parameters with two values each."""
    rows = list(rows)
    if not rows:
        return
    table = _table("parameter", one, other, "unit", "meaning")
    for parameter, first, second in rows:
        shown = ("–" if value is None else f"{value:.{parameter.decimals}f}" for value in (first, second))
        table.add_row(parameter.name, *shown, parameter.unit, Text(parameter.meaning))
    _print(table)


def capture(result: Capture) -> None:
    """What was captured, a row per signal; of one that the drive does not know all the time, what it knew."""
    table = _table("signal", "least", "mean", "greatest", "unit", "")
    for name, values in result.signals.items():
        known = values[~np.isnan(values)]
        numbers = (f"{number:.4g}" for number in (known.min(), known.mean(), known.max())) if known.size else "–––"
        words = Text("beyond its full scale", style="red") if name in result.clipped else Text("")
        if known.size < values.size:
            words.append(f" unknown in {counted(values.size - known.size, 'record', values.size)}")
        table.add_row(name, *numbers, result.units[name], words)
    _print(table)


def loop(rows: Iterable[Row]) -> None:
    """Boards in the loop: what they and the virtual drive came to."""
    table = _table(
        "scenario", "run", "extent", "way", "virtual drive", "board", "", "steps", "steps/s", "first difference"
    )
    for row in rows:
        word = Text("identical", style="green") if row.identical else Text("NOT IDENTICAL", style="red")
        where = f"step {row.step}: {row.words}" if row.step is not None else row.lost
        what = row.scenario, row.run, "whole" if row.whole else "start", row.link
        hashes = row.native[:12], row.board[:12]
        table.add_row(*what, *hashes, word, str(row.steps), f"{row.rate:.0f}", Text(where))
    _print(table)


def startup(rows: Iterable[tuple[str, ...]]) -> None:
    """The start-up matrix: worst values of each group of starts."""
    table = _table("way", "errors", "load or speed", "starts", "failed", "backward", "angle", "sigma", "first failure")
    for row in rows:
        table.add_row(*row)
    _print(table)


def type_test(rows: Iterable[tuple[str, ...]]) -> None:
    """What a type test found, motor by motor, a row for each kind of duty."""
    table = _table("motor", "duty", "runs", "failed", "refused", "load", "angle", "first that did not go well")
    for row in rows:
        table.add_row(*row)
    _print(table)


def explanation(found: Explanation) -> None:
    """A figure after the other: its value without each effect and with it alone, the dominating one marked."""
    table = _table("figure", "unit", "goal", "effect", "without", "alone", "")
    for figure in found.figures:
        goal, unit = report.number(figure.goal), report.unit_text(figure.unit)
        word = report.verdict(figure)
        shown = Text(word, style=_COLOURS[word])
        ideal = report.number(found.value(ALONE, None, figure.name)) if found.alone else ""
        table.add_row(figure.name, unit, goal, "nothing switched", report.number(figure.value), ideal, shown)
        best = found.dominating(figure)
        for effect in found.effects:
            without = report.number(found.value(WITHOUT, effect, figure.name))
            alone = report.number(found.value(ALONE, effect, figure.name)) if found.alone and not effect.exact else ""
            mark = Text("dominates", style="bold") if effect is best else Text("")
            table.add_row("", "", "", effect.title, without, alone, mark)
    _print(table)
