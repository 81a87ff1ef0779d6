"""`stillspin round-trips`: from standstill to 3000 rpm and back, from initial angles that are drawn."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from stillspin import resources, wilson
from stillspin.cases.scenario import Figure, Goal, Reached, Run, Scenario
from stillspin.commands.campaign_options import CampaignOptions, with_campaign_options
from stillspin.counted import counted
from stillspin.drive.own import firmware
from stillspin.exit_codes import ExitCode
from stillspin.options import CommissionOption, whole
from stillspin.report import junit
from stillspin.report.page import number
from stillspin.runs.assess import ScenarioResult
from stillspin.studies.reproduction import Options, carry_out

NAME = "round-trips"
TRIPS = "trips.json"
_SPEED = 3000.0  # rpm
_OUT, _BACK, _END = 0.3, 2.5, 4.5  # s: the commands, and the end; the drive's own ramp takes one second each way
_THERE, _HOME = (2.0, 2.5), (4.0, 4.5)  # s: where the shaft must be there, and at rest again
_BANDS = 75.0, 15.0  # rpm: as A18c has them, which tell a shaft that follows from one that is lost


def trips(count: int, seed: int) -> Scenario:
    """A run for each angle drawn, forward and backward in turn."""
    angles = np.random.default_rng(seed).uniform(0.0, 360.0, count).round(1)
    runs = tuple(_trip(k, float(angle)) for k, angle in enumerate(angles, 1))
    figures = tuple(
        Figure(_figure_of(run), "position_error_peak", "deg el", (run.name,), ((0.2, _END),), None, Goal())
        for run in runs
    )
    title = f"0 → ±{_SPEED:.0f} → 0 rpm from {count} angles"
    return Scenario(NAME, title, resources.DEFAULT_MOTOR, "", "", "", runs, figures, ())


def _trip(count: int, angle: float) -> Run:
    there = _SPEED if count % 2 else -_SPEED
    return Run(
        name=f"trip_{count}",
        title=f"{there:+.0f} rpm from {angle:g}°",
        duration=_END,
        max_start=3.0,
        commands=((_OUT, "speed_ref_rpm", there), (_BACK, "speed_ref_rpm", 0.0)),
        load=(),
        parameters={},
        plant={"initial": {"angle": math.radians(angle)}},
        reached=(Reached(_THERE, _BANDS[0]), Reached(_HOME, _BANDS[1])),
        record_every=4,
    )


def _figure_of(run: Run) -> str:
    return f"{run.name}_position_error_peak"


def outcome(result: ScenarioResult) -> dict[str, Any]:
    """What `trips.json` has: how many trips, those that were lost and why, the peak of the others."""
    titles = {run.name: run.title for run in result.scenario.runs}
    lost = [{"trip": each.run, "title": titles[each.run], "why": each.broken} for each in result.lost]
    peaks = [figure.value for figure in result.figures if figure.value is not None]
    return {"trips": len(titles), "lost": lost, "position_error_peak": max(peaks, default=None)}


def _say(found: dict[str, Any], out: Path) -> None:
    for each in found["lost"]:
        print(f"stillspin: {each['trip']}, {each['title']}: lost: {each['why']}", file=sys.stderr)
    peak = found["position_error_peak"]
    of_others = "" if peak is None else f"; position error of the others at most {number(peak)}° el"
    share = wilson.words(
        len(found["lost"]), found["trips"]
    )  # of the angles that may be drawn: the noise is of one seed
    print(f"{len(found['lost'])} of {counted(found['trips'], 'trip')} lost ({share}){of_others}; see {out}")


def _cases(results: Sequence[ScenarioResult]) -> list[junit.TestCase]:
    return [case for result in results for case in junit.of_scenario(result, NAME)]


@with_campaign_options
def round_trips(
    *,
    runs: Annotated[
        int, typer.Option("--runs", "-n", metavar="N", parser=whole("--runs", 1, 10000), help="How many trips.")
    ] = 50,
    may_lose: Annotated[
        int,
        typer.Option(
            "--may-lose",
            metavar="N",
            parser=whole("--may-lose", 0, 10000),
            help="How many trips may be lost before the exit status is 1.",
        ),
    ] = 0,
    common: CampaignOptions,
    commission_first: CommissionOption = True,
    out: Annotated[Path, typer.Option("--out", "-o", help="Directory of the results.")] = Path("results-trips"),
) -> None:
    """From standstill to 3000 rpm and back without load, from random angles of the shaft, forward and backward in turn.

    The angles are those of --seed. Exit status 1 when the drive loses the rotor in more trips than --may-lose says.
    """
    with junit.Report(common.junit_file, NAME, firmware) as verdicts:
        options = Options(
            common.profile_name,
            common.seed,
            out,
            common.changes,
            where=common.where,
            draw=False,
            params=common.params,
            scheme=common.scheme,
            commission=commission_first,
        )
        done = carry_out([trips(runs, common.seed)], options)
        verdicts.add(_cases(done.results))
        verdicts.add(junit.of_refused(words) for words in done.refused)
        found = {"firmware": firmware(), **outcome(done.results[0])}
        (out / TRIPS).write_text(json.dumps(found, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
        for words in done.refused:
            print(f"stillspin: {words}", file=sys.stderr)
        _say(found, out)
        if len(found["lost"]) > may_lose or done.refused:
            raise typer.Exit(ExitCode.SHORT)
